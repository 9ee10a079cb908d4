"""Public measurements: published parameters, and the causes that their owners found."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
import stribeck as sb

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT.parent / "shared" / "data"
SIDECARS = ROOT / "tests" / "sidecars"
FILES = {
    "emps": "emps/emps.parquet",
    "emps_pulses": "emps/emps_pulses.parquet",
    "bam_xl330": "bam_xl330/xl330_pendulum.parquet",
    **{f"ur10e_joint_{j}": f"ur10e/ur-20_01_22-joint_{j}.parquet" for j in range(1, 7)},
    **{f"screwdrives_drive_{d}": "screwdrives/screwdrives.parquet" for d in (1, 2, 3)},
}

pytestmark = pytest.mark.skipif(
    not (DATA / "emps").is_dir(), reason="the public data sets are not at ../shared/data"
)


@cache
def measured(name: str) -> sb.Recording:
    """One recording, read with its sidecar."""
    return sb.read(DATA / FILES[name], sidecar=SIDECARS / f"{name}.sidecar.toml")


@cache
def improved(name: str) -> sb.Improvement:
    """What is missing from Coulomb and viscous friction on it."""
    return sb.improve("coulomb", measured(name))


def effects(improvement: sb.Improvement) -> list[str]:
    """The effects added, in order."""
    return [step.finding.effect for step in improvement.steps]


def test_emps_has_the_published_parameters() -> None:
    """Janot, Gautier, Brunot 2019, IDIM-LS."""
    fit = sb.fit("coulomb+offset", measured("emps"))
    value = {name: e.value for name, e in fit.estimates.items()}
    assert value["inertia"] == pytest.approx(95.1, rel=0.02)
    assert value["viscous_friction"] == pytest.approx(203.5, rel=0.02)
    assert value["coulomb_friction"] == pytest.approx(20.4, rel=0.02)
    assert value["offset"] == pytest.approx(-3.2, rel=0.05)
    assert [p.unit for p in fit.model.parameters if p.name == "inertia"] == ["kg"]


def test_emps_with_direction_predicts_the_pulses_better() -> None:
    """Fitted on one file, judged on the other without a refit."""
    pulses = measured("emps_pulses")
    with_direction, without = (
        sb.evaluate(sb.fit(spec, measured("emps")).model, pulses)
        for spec in ("coulomb+direction", "coulomb")
    )
    assert with_direction.rmse < without.rmse
    assert with_direction.rmse_held_out == with_direction.rmse


@pytest.mark.slow
def test_emps_misses_direction_first() -> None:
    """Friction of the screw differs by direction."""
    assert effects(improved("emps"))[:1] == ["direction"]


@pytest.mark.slow
@pytest.mark.parametrize(("number", "fall"), [(2, 0.40), (3, 0.30)])
def test_ur10e_joints_that_carry_the_arm_miss_load(number: int, fall: float) -> None:
    """One motion repeated, so that position does as well as load: that is said."""
    improvement = improved(f"ur10e_joint_{number}")
    first = improvement.steps[0].finding
    assert first.effect == "load"
    assert "position" in first.indistinguishable_from
    base, final = improvement.base.relative_residual, improvement.final.relative_residual
    assert base is not None and final is not None
    assert final <= (1.0 - fall) * base


@pytest.mark.slow
def test_ur10e_joint_1_misses_a_bent_viscous_curve() -> None:
    """It turns about the vertical: nothing loads it."""
    found = effects(improved("ur10e_joint_1"))
    assert found[:1] == ["nonlinear_viscous"]
    assert "load" not in found


@pytest.mark.slow
def test_bam_xl330_misses_load() -> None:
    """A hobby servo that swings a pendulum."""
    assert "load" in effects(improved("bam_xl330"))


def test_screw_drive_1() -> None:
    """Direction or offset, which steady speeds do not tell apart, then a Stribeck curve."""
    steps = improved("screwdrives_drive_1").steps
    pair = {"direction", "offset"}
    first = steps[0].finding
    assert first.effect in pair
    assert pair - {first.effect} <= set(first.indistinguishable_from)
    assert steps[1].finding.effect == "stribeck"


def test_screw_drive_3() -> None:
    """Offset and direction are one on steady speeds."""
    first = improved("screwdrives_drive_3").steps[0].finding
    pair = {"direction", "offset"}
    assert first.effect in pair
    assert pair - {first.effect} <= set(first.indistinguishable_from)
