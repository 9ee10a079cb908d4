"""Values of options that mean nothing are refused, in Python and on the command line."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
import stribeck as sb
from click.testing import CliRunner
from stribeck.cli.main import cli


@pytest.mark.parametrize("share", [math.nan, -0.1, 1.1, math.inf])
def test_a_share_lies_between_0_and_1(plain: sb.Recording, share: float) -> None:
    fitted = sb.fit("coulomb", plain, starts=1)
    with pytest.raises(sb.SpecError, match="least_fall"):
        sb.diagnose(fitted, least_fall=share)
    with pytest.raises(sb.SpecError, match="least_fall"):
        sb.improve("coulomb", plain, least_fall=share)


@pytest.mark.parametrize("share", ["nan", "-0.1", "1.1"])
def test_the_flag_names_itself(plain_file: Path, share: str) -> None:
    done = CliRunner().invoke(cli, ["diagnose", str(plain_file), "coulomb", "--least-fall", share])
    assert done.exit_code != 0 and not done.stdout


@pytest.mark.parametrize("starts", [0, -3])
def test_a_fit_needs_a_start(plain: sb.Recording, starts: int) -> None:
    with pytest.raises(sb.SpecError, match="starts"):
        sb.fit("coulomb+stribeck", plain, starts=starts)


def test_a_precision_is_double_or_single() -> None:
    model = sb.model("coulomb", coulomb_friction=1.0, viscous_friction=1.0)
    with pytest.raises(sb.SpecError, match="precision"):
        model.torque([1.0], precision="half")  # type: ignore[arg-type]


def test_a_parameter_is_given_once() -> None:
    with pytest.raises(sb.SpecError, match="given twice"):
        sb.model("coulomb", coulomb_friction=1.0, a2=2.0)
