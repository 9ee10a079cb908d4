"""What a study is made of: laws, joints, starts, and what is left out with its reason."""

from __future__ import annotations

from pathlib import Path

import pytest
from stribeck.base.errors import FitError, RecordingError, SpecError
from stribeck.identify.scaling import model_for
from stribeck.models.catalog import law_ids
from stribeck.recording.stated.options import ReadOptions
from stribeck.scale.study.plan import DYNAMIC, REVIEW, STATIC, THERMAL, Job, group_of, make_plan
from synthetic import joint, record


def test_every_joint_every_law_every_start(two_joints: Path) -> None:
    plan = make_plan(str(two_joints), ReadOptions(), ("coulomb", "bittencourt_a"), starts=3)
    assert plan.joints == ("near", "far")
    expected = {Job(j, "bittencourt_a", k) for j in plan.joints for k in range(3)}
    # Coulomb's parameters follow from linear equations: one start is all there is.
    expected |= {Job(j, "coulomb", 0) for j in plan.joints}
    assert set(plan.jobs) == expected and len(plan.jobs) == len(expected)
    assert [job.joint for job in plan.jobs] == ["near"] * 4 + ["far"] * 4


def test_one_joint_may_be_named(two_joints: Path) -> None:
    plan = make_plan(str(two_joints), ReadOptions(joint="far"), ("coulomb",))
    assert plan.joints == ("far",)


def test_a_law_without_its_channel_is_skipped_with_the_reason(tmp_path: Path) -> None:
    path = tmp_path / "plain.parquet"
    joint().drop("temperature").write_parquet(path)
    plan = make_plan(str(path), ReadOptions(), ("coulomb", "tadese_t"), starts=2)
    assert [(s.joint, s.law) for s in plan.skipped] == [(None, "tadese_t")]
    assert "temperature" in plan.skipped[0].why
    assert {job.law for job in plan.jobs} == {"coulomb"}
    with pytest.raises(FitError, match=r"no law of the study can be fitted: .*temperature"):
        make_plan(str(path), ReadOptions(), ("tadese_t",))


@pytest.mark.parametrize(
    ("spec", "group"),
    [
        ("coulomb", STATIC),
        ("gaz_a", STATIC),
        ("coulomb+temperature_viscous", THERMAL),
        ("coulomb+load", THERMAL),
        ("dahl", DYNAMIC),
        ("tadese_t", DYNAMIC),
        ("coulomb+presliding", DYNAMIC),
    ],
)
def test_laws_stand_in_the_tables_of_the_review(tmp_path: Path, spec: str, group: object) -> None:
    assert group_of(model_for(spec, record(tmp_path, joint()))) == group


@pytest.mark.parametrize(
    ("laws", "sentence"),
    [
        (("columb",), "did you mean 'coulomb'"),
        (("coulomb", "bittencourt_a", "coulomb"), "'coulomb' is given twice"),
        ((), "at least one law"),
    ],
)
def test_wrong_laws_are_refused(two_joints: Path, laws: tuple, sentence: str) -> None:
    with pytest.raises(SpecError, match=sentence):
        make_plan(str(two_joints), ReadOptions(), laws)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"none\.parquet"):
        make_plan(str(tmp_path / "none.parquet"), ReadOptions(), ("coulomb",))


def test_the_laws_of_the_review_are_in_the_catalog_and_in_their_tables(tmp_path: Path) -> None:
    """14 laws of velocity, 7 with temperature or load, 4 dynamic ones."""
    assert set(REVIEW) <= set(law_ids()) and len(set(REVIEW)) == 25
    recording = record(tmp_path, joint())
    groups = [group_of(model_for(law, recording)) for law in REVIEW]
    assert groups == [STATIC] * 14 + [THERMAL] * 7 + [DYNAMIC] * 4


def test_starts_and_seed_must_make_sense(two_joints: Path) -> None:
    with pytest.raises(SpecError, match="give 1 or more"):
        make_plan(str(two_joints), ReadOptions(), ("coulomb",), starts=0)
    with pytest.raises(SpecError, match="seed -1 is negative"):
        make_plan(str(two_joints), ReadOptions(), ("coulomb",), seed=-1)
