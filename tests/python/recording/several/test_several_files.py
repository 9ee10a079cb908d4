"""Several files as the runs of one recording: names, units, rates, blocks, disagreements."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from synthetic import joint


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three files of one joint, run_2, run_10 and run_1, each of 1000 samples."""
    made = tmp_path / "logs"
    made.mkdir()
    for k in (2, 10, 1):
        joint(rows=1000, seed=k).write_csv(made / f"run_{k}.csv")
    return made


def refused(files: object, *said: str, **options: object) -> None:
    """Reading is refused in one line that says `said`."""
    with pytest.raises(sb.RecordingError) as info:
        sb.read(files, **options)
    assert "\n" not in str(info.value)
    for words in said:
        assert words in str(info.value)


def test_each_file_is_a_run_with_its_name(folder: Path) -> None:
    by_list = sb.read([folder / f"run_{k}.csv" for k in (1, 2, 10)])
    by_folder, by_pattern = sb.read(folder), sb.read(str(folder / "run_*.csv"))
    for made in (by_list, by_folder, by_pattern):
        assert made.run_names == ("run_1", "run_2", "run_10")
        assert made.rows == 3000 and made.gaps == 0
        assert np.array_equal(np.bincount(made.run), [1000, 1000, 1000])
        assert np.flatnonzero(made.dt == 0.0).tolist() == [0, 1000, 2000]
    assert np.array_equal(by_list.velocity, by_pattern.velocity)


def test_a_list_of_one_file_is_that_file(folder: Path) -> None:
    one = sb.read([folder / "run_1.csv"])
    assert one.sha256 == sb.read(folder / "run_1.csv").sha256 and one.runs == 1


def test_runs_inside_a_file_keep_their_names(folder: Path) -> None:
    whole = joint(rows=1000, seed=3)
    pair = whole.with_columns(pl.Series("run", ["up"] * 500 + ["down"] * 500))
    pair.write_csv(folder / "run_3.csv")
    made = sb.read([folder / "run_1.csv", folder / "run_3.csv"])
    assert made.run_names == ("run_1", "run_3/up", "run_3/down")


def test_five_files_are_five_held_out_blocks(tmp_path: Path) -> None:
    for k in range(5):
        whole = joint(rows=600, seed=k).with_columns(pl.Series("run", [1] * 300 + [2] * 300))
        whole.write_csv(tmp_path / f"day_{k}.csv")
    made = sb.read(tmp_path)
    assert made.runs == 10 and made.block_count == 5
    assert np.array_equal(made.block, np.repeat(np.arange(5), 600))


def test_units_rates_and_sidecars_are_of_each_file(tmp_path: Path) -> None:
    joint(rows=1000, seed=1).write_csv(tmp_path / "a.csv")
    fast = joint(rows=2000, rate=200.0, seed=2)
    fast.with_columns(pl.col("velocity") * 30.0 / np.pi).rename({"velocity": "w"}).write_parquet(
        tmp_path / "b.parquet"
    )
    (tmp_path / "b.parquet.sidecar.toml").write_text(
        'kind = "recording"\n[map]\nvelocity = "w"\n[units]\nw = "rpm"\n', encoding="utf-8"
    )
    made = sb.read([tmp_path / "a.csv", tmp_path / "b.parquet"])
    np.testing.assert_allclose(made.velocity[1000:], fast["velocity"], atol=1e-12)
    assert made.dt[500] == pytest.approx(0.01) and made.dt[1500] == pytest.approx(0.005)
    assert made.columns["velocity"].source == "velocity, w"
    assert any(note.startswith("b.parquet: ") for note in made.notes)
    fitted = sb.fit("coulomb", made)
    assert fitted.model.value("coulomb_friction") == pytest.approx(3.0, abs=0.05)


def test_checks_are_made_file_by_file(folder: Path) -> None:
    wrong = joint(rows=1000, seed=7).with_columns(pl.col("velocity") * 6.0)
    wrong.write_csv(folder / "wrong.csv")
    made = sb.read([folder / "run_1.csv", folder / "wrong.csv"])
    bad = [check for check in made.checks if not check.ok]
    assert bad and all(check.said.startswith("wrong.csv: ") for check in bad)
    with pytest.raises(sb.RecordingError, match=r"wrong.csv: d\(position\)/dt"):
        sb.fit("coulomb", made)
    trusted = sb.read([folder / "run_1.csv", folder / "wrong.csv"], trust=True)
    trusted.require_consistent()


def test_steady_state_points_of_files_without_a_run_column(tmp_path: Path) -> None:
    for k, speed in enumerate((-1.0, -0.5, 0.5, 1.0, 1.5)):
        n = 50
        pl.DataFrame(
            {
                "time": np.arange(n) / 100.0,
                "velocity": np.full(n, speed),
                "torque": np.full(n, 2.0 * np.sign(speed) + speed),
            }
        ).write_csv(tmp_path / f"speed_{k}.csv")
    made = sb.read(tmp_path, average="run")
    assert made.velocity.tolist() == [-1.0, -0.5, 0.5, 1.0, 1.5]
    assert made.run_names == tuple(f"speed_{k}" for k in range(5))


def test_blocks_by_a_column_and_by_file(folder: Path) -> None:
    for k, payload in ((1, 0.0), (2, 0.0), (10, 5.0)):
        path = folder / f"run_{k}.csv"
        pl.read_csv(path).with_columns(pl.lit(payload).alias("payload")).write_csv(path)
    by_payload = sb.read(folder, hold_out="payload")
    assert by_payload.block_count == 2
    assert np.bincount(by_payload.block).tolist() == [2000, 1000]
    assert sb.read(folder, hold_out="file").block_count == 3
    refused(folder, "no column 'pay'", "payload", hold_out="pay")


def test_files_that_disagree(folder: Path) -> None:
    base = pl.read_csv(folder / "run_1.csv")

    def with_file(frame: pl.DataFrame, sidecar: str = "") -> list[Path]:
        path = folder / "other.csv"
        frame.write_csv(path)
        beside = folder / "other.csv.sidecar.toml"
        beside.unlink(missing_ok=True)
        if sidecar:
            beside.write_text(f'kind = "recording"\n{sidecar}\n', encoding="utf-8")
        return [folder / "run_1.csv", path]

    both = "other.csv", "run_1.csv"
    refused(with_file(base, 'joint_kind = "prismatic"'), *both, "joint kind 'prismatic'")
    refused(with_file(base, "gear_ratio = 101"), *both, "gear ratio 101, but 1")
    refused(with_file(base, 'torque_at = "link"'), *both, "place of the torque 'link'")
    refused(with_file(base.drop("load_torque")), *both, "no load_torque")
    warm = with_file(base.with_columns(pl.lit(20.0).alias("temperature")))
    pl.read_csv(warm[0]).drop("temperature", strict=False).write_csv(warm[0])
    refused(warm, *both, "no temperature", "temperature=none")
    assert sb.read(warm, map=["temperature=none"]).temperature is None
    named = with_file(base.with_columns(pl.lit("wrist").alias("joint")))
    base.with_columns(pl.lit("elbow").alias("joint")).write_csv(folder / "third.csv")
    refused([*named[1:], folder / "third.csv"], "'wrist'", "'elbow'")


def test_what_is_not_a_set_of_recordings(folder: Path, tmp_path: Path) -> None:
    one = folder / "run_1.csv"
    (tmp_path / "again").mkdir()
    copy = tmp_path / "again" / "run_1.csv"
    copy.write_bytes(one.read_bytes())
    (tmp_path / "m.csv").write_text('kind = "model"\nschema = 1\n', encoding="utf-8")
    (tmp_path / "none").mkdir()
    refused([one, copy], "would be run 'run_1'", str(one))
    refused([one, one], "is given twice")
    refused([], "no file is given")
    refused(str(folder / "x*.csv"), "no file matches")
    refused(tmp_path / "none", "no recordings in this folder")
    refused([one, tmp_path / "m.csv"], "m.csv: is a model file")
    refused([one, folder / "absent.csv"], "no such file")


def test_a_sidecar_named_by_a_shell_pattern_is_left_out(folder: Path) -> None:
    beside = folder / "run_1.csv.sidecar.toml"
    beside.write_text('kind = "recording"\n', encoding="utf-8")
    assert sb.read([folder / "run_1.csv", beside]).runs == 1
    refused(beside, "is a sidecar")


def test_a_model_fitted_to_one_of_the_files_has_no_held_out_error(folder: Path) -> None:
    whole = sb.read(folder)
    one = sb.read(folder / "run_2.csv")
    fitted = sb.fit("coulomb", one)
    assert sb.compare([fitted], whole).models[0].rmse_held_out is None
    other = sb.fit("coulomb", sb.read([folder / "run_1.csv", folder / "run_10.csv"]))
    assert sb.compare([other], one).models[0].rmse_held_out is not None
    file = sb.ModelFile.of(other)
    assert (
        len(file.hashes) == 3
        and sb.evaluate(other.model, whole, fitted_on=file.hashes).rmse_held_out is None
    )
