"""Dry friction that a law by formula lacks is named, before what imitates or changes it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.base.errors import SpecError
from stribeck.diagnosis.loop.add import parameters_brought_by
from stribeck.diagnosis.trials.dry_friction import DRY, dry_friction_for
from synthetic import COULOMB, joint, motion, record


def improved(folder: Path, frame: object, **options: object) -> sb.Improvement:
    return sb.improve("b*v", record(folder, frame), **options)  # type: ignore[arg-type]


def test_dry_friction_is_named_and_nothing_else(tmp_path: Path) -> None:
    """Friction that grows with the load or differs by quadrant explains most of it too."""
    found = improved(tmp_path, joint())
    assert [step.finding.effect for step in found.steps] == ["dry"]
    assert found.steps[0].finding.confidence > 0.9
    # What predicts worse with more parameters is no alternative.
    assert found.steps[0].finding.indistinguishable_from == ()
    assert found.final.model.value("dry") == pytest.approx(COULOMB, rel=0.01)
    assert not found.to_dict()["final"]["undetermined"]  # type: ignore[index]


def test_it_comes_before_the_load_that_changes_it(tmp_path: Path) -> None:
    load = joint()["load_torque"].to_numpy()
    found = improved(tmp_path, joint(0.15 * np.abs(load) * np.sign(motion()[2])))
    assert [step.finding.effect for step in found.steps] == ["dry", "load"]
    assert found.final.model.value("dry") == pytest.approx(COULOMB, rel=0.1)


def test_where_there_is_none_it_is_not_named(tmp_path: Path) -> None:
    assert not improved(tmp_path, joint(-COULOMB * np.sign(motion()[2]))).steps


def test_it_can_be_rejected(tmp_path: Path) -> None:
    found = improved(tmp_path, joint(), rejected=["dry"], most_steps=1)
    assert "dry" not in {step.finding.effect for step in found.steps}
    with pytest.raises(SpecError, match="'drought'"):
        improved(tmp_path, joint(), rejected=["drought"])


def test_it_can_be_added_by_its_name(plain: sb.Recording) -> None:
    added = sb.add(sb.fit("b*v", plain, starts=1), "dry")
    assert added.model.value("dry") == pytest.approx(COULOMB, rel=0.01)
    assert parameters_brought_by("dry") == parameters_brought_by(DRY)
    with pytest.raises(SpecError, match="'dry' is unknown"):
        sb.add(added, "dry")


@pytest.mark.parametrize(
    ("law", "given", "offered"),
    [
        ("b*v", (), (DRY,)),
        ("b*v + k*abs(load)*sgn(v)", (), (DRY,)),
        ("b*v + c*sgn(v)", (), ()),
        ("b*v + c*tanh(v/w)", (), ()),
        ("coulomb", (), ()),
        # The user's own takes its place; a name is taken only once.
        ("b*v", ("creep = k*sgn(v)",), ()),
        ("b*v", ("creep = k*abs(load)*sgn(v)",), (DRY,)),
        ("dry*v", (), ()),
    ],
)
def test_it_is_offered_where_the_law_lacks_it(
    law: str, given: tuple[str, ...], offered: tuple[str, ...]
) -> None:
    model = sb.model(law) if law == "coulomb" else sb.law(law)
    assert dry_friction_for(model, given) == offered
