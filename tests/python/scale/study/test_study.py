"""The whole of a study: figures against numpy, any number of processes, going on, refusing."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import SpecError, StribeckError
from stribeck.base.run_folder import MANIFEST
from stribeck.fitting.energy import electrical_energy
from stribeck.report.study import study_text
from stribeck.scale.study.result import Study
from stribeck.scale.study.store import FITS
from stribeck.scale.study.study import study

from .conftest import LAWS

STARTS = 3


@pytest.fixture(scope="module")
def made(two_joints: Path, tmp_path_factory: pytest.TempPathFactory) -> Study:
    """Three laws on two joints."""
    return study(two_joints, tmp_path_factory.mktemp("study") / "out", LAWS, starts=STARTS)


def without_seconds(frame: pl.DataFrame) -> list[dict]:
    return frame.drop("seconds").to_dicts()


def test_every_start_is_kept(made: Study) -> None:
    per_law = {"coulomb": 1, "bittencourt_a": STARTS, "lugre": STARTS}
    assert made.frame.height == 2 * sum(per_law.values())
    for (joint, law), rows in made.frame.group_by("joint", "law"):
        assert joint in ("near", "far")
        assert rows["start"].sort().to_list() == list(range(per_law[str(law)]))
        assert (rows["evaluations"] > 0).all() and (rows["seconds"] > 0.0).all()
        assert rows["rmse"].is_finite().all()
    read_back = pl.read_parquet(made.folder / "fits.parquet")
    assert read_back.equals(made.frame)
    assert pl.read_csv(made.folder / FITS)["rmse"].to_list() == made.frame["rmse"].to_list()


def test_figures_are_numpys_over_the_scored_rows(made: Study, two_joints: Path) -> None:
    for joint in ("near", "far"):
        recording = sb.read(two_joints, joint=joint)
        for table in made.tables:
            for row in table.rows:
                entry = row.entries[joint]
                torque = sb.evaluate(entry.best.model(recording), recording).prediction
                error = recording.torque - torque
                rows = recording.moving
                slow = rows & (np.abs(recording.velocity) < 0.1)
                for spread, of in ((entry.whole, error[rows]), (entry.low_speed, error[slow])):
                    assert spread.rows == of.size
                    assert spread.mean == pytest.approx(of.mean(), rel=1e-9, abs=1e-12)
                    assert spread.std == pytest.approx(of.std(), rel=1e-12)
                    assert spread.rms == pytest.approx(np.sqrt(np.mean(of**2)), rel=1e-12)
                    np.testing.assert_allclose(
                        spread.quartiles, np.percentile(of, [25, 50, 75]), rtol=1e-12
                    )
                    length = spread.quartiles[2] - spread.quartiles[0]
                    beyond = (of < spread.quartiles[0] - 1.5 * length) | (
                        of > spread.quartiles[2] + 1.5 * length
                    )
                    assert spread.whiskers == (of[~beyond].min(), of[~beyond].max())
                assert entry.best.rmse == pytest.approx(entry.whole.rms, rel=1e-12)
                assert entry.energy == electrical_energy(recording, torque)


def test_energy_is_summed_over_the_joints(made: Study) -> None:
    for table in made.tables:
        for row in table.rows:
            assert row.energy is not None
            parts = [entry.energy for entry in row.entries.values()]
            assert row.energy.measured == pytest.approx(sum(p.measured for p in parts))
            assert row.energy.modelled == pytest.approx(sum(p.modelled for p in parts))


def test_the_best_start_stands_in_the_table_and_the_best_law_first(made: Study) -> None:
    assert [table.group.id for table in made.tables] == ["static", "dynamic"]
    for table in made.tables:
        for row in table.rows:
            for joint, entry in row.entries.items():
                of = made.frame.filter(joint=joint, law=row.law)
                assert entry.best.rmse == of["rmse"].min()
                assert 1 <= entry.agreeing <= entry.trials == of.height
    static = made.tables[0]
    assert [row.law for row in static.rows] == ["bittencourt_a", "coulomb"]


@pytest.mark.slow
def test_processes_do_not_change_the_results(made: Study, two_joints: Path, tmp_path: Path) -> None:
    parallel = study(two_joints, tmp_path / "out", LAWS, starts=STARTS, workers=2)
    assert without_seconds(parallel.frame) == without_seconds(made.frame)


@pytest.mark.slow
def test_a_study_goes_on_where_it_was_stopped(
    made: Study, two_joints: Path, tmp_path: Path
) -> None:
    """Half of the fits and a line that was cut off in writing: the rest is made, nothing twice."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / MANIFEST).write_bytes((made.folder / MANIFEST).read_bytes())
    lines = (made.folder / FITS).read_text().splitlines(keepends=True)
    (folder / FITS).write_text("".join(lines[:7]) + lines[7][: len(lines[7]) // 2])
    told: list[tuple[int, int]] = []
    went_on = study(two_joints, folder, LAWS, starts=STARTS, progress=lambda *at: told.append(at))
    total = made.frame.height
    assert told == [(k, total) for k in range(7, total + 1)]
    assert without_seconds(went_on.frame) == without_seconds(made.frame)
    assert (folder / FITS).read_text().splitlines()[:7] == [x.rstrip("\n") for x in lines[:7]]


@pytest.mark.slow
def test_a_finished_study_is_only_read_again(made: Study, two_joints: Path, tmp_path: Path) -> None:
    shutil.copytree(made.folder, tmp_path / "out")
    told: list[tuple[int, int]] = []
    again = study(
        two_joints,
        tmp_path / "out",
        LAWS,
        starts=STARTS,
        low_speed=0.05,
        progress=lambda *at: told.append(at),
    )
    assert told == [] and again.frame.equals(made.frame)
    slow = {t.low_speed for t in again.joints.values()}
    assert slow == {0.05}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"starts": 4}, r"another number of starts \(3 there, 4 here\)"),
        ({"seed": 1}, r"another seed \(0 there, 1 here\)"),
        ({"laws": ("coulomb", "bittencourt_a")}, "other laws"),
        ({"joint": "near"}, "other options"),
        ({"gear_ratio": 50.0}, "other options"),
    ],
)
def test_other_arguments_are_refused(
    made: Study, two_joints: Path, change: dict, sentence: str
) -> None:
    arguments = {"laws": LAWS, "starts": STARTS, **change}
    before = (made.folder / FITS).read_bytes()
    with pytest.raises(StribeckError, match=sentence):
        study(two_joints, made.folder, **arguments)
    assert (made.folder / FITS).read_bytes() == before


def test_another_sidecar_is_refused(made: Study, two_joints: Path, tmp_path: Path) -> None:
    """The sidecar says what a current means: other numbers, other torques."""
    path = tmp_path / two_joints.name
    path.write_bytes(two_joints.read_bytes())
    with pytest.raises(StribeckError, match="another recording or sidecar"):
        study(path, made.folder, LAWS, starts=STARTS, joint_kind="revolute")


def test_a_folder_with_other_files_is_refused(two_joints: Path, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("important")
    with pytest.raises(StribeckError, match="not empty and holds no study"):
        study(two_joints, tmp_path, ("coulomb",))
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize("name", [MANIFEST, FITS])
def test_a_damaged_study_is_refused(
    made: Study, two_joints: Path, tmp_path: Path, name: str
) -> None:
    for kept in (MANIFEST, FITS):
        (tmp_path / kept).write_bytes((made.folder / kept).read_bytes())
    text = (tmp_path / name).read_text()
    broken = "{" if name == MANIFEST else text.replace(",true,", ",true,what,", 1)
    (tmp_path / name).write_text(broken.replace("0", "o", 30) if name == FITS else broken)
    with pytest.raises(StribeckError, match=f"{name} is damaged"):
        study(two_joints, tmp_path, LAWS, starts=STARTS)


def test_a_low_speed_must_be_positive(two_joints: Path, tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="low speed 0 must be above zero"):
        study(two_joints, tmp_path / "out", ("coulomb",), low_speed=0.0)


def test_json_is_plain_and_complete(made: Study) -> None:
    answer = json.loads(json.dumps(made.to_dict(), allow_nan=False))
    assert answer["complete"] is True and answer["fits"] == made.frame.height
    assert {"data", "laws", "starts", "seed", "tables", "skipped", "failed", "output"} <= set(
        answer
    )
    row = answer["tables"][0]["rows"][0]
    assert {"measured_J", "model_J", "error_J", "error_percent"} == set(row["energy"])
    of_joint = row["joints"][0]
    assert {
        "joint",
        "mean",
        "std",
        "rmse",
        "rmse_held_out",
        "low_speed",
        "quartiles",
        "whiskers",
        "best_start",
        "starts",
        "parameters",
    } <= set(of_joint)
    assert made.to_frame().height == 6


def test_the_text_shows_what_the_tables_hold(made: Study) -> None:
    text = study_text(made)
    assert max(map(len, text.splitlines())) <= 98 + len(str(made.folder))
    for word in (
        "near",
        "far",
        "bittencourt_a",
        "lugre",
        "[N m]",
        "|v| < 0.10 rad/s",
        "[J]",
        "[%]",
    ):
        assert word in text
    coulomb = next(r for r in made.tables[0].rows if r.law == "coulomb").entries["near"].whole
    assert f"± {coulomb.std:.4f}" in text or f"± {coulomb.std:.3f}" in text
    assert (made.folder / "tables.txt").read_text() == text + "\n"


def test_without_motor_constants_the_text_says_what_energy_needs(
    two_joints: Path, tmp_path: Path
) -> None:
    alone = tmp_path / "alone.parquet"
    alone.write_bytes(two_joints.read_bytes())
    made = study(alone, tmp_path / "out", ("coulomb",), joint="near", joint_kind="revolute")
    assert made.tables[0].rows[0].energy is None
    shown = " ".join(study_text(made).split())
    assert "km, kb and kt and the gear ratio" in shown


def test_a_sliding_joint_is_told_in_metres(tmp_path: Path, two_joints: Path) -> None:
    path = tmp_path / "slide.parquet"
    frame = pl.read_parquet(two_joints).filter(joint="near").drop("joint")
    scaled = {name: pl.col(name) / 10.0 for name in ("position", "velocity", "acceleration")}
    frame.with_columns(**scaled).write_parquet(path)
    made = study(path, tmp_path / "out", ("coulomb",), joint_kind="prismatic")
    data = made.joints[None]
    assert (data.low_speed, data.velocity_unit, data.torque_unit) == (0.01, "m/s", "N")
    assert "|v| < 0.010 m/s [N]" in study_text(made)
    assert made.tables[0].rows[0].entries[None].low_speed.rows > 0
