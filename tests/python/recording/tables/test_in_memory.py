"""Tables in memory are read like files: mapping, units, checks and errors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from synthetic import joint

pandas = pytest.importorskip("pandas")
pyarrow = pytest.importorskip("pyarrow")


def named(frame: pl.DataFrame) -> pl.DataFrame:
    """The same joint under other names and units."""
    return frame.with_columns(pl.col("velocity") * 30.0 / np.pi).rename(
        {"time": "t", "velocity": "w_rpm", "torque": "motor load"}
    )


def as_pandas(frame: pl.DataFrame) -> Any:
    return pandas.DataFrame({name: frame[name].to_numpy() for name in frame.columns})


FORMS = {
    "polars": lambda frame: frame,
    "lazy": lambda frame: frame.lazy(),
    "pandas": as_pandas,
    "pandas with an index": lambda frame: as_pandas(frame).set_index("t"),
    "pyarrow": lambda frame: frame.to_arrow(),
    "arrays": lambda frame: {name: frame[name].to_numpy() for name in frame.columns},
    "lists": lambda frame: {name: frame[name].to_list() for name in frame.columns},
    "fields": lambda frame: frame.to_numpy(structured=True),
}


@pytest.mark.parametrize("form", FORMS)
def test_a_table_is_read_like_a_file(form: str, tmp_path: Path) -> None:
    frame = named(joint(rows=800))
    frame.write_parquet(tmp_path / "joint.parquet")
    file = sb.read(tmp_path / "joint.parquet", map=["torque=motor load"])
    made = sb.read(FORMS[form](frame), map=["torque=motor load"])
    for name in ("time", "velocity", "torque", "acceleration", "load_torque", "block", "moving"):
        assert np.array_equal(getattr(file, name), getattr(made, name)), name
    assert made.notes == file.notes and made.checks == file.checks
    assert sb.fit("coulomb", made).rmse == sb.fit("coulomb", file).rmse


def test_the_hash_is_that_of_names_and_values() -> None:
    frame = joint(rows=300)
    first, again = sb.read(frame), sb.read(frame.clone())
    other = sb.read(frame.with_columns(pl.col("torque") + 1e-9))
    assert first.sha256 == again.sha256 != other.sha256
    assert sb.read(as_pandas(frame)).sha256 == first.sha256


def test_several_tables_are_runs(tmp_path: Path) -> None:
    one, two = joint(rows=500, seed=1), joint(rows=600, seed=2)
    two.write_csv(tmp_path / "two.csv")
    made = sb.read([one, two])
    assert made.run_names == ("1", "2") and made.rows == 1100
    assert np.array_equal(sb.read([one, tmp_path / "two.csv"]).velocity, made.velocity)


def test_from_columns() -> None:
    frame = joint(rows=500)
    v = frame["velocity"].to_numpy()
    made = sb.Recording.from_columns(
        time=frame["time"] * 1e3,
        velocity=np.rad2deg(v),
        torque=frame["torque"],
        load_torque=list(frame["load_torque"]),
        temperature=None,
        units={"time": "ms", "velocity": "deg/s"},
        joint="elbow",
        moving_above=0.01,
    )
    np.testing.assert_allclose(made.velocity, v, rtol=1e-12)
    assert made.rate_hz == pytest.approx(100.0) and made.joint == "elbow"
    assert made.velocity_threshold == 0.01 and made.temperature is None
    assert made.to_frame().columns[:3] == ["time", "velocity", "acceleration"]


def refused(said: str, **columns: Any) -> None:
    """`Recording.from_columns` refuses in one line."""
    with pytest.raises(sb.RecordingError, match=said) as info:
        sb.Recording.from_columns(**columns)
    assert "\n" not in str(info.value)


def test_wrong_columns() -> None:
    t = np.arange(100) / 100.0
    v = np.sin(t)
    good = {"time": t, "velocity": v, "torque": np.sign(v)}
    refused("'torque' has 99 values and 'time' 100", **{**good, "torque": v[1:]})
    refused("'velocity' is 100 x 1", **{**good, "velocity": v[:, None]})
    refused("'torque' is a single value", **{**good, "torque": 1.0})
    refused("'velocty' is neither a channel.*did you mean 'velocity'", velocty=v, **good)
    refused("there is no column 'position'", units={"position": "deg"}, **good)
    refused("furlong", units={"velocity": "furlong"}, **good)
    refused("neither a velocity nor a position", time=t, torque=v)
    refused("holds text|not a number|kinds", **{**good, "torque": ["a", 1.0] * 50})
    refused("NaN", **{**good, "torque": np.where(t > 0.5, np.nan, v)})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (3, "int 3 cannot be read: give a file"),
        ({}, "no rows of data"),
        ({"time": [], "velocity": [], "torque": []}, "no rows of data"),
        (pl.DataFrame({"time": [0.0, 1.0]}), "neither a velocity nor a position"),
        ([joint(rows=100), 3], "int 3 cannot be read"),
    ],
)
def test_what_cannot_be_read(given: Any, said: str) -> None:
    with pytest.raises(sb.RecordingError, match=said):
        sb.read(given)


def test_checks_of_a_table_in_memory() -> None:
    wrong = joint(rows=800).with_columns(pl.col("velocity") * 6.0)
    with pytest.raises(sb.RecordingError, match=r"the given table: d\(position\)/dt"):
        sb.fit("coulomb", sb.read(wrong))


def test_plot_has_a_panel_for_each_channel() -> None:
    one, two = joint(rows=400, seed=1), joint(rows=400, seed=2)
    figure = sb.read([one, two]).plot()
    assert [axes.get_ylabel().split(" [")[0] for axes in figure.axes] == [
        "position",
        "velocity",
        "torque",
        "temperature",
    ]
