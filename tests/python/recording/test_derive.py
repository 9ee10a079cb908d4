"""Derived columns: derivatives, means, choices, tables, and channels that are no columns."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck import _core
from stribeck.base.errors import RecordingError
from stribeck.recording.stated.options import ReadOptions
from stribeck.recording.stated.settings import gather
from stribeck.recording.tables.column_functions import table_problem
from stribeck.recording.tables.formula import compile_formula
from stribeck.recording.whole_file.table import prepare

Write = Callable[..., Path]


def column(path: Path, *derive: str, name: str = "x", **options: object) -> np.ndarray:
    """A derived column of a file, [rows]."""
    given = ReadOptions(derive=derive, **options)
    return prepare(str(path), gather(path, given)).table[name].to_numpy()


def noisy(rows: int = 4000, rate: float = 500.0) -> pl.DataFrame:
    """A slow motion whose position alone is recorded, with noise, and a power."""
    rng = np.random.default_rng(3)
    t = np.arange(rows) / rate
    q = 0.5 * np.sin(2 * np.pi * 0.5 * t)
    v = 0.5 * np.pi * np.cos(2 * np.pi * 0.5 * t)
    tau = 4.0 * np.sign(v) + 1.5 * v
    return pl.DataFrame(
        {
            "time": t,
            "position": q + 2e-5 * rng.standard_normal(rows),
            "power": tau * v,
            "true_v": v,
            "true_tau": tau,
        }
    )


def test_a_measured_power_becomes_a_torque(write: Write) -> None:
    """The velocity that is derived from the position can be divided by."""
    path = write(noisy())
    formula = "torque=where(abs(velocity) > 0.05, power/velocity, 0)"
    recording = sb.read(path, derive=formula, map="load_torque=none")
    away = np.abs(noisy()["true_v"].to_numpy()) > 0.1
    error = recording.torque[away] - noisy()["true_tau"].to_numpy()[away]
    assert np.sqrt(np.mean(error**2)) < 0.02
    assert any(
        "velocity in formulas: derived from position, zero-phase" in n for n in recording.notes
    )


def test_the_velocity_of_a_formula_is_that_of_the_recording(write: Write) -> None:
    path = write(noisy().with_columns(torque=pl.col("true_tau")))
    recording = sb.read(path)
    assert np.array_equal(column(path, "x=velocity"), recording.velocity)
    assert np.array_equal(column(path, "x=acceleration"), recording.acceleration)


def test_channels_are_in_si_units(write: Write, frame: pl.DataFrame) -> None:
    degrees = frame.select(
        "time",
        "torque",
        q_deg=np.degrees(frame["position"]),
        speed_rpm=frame["velocity"] * 30 / np.pi,
    )
    path = write(degrees)
    assert column(path, "x=position") == pytest.approx(frame["position"].to_numpy(), abs=1e-12)
    assert column(path, "x=velocity") == pytest.approx(frame["velocity"].to_numpy(), abs=1e-12)
    # The column of the file wins over the channel of the same name.
    both = write(
        frame.with_columns(velocity=2.0 * pl.col("velocity"), q_deg=pl.lit(1.0)), "b.parquet"
    )
    assert column(both, "x=velocity") == pytest.approx(2.0 * frame["velocity"].to_numpy())


def test_a_derived_column_is_seen_by_later_ones(write: Write, frame: pl.DataFrame) -> None:
    path = write(frame)
    found = column(path, "double=2*velocity", "x=double - mean(double)")
    v = frame["velocity"].to_numpy()
    assert found == pytest.approx(2 * v - 2 * v.mean())


def test_diff_is_a_zero_phase_derivative_that_states_its_filter(write: Write) -> None:
    path = write(noisy())
    given = ReadOptions(derive=("x=diff(position)",))
    prepared = prepare(str(path), gather(path, given))
    error = prepared.table["x"].to_numpy() - noisy()["true_v"].to_numpy()
    plain = np.gradient(noisy()["position"].to_numpy(), 0.002) - noisy()["true_v"].to_numpy()
    assert np.sqrt(np.mean(error**2)) < 0.2 * np.sqrt(np.mean(plain**2))
    (note,) = [note for note in prepared.notes if "diff" in note]
    assert "zero-phase low-pass at" in note and "Hz chosen from the data" in note


def test_diff_and_mean_keep_joints_runs_and_gaps_apart(write: Write) -> None:
    t = np.arange(200) / 100.0
    parts = [
        pl.DataFrame({"time": t, "joint": j, "run": r, "position": slope * t + 7.0 * r})
        for j, r, slope in ((1, 1, 2.0), (1, 2, -3.0), (2, 1, 5.0))
    ]
    table = pl.concat(parts)
    path = write(table)
    found = column(path, "x=diff(position)")
    assert found == pytest.approx(np.repeat([2.0, -3.0, 5.0], 200), abs=1e-6)
    mean = column(path, "x=mean(position)")
    first = table.filter(pl.col("joint") == 1)["position"].mean()
    assert mean[:400] == pytest.approx(first)
    assert mean[400:] == pytest.approx(table.filter(pl.col("joint") == 2)["position"].mean())
    holed = table.with_columns(
        position=pl.when(pl.int_range(pl.len()).is_between(90, 109))
        .then(None)
        .otherwise("position")
    )
    found = column(write(holed, "holed.parquet"), "x=diff(position)")
    assert np.isnan(found[90:110]).all()
    assert found[:90] == pytest.approx(2.0, abs=1e-6)
    assert found[110:200] == pytest.approx(2.0, abs=1e-6)


def test_interp_and_where(write: Write, frame: pl.DataFrame) -> None:
    path = write(frame)
    v = frame["velocity"].to_numpy()
    found = column(path, "x=interp(abs(velocity), 0, 0.5, 1, 0.7, 2, 0.8)")
    assert found == pytest.approx(np.interp(np.abs(v), [0, 1, 2], [0.5, 0.7, 0.8]))
    found = column(path, "x=where(velocity > 0 and time < 5, velocity, -g*pi)")
    held = (v > 0) & (frame["time"].to_numpy() < 5)
    assert found == pytest.approx(np.where(held, v, -9.80665 * np.pi))


def test_where_of_a_missing_condition_is_missing() -> None:
    table = pl.DataFrame({"a": [1.0, None, 3.0]})
    formula = compile_formula("where(a > 2, 1, 0)", table.schema, "t.csv: f")
    assert table.select(formula.expression.alias("f"))["f"].to_list() == [0.0, None, 1.0]


def test_conditions_see_channels(write: Write) -> None:
    path = write(noisy().with_columns(torque=pl.col("true_tau")))
    recording = sb.read(path, where="abs(velocity) > 1.0")
    assert np.abs(recording.velocity).min() > 0.95
    assert recording.rows < 3000


def test_every_function_of_columns_is_known() -> None:
    assert _core.column_functions() == ["diff", "mean", "where", "interp"]
    table = pl.DataFrame({"a": [1.0, 2.0]})
    for text in ("diff(a)", "mean(a)", "where(a > 1, a, 0)", "interp(a, 0, 1, 2, 3)"):
        assert compile_formula(text, table.schema, "f").columns == ("a",)


@pytest.mark.parametrize(
    ("derive", "sentence"),
    [
        ("x=diff(position, 2)", "diff takes 1 argument, not 2, at position 1"),
        ("x=where(velocity)", "where takes 3 arguments, not 1"),
        ("x=interp(velocity, 0, 1)", "interp takes 5 or more arguments, not 3"),
        ("x=interp(velocity, 0, 1, 2, 3, 4)", "points in pairs"),
        ("x=interp(velocity, 0, 1, position, 3)", "points of interp must be numbers"),
        ("x=interp(velocity, 1, 1, 0, 3)", "increasing order of x"),
        ("x=external_torque*2", "no column for the channel 'external_torque'"),
        ("x=velocityy", r"did you mean 'velocity'\?"),
    ],
)
def test_refused(write: Write, frame: pl.DataFrame, derive: str, sentence: str) -> None:
    with pytest.raises(RecordingError, match=sentence):
        sb.read(write(frame), derive=derive)


def test_what_needs_time_or_a_position_says_so(write: Write, frame: pl.DataFrame) -> None:
    points = write(frame.select("velocity", "torque").head(40), "points.csv")
    with pytest.raises(RecordingError, match="derivative needs a time column"):
        sb.read(points, average="row", derive="x=diff(velocity)")
    bare = write(frame.select("time", "torque"), "bare.csv")
    with pytest.raises(RecordingError, match="'velocity', and no position to derive it from"):
        sb.read(bare, derive="x=torque/velocity")
    assert sb.read(points, average="row", derive="torque=torque - 0*mean(velocity)").rows == 40


def test_weights_and_laws_have_no_functions_of_all_samples(
    write: Write, frame: pl.DataFrame
) -> None:
    with pytest.raises(RecordingError, match="'diff' needs the whole recording"):
        sb.read(write(frame), weights="1/(1 + abs(diff(velocity)))")
    with pytest.raises(_core.ModelError, match="'diff' is a function of columns alone"):
        _core.Formula("c*diff(v)")


def test_a_table_has_its_points_in_order() -> None:
    assert table_problem([0.0, 1.0, 2.0, 3.0]) is None
    assert "increasing" in str(table_problem([0.0, 1.0, 0.0, 3.0]))


#: Of the drive of the gantry: motor over speed, gear, power factor; line voltage, V.
_MOTOR = ((0.0, 0.5), (0.01, 0.68), (0.2, 0.74))
_GEAR, _FACTOR, _VOLTAGE = 0.78, 0.86, 380.0
sys.path.append(str(Path(__file__).parents[1] / "fitting" / "methods"))


def electrical_log() -> pl.DataFrame:
    """What the gantry's instruments record: displacement, voltage and current, with noise."""
    import gantry

    speeds = [0.001, 0.0015, 0.002, 0.003, 0.004, 0.006, 0.01, 0.02, 0.05, 0.1, 0.2]
    rate, rng = 500.0, np.random.default_rng(1)
    velocity, force = gantry.driven(gantry.passes(speeds, rate=rate), 1.0 / rate)
    power = np.maximum(force * velocity, 0.0)
    efficiency = np.interp(np.abs(velocity), *np.transpose(_MOTOR)) * _GEAR
    voltage = _VOLTAGE + 1.0 * rng.standard_normal(power.size)
    current = power / efficiency / (np.sqrt(3.0) * _VOLTAGE * _FACTOR)
    position = np.cumsum(velocity) / rate + 1e-6 * rng.standard_normal(power.size)
    return pl.DataFrame(
        {
            "t_s": np.arange(power.size) / rate,
            "x_mm": 1e3 * position,
            "line_V": voltage,
            "line_A": current + 1e-4 * rng.standard_normal(power.size),
        }
    )


@pytest.mark.slow
def test_the_gantry_from_voltage_and_current_to_its_friction_map(tmp_path: Path) -> None:
    """Seed paper "Gantry": power, efficiencies, force, static map, all by flags of the command."""
    import gantry

    log, points = tmp_path / "gantry.csv", tmp_path / "points.csv"
    electrical_log().write_csv(log)
    table = ", ".join(f"{x}, {y}" for x, y in _MOTOR)
    flags = [
        "--map",
        "position=x_mm",
        "--derive",
        f"power=sqrt(3)*line_V*line_A*{_FACTOR}*{_GEAR}*interp(abs(velocity), {table})",
        "--derive",
        "torque=power/velocity",
        "--where",
        "abs(velocity) > 0.0002",
        "--unit",
        "torque=N",
    ]
    words = ["points", log, "--method", "segments", *flags, "-o", points]
    assert len(run(*words)["points"]) == 22
    made = run("fit", points, "--model", "gantry_map")
    truth = {
        "coulomb_friction": gantry.COULOMB,
        "static_friction": gantry.STATIC,
        "stribeck_velocity": gantry.STRIBECK,
        "viscous_friction_forward": gantry.FORWARD,
        "viscous_friction_backward": gantry.BACKWARD,
    }
    found = {name: made["parameters"][name]["value"] for name in truth}
    # The slowest pass is at 0.0004 m/s with 0.00003 m/s of noise: 1/v is then too large by the
    # square of their ratio, 0.6 %, which the Stribeck velocity takes up.
    slow = found.pop("stribeck_velocity")
    assert slow == pytest.approx(truth.pop("stribeck_velocity"), rel=0.08)
    assert found == pytest.approx(truth, rel=0.025)


def run(*words: object) -> dict:
    """Run the command as a user does; its JSON."""
    command = [sys.executable, "-m", "stribeck", *map(str, words), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
