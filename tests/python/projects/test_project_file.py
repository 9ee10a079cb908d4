"""The project file: what it keeps, and what it refuses."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import ModelFileError, ProjectError


@pytest.fixture
def written(branched: sb.Project, folder: Path, tmp_path: Path) -> Path:
    """The project in a folder of its own, with its data."""
    branched.save()
    shutil.copytree(folder, tmp_path / "moved")
    return tmp_path / "moved" / "joint.toml"


def test_everything_reads_back_with_the_same_bits(branched: sb.Project, written: Path) -> None:
    again = sb.project(written)
    assert again.to_dict() == {**branched.to_dict(), "project": str(written)}
    for one, other in zip(again.tree, branched.tree, strict=True):
        assert np.array_equal(one.kept.model.values, other.kept.model.values)
        assert dict(one.kept.model.bounds) == dict(other.kept.model.bounds)
    text = written.read_text()
    again.save()
    assert written.read_text() == text


def test_how_the_file_was_read_is_kept_as_it_was_said(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    data = shutil.copy(folder / "data" / "joint.csv", tmp_path / "sub")
    sidecar = tmp_path / "said.toml"
    sidecar.write_text('kind = "recording"\njoint_kind = "revolute"\n')
    made = sb.Project.new(
        tmp_path / "p.toml",
        data,
        "coulomb",
        starts=1,
        sidecar=sidecar,
        inertia=0.0,
        map={"load_torque": "none"},
        where="time > 1.0",
        unit=(),
        km=None,
    )
    made.save()
    again = sb.project(tmp_path / "p.toml")
    assert again.source.reading == {
        "sidecar": "said.toml",
        "inertia": 0.0,
        "map": ["load_torque=none"],
        "where": "time > 1.0",
    }
    assert again.source.path == "sub/joint.csv" and len(again.source.files) == 1
    assert len(again.recording) == len(made.recording)
    assert again.source.options["sidecar"] == str(sidecar)
    sidecar.write_text(sidecar.read_text() + "gear_ratio = 2.0\n")
    with pytest.raises(ProjectError, match="sidecar"):
        sb.project(tmp_path / "p.toml")


def test_a_node_added_changes_only_lines_of_its_own(written: Path) -> None:
    before = written.read_text().splitlines()
    sb.project(written).reject("gravity", "vertical axis").save()
    after = written.read_text().splitlines()
    assert [line for line in before if line not in after] == []
    assert [line for line in after if line not in before] == ['gravity = "vertical axis"']


def test_the_fit_behind_a_stored_node_is_the_same(branched: sb.Project, written: Path) -> None:
    again = sb.project(written)
    assert again.fit.rmse == pytest.approx(branched.fit.rmse, rel=1e-6)
    assert again.fit.rmse_held_out == pytest.approx(branched.fit.rmse_held_out, rel=1e-4)


def test_the_model_file_is_that_of_the_current_node(branched: sb.Project, written: Path) -> None:
    target = written.parent / "model.toml"
    sb.project(written).save_model(target)
    stored = sb.read_model_file(target)
    assert np.array_equal(stored.model.values, branched.node.kept.model.values)
    assert stored.fitted_on["sha256"] == branched.source.sha256
    assert Path(stored.fitted_on["path"]).is_file()


def test_other_data_are_refused_in_one_line(written: Path) -> None:
    data = written.parent / "data" / "joint.csv"
    text = data.read_text()
    data.write_text(text.replace("\n", "\n0.0", 1))
    with pytest.raises(ProjectError, match="has changed since the project was made") as caught:
        sb.project(written)
    assert "\n" not in str(caught.value)
    data.write_text(text)
    sidecar = data.parent / "joint.csv.sidecar.toml"
    sidecar.write_text('kind = "recording"\n')
    with pytest.raises(ProjectError, match="sidecar"):
        sb.project(written)
    sidecar.unlink()
    data.unlink()
    with pytest.raises(ProjectError, match="cannot be read"):
        sb.project(written)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('kind = "project"', 'kind = "model"', "not a project"),
        ("schema = 1", "schema = 9", "schema 9 is unknown"),
        ("current = 2", "current = 7", "no such node"),
        ('change = "add"', 'change = "ad"', "base or add or drop"),
        ("parent = 0", "parent = 5", "no earlier node has this number"),
        ('effect = "offset"', 'effect = "gravity"', "does not follow from node 0"),
        ("confidence = ", 'confidence = "sure" # ', "a finite number is needed"),
        ('verdict = "missing"', 'verdict = "maybe"', "verdict is missing or none"),
        ("[reading]", "[reading]\nmapp = 1", "did you mean 'map'"),
        ("current = 2", "current = 2\nnote = 1", "key 'note' is unknown"),
        ('change = "base"', 'change = "base"\nparent = 3', "neither a parent"),
        ('path = "data/joint.csv"', "path = 3", "a text is needed"),
        ("rmse = ", "rmse = nan # ", "a finite number is needed"),
        ("rmse = ", "# rmse = ", "has no rmse"),
        ("nodes.1", "nodes.x", "not a numbered table"),
        ("current = 2", "current = ", "not a TOML file"),
    ],
)
def test_what_is_not_understood_is_refused(written: Path, old: str, new: str, said: str) -> None:
    text = written.read_text()
    assert old in text
    written.write_text(text.replace(old, new) if old == "nodes.1" else text.replace(old, new, 1))
    with pytest.raises(ProjectError, match=said) as caught:
        sb.project(written)
    assert "\n" not in str(caught.value)


def test_a_wrong_model_inside_is_refused_with_its_line(written: Path) -> None:
    lines = written.read_text().splitlines()
    place = lines.index("[nodes.2.model.parameters.coulomb_friction]") + 1
    assert lines[place].startswith("value = ")
    lines[place] = 'value = "much"'
    written.write_text("\n".join(lines))
    with pytest.raises(ModelFileError, match=f"line {place + 1}: .*a number is needed"):
        sb.project(written)


def test_a_project_is_written_beside_its_data_or_not_at_all(
    branched: sb.Project, tmp_path: Path
) -> None:
    with pytest.raises(ProjectError, match="write it to this folder"):
        branched.save(tmp_path / "elsewhere.toml")
    assert list(tmp_path.iterdir()) == []


def test_several_files_are_runs_of_the_joint(folder: Path, tmp_path: Path) -> None:
    given = folder / "data" / "joint.csv"
    paths = [tmp_path / f"run{k}.csv" for k in (1, 2)]
    for factor, path in zip((1.0, 1.01), paths, strict=True):
        pl.read_csv(given).with_columns(pl.col("torque") * factor).write_csv(path)
    made = sb.Project.new(tmp_path / "p.toml", paths, "coulomb", starts=1, where="time > 1.0")
    made.save()
    again = sb.project(tmp_path / "p.toml")
    assert again.to_dict() == made.to_dict()
    assert [one.path for one in again.source.files] == ["run1.csv", "run2.csv"]
    assert again.recording.run_names == ("run1", "run2")
    assert again.source.sha256 == sb.read(paths, where="time > 1.0").sha256
    text = (tmp_path / "p.toml").read_text()
    assert text.count("[[data]]") == 2
    paths[1].write_text(given.read_text().replace("\n", "\n0.0", 1))
    with pytest.raises(ProjectError, match=r"run2\.csv has changed since"):
        sb.project(tmp_path / "p.toml")
    (tmp_path / "p.toml").write_text(text.replace("[[data]]", "[[date]]"))
    with pytest.raises(ProjectError, match="date"):
        sb.project(tmp_path / "p.toml")
