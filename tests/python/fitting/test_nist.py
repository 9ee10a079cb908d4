"""Laws by formula against the certified digits of NIST's nonlinear regression sets.

Each is read from a CSV file as a table of points and fitted from NIST's own starts.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
import stribeck as sb

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "nist"))

import sets

pytestmark = pytest.mark.skipif(
    not sets.FOLDER.is_dir(), reason="NIST's data sets are not at ../shared/data/nist_strd"
)


def check(known: sets.Certified, found: dict[str, dict[str, float | None]]) -> None:
    """Values and standard errors by parameter name reach the digits that are asked."""
    values = {name: row["value"] for name, row in found.items()}
    errors = {name: row["stderr"] for name, row in found.items()}
    assert known.digits(values, known.values) >= sets.PARAMETER_DIGITS, values
    assert known.digits(errors, known.errors) >= known.error_digits, errors


def test_all_sets_are_there() -> None:
    assert len(sets.names()) == 27


@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", sets.names())
def test_the_given_start_alone_reaches_the_certified_digits(
    name: str, start: int, tmp_path: Path
) -> None:
    known = sets.read(name)
    recording = sb.read(known.write(tmp_path), **known.reading)
    fitted = sb.fit(known.law, recording, start=known.starts[start], errors="independent", starts=1)
    check(known, fitted.to_dict()["parameters"])
    assert fitted.converged and fitted.rmse_held_out > fitted.rmse


@pytest.mark.slow
@pytest.mark.parametrize("start", [0, 1])
@pytest.mark.parametrize("name", sets.names())
def test_other_starts_do_not_lead_astray(name: str, start: int, tmp_path: Path) -> None:
    """As any fit: random starts about the given one, the best of all."""
    known = sets.read(name)
    recording = sb.read(known.write(tmp_path), **known.reading)
    fitted = sb.fit(known.law, recording, start=known.starts[start], errors="independent")
    check(known, fitted.to_dict()["parameters"])


@pytest.mark.parametrize("name", ["Nelson", "MGH10"])
def test_the_command_line_reaches_them_too(name: str, tmp_path: Path) -> None:
    known = sets.read(name)
    words = [sys.executable, "-m", "stribeck", "fit", str(known.write(tmp_path))]
    words += ["--law", known.law, "--errors", "independent", "--starts", "1", "--json"]
    words += ["--average", "row", "--rows", "all"]
    for option in ("map", "derive"):
        words += [word for text in known.reading[option] for word in (f"--{option}", text)]
    for parameter, value in known.starts[0].items():
        words += ["--start", f"{parameter}={value}"]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    got = json.loads(done.stdout)
    check(known, got["parameters"])
    assert got["formulas"] == {"formula": known.law}
    assert got["scored"]["share"] == 1.0
