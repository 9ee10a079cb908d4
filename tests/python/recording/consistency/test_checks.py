"""What the checks say of clean recordings, and what follows from a contradiction."""

from __future__ import annotations

import doctest
import json

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.base.errors import RecordingError
from stribeck.cli.main import main
from stribeck.recording.consistency import readings
from stribeck.recording.load import read

from ..conftest import joint


def _check(recording, name):
    (found,) = [check for check in recording.checks if check.check == name]
    return found


def test_examples():
    assert doctest.testmod(readings).failed == 0


def test_agreement_is_said(write):
    recording = read(write(joint()))
    assert [c.check for c in recording.checks] == [
        "time", "velocity", "acceleration", "load_torque", "torque", "torque_at", "temperature",
    ]  # fmt: skip
    assert all(check.ok for check in recording.checks)
    assert [check.check for check in recording.checks if check.do] == ["torque_at"]
    assert _check(recording, "velocity").said == "velocity = d(position)/dt within 0.01 %"


def test_uneven_time_stamps_are_told(write):
    frame = joint(rows=2000)
    jitter = 2e-3 * np.random.default_rng(0).uniform(-1.0, 1.0, 2000)
    uneven = _check(read(write(frame.with_columns(pl.col("time") + jitter))), "time")
    assert uneven.ok and "steps vary by" in uneven.said and "clock of the controller" in uneven.said
    # Lost rows leave longer steps, not an uneven clock.
    lost = frame.filter(np.arange(2000) % 37 != 0)
    assert "steps vary" not in _check(read(write(lost)), "time").said


def test_a_torque_that_is_the_same_in_every_sample_is_refused(write):
    constant = read(write(joint(rows=2000).drop("load_torque").with_columns(torque=pl.lit(1.5))))
    assert "is 1.5 N m in every sample" in _check(constant, "torque").said
    with pytest.raises(RecordingError, match=r"whatever the motion, which is no measurement"):
        sb.improve("coulomb", constant)


@pytest.mark.parametrize("noise", [0.0, 1e-4, 1e-2, 0.3])
@pytest.mark.parametrize("step", [0.0, 1e-4, 1e-2])
def test_noise_and_encoder_steps_are_no_contradiction(write, noise, step):
    frame = joint(noise=noise).drop("load_torque")
    if step:
        frame = frame.with_columns((pl.col("position") / step).round() * step)
    assert all(check.ok for check in read(write(frame)).checks)


def test_the_noise_of_differences_cancels_in_their_integral(write):
    """Velocity and acceleration computed by the controller from a noisy position."""
    frame = joint(rows=4002).drop("load_torque")
    q = frame["position"].to_numpy() + 2e-4 * np.random.default_rng(4).standard_normal(4002)
    made = frame[1:-1].with_columns(
        position=pl.Series(q[1:-1]),
        velocity=pl.Series((q[2:] - q[:-2]) * 100.0),
        acceleration=pl.Series((q[2:] - 2.0 * q[1:-1] + q[:-2]) * 200.0**2),
    )
    recording = read(write(made))
    assert all(check.ok for check in recording.checks)
    assert _check(recording, "acceleration").said.startswith("acceleration = d(velocity)/dt")


def _motion(kind, t):
    """Position and velocity of a fast, a stop-and-go, a one-way, a tiny and a rising motion."""
    if kind == "sine":
        return np.sin(1.1 * t) + 0.3 * np.sin(2.7 * t), 1.1 * np.cos(1.1 * t) + 0.81 * np.cos(
            2.7 * t
        )
    if kind == "one way":
        return 0.5 * t - 0.3 / 0.7 * np.cos(0.7 * t), 0.5 + 0.3 * np.sin(0.7 * t)
    if kind == "tiny":
        return 4e-3 * np.sin(0.8 * t), 3.2e-3 * np.cos(0.8 * t)
    if kind == "rising":
        phase = 2.0 * np.pi * (0.1 * t + 0.05 * t * t)
        return 0.4 * np.sin(phase), 0.4 * np.cos(phase) * 2.0 * np.pi * (0.1 + 0.1 * t)
    p = t % 8.0
    v = np.clip(np.minimum(p, 3.0 - p), 0.0, 0.5) - np.clip(np.minimum(p - 4.0, 7.0 - p), 0.0, 0.5)
    return np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(t))]), v


@pytest.mark.parametrize("kind", ["sine", "stops", "one way", "tiny", "rising"])
@pytest.mark.parametrize("step", [0.0, 1e-3, 6e-3])
def test_slow_sampling_and_coarse_encoders_are_no_contradiction(write, kind, step):
    """Also with a velocity that the drive differentiated from the encoder, filtered or not."""
    rng = np.random.default_rng(5)
    for rate in (10.0, 50.0, 200.0):
        t = np.arange(int((10.0 if kind == "rising" else 40.0) * rate)) / rate
        q, v = _motion(kind, t)
        read_out = np.round(q / step) * step if step else q
        torque = 0.5 * np.gradient(v, t) + 5.0 * np.cos(q) + 2.0 * np.sign(v) + v
        torque += 0.05 * rng.standard_normal(t.size)
        quotient = np.diff(read_out, prepend=read_out[0]) * rate
        for velocity in (v, quotient, v + 0.05 * np.abs(v).max() * rng.standard_normal(t.size)):
            frame = pl.DataFrame(
                {"time": t, "position": read_out, "velocity": velocity, "torque": torque}
            )
            wrong = [c.said for c in read(write(frame), standstill=True).checks if not c.ok]
            assert wrong == [], rate


@pytest.mark.parametrize("constant", [0.002, 0.02, 0.05])
def test_a_filter_of_the_drive_is_no_contradiction(write, constant):
    """A first-order low-pass delays and weakens the velocity."""
    frame = joint(rows=4000)
    v, low = frame["velocity"].to_numpy(), np.zeros(4000)
    for k in range(1, 4000):
        low[k] = low[k - 1] + (v[k] - low[k - 1]) * (1.0 - np.exp(-0.005 / constant))
    late = write(frame.with_columns(velocity=pl.Series(low)))
    assert _check(read(late), "velocity").ok
    check = _check(read(late, trust=True), "velocity")
    assert check.ok
    if constant > 0.01:
        delay = float(check.said.rsplit(", ", 1)[1].split(" ")[0])
        assert delay == pytest.approx(constant, abs=0.006)


def test_a_joint_that_is_pushed_is_no_error(write):
    """A motor that only brakes takes energy: that is not a reversed torque."""
    frame = joint().drop("load_torque")
    torque = -3.0 * np.sign(frame["velocity"].to_numpy()) + 0.5 * frame["acceleration"].to_numpy()
    check = _check(read(write(frame.with_columns(torque=pl.Series(torque)))), "torque")
    assert check.ok and check.said.startswith("cannot check")


def test_friction_that_is_hardly_any_of_the_torque_does_not_show_its_sign(write):
    """A small error of gravity is as large: the torque is not called reversed."""
    frame = joint().drop("load_torque")
    q, v, a = (frame[name].to_numpy() for name in ("position", "velocity", "acceleration"))
    torque = 3.0 * np.sin(q) - 0.01 * np.sign(v) - 0.002 * a
    check = _check(read(write(frame.with_columns(torque=pl.Series(torque)))), "torque")
    assert check.ok and "less than 2 % of the torque" in check.said
    torque = 3.0 * np.sin(q) - 0.3 * np.sign(v) - 0.2 * a
    assert not _check(read(write(frame.with_columns(torque=pl.Series(torque)))), "torque").ok


def test_a_temperature_that_never_changes_is_told(write):
    constant = read(write(joint().with_columns(temperature=pl.lit(0.0))))
    check = _check(constant, "temperature")
    assert check.ok and "is 0 degC in every sample" in check.said


def test_fits_refuse_a_contradiction_and_trust_goes_on(write):
    path = write(joint().with_columns(pl.col("velocity") * 9.5493), "x.parquet")
    recording = read(path)
    assert not _check(recording, "velocity").ok
    sentence = r"30|pi/30.*rpm against rad/s.*`unit=\"velocity=rpm\"`; or go on with option `trust`"
    with pytest.raises(RecordingError, match=sentence):
        sb.fit("coulomb", recording, starts=1)
    assert sb.fit("coulomb", read(path, trust=True), starts=1).rmse > 0.0
    assert sb.fit("coulomb", read(path, unit="velocity=rpm"), starts=1).rmse > 0.0


def test_trust_accepts_no_temperature_below_absolute_zero(write):
    path = write(joint().with_columns(temperature=pl.lit(-700.0)), "cold.parquet")
    sentence = "'temperature' is -700 to -700 degC, below absolute zero: [^;]*$"
    for trust in (False, True):
        with pytest.raises(RecordingError, match=sentence):
            sb.fit("coulomb", read(path, trust=trust), starts=1)
    # A scale of kelvins does not help.
    frame = joint().rename({"temperature": "temp_K"}).with_columns(temp_K=pl.lit(-5.0))
    checks = read(write(frame, "negative.parquet")).checks
    (remedy,) = [check.do for check in checks if check.check == "temperature"]
    assert str(remedy).startswith("leave it out")


@pytest.mark.parametrize("mark", [-999.0, 9999.0])
@pytest.mark.parametrize("name", ["temperature", "temp_K"])
def test_a_mark_of_missing_temperatures_is_told(write, mark, name):
    """It is left out, and not scaled with the others."""
    frame = joint().rename({"temperature": name})
    offset = 273.15 if name == "temp_K" else 0.0
    marked = pl.when(pl.int_range(pl.len()) % 100 == 7).then(mark).otherwise(pl.col(name) + offset)
    path = write(frame.with_columns(marked.alias(name)), "marked.csv")
    check = _check(read(path), "temperature")
    assert not check.ok and check.trustable == (mark > 0.0)
    assert f"is {mark - offset:.4g} degC in 20 samples, which no joint has" in check.said
    do = f'if it marks missing values, leave these samples out with `where="{name}!={mark:g}"`'
    assert check.do == do
    assert _check(read(path, where=f"{name}!={mark:g}"), "temperature").ok
    again = _check(read(path, where="time > 1"), "temperature")
    assert again.do is not None and f'where="(time > 1) and {name}!={mark:g}"' in again.do


def _run(capsys, monkeypatch, *arguments):
    """Exit code, stdout and stderr of a command."""
    monkeypatch.setattr("sys.argv", ["stribeck", *arguments])
    code = 0
    try:
        main()
    except SystemExit as stop:
        code = int(stop.code or 0)
    said = capsys.readouterr()
    return code, said.out, said.err


def test_commands_exit_with_2_and_inspect_with_0(write, capsys, monkeypatch):
    path = str(write(joint().with_columns(pl.col("velocity") * 57.2958), "x.parquet"))
    fit = ("fit", path, "--model", "coulomb", "--starts", "1")
    code, out, err = _run(capsys, monkeypatch, *fit, "--json")
    assert code == 2 and out == ""
    assert "--unit velocity=deg/s" in err and "--trust" in err
    code, out, err = _run(capsys, monkeypatch, "inspect", path, "--json")
    assert code == 0
    checks = json.loads(out)["checks"]
    assert [set(check) for check in checks] == [{"check", "ok", "said", "do"}] * len(checks)
    wrong = [check for check in checks if not check["ok"]]
    assert [check["check"] for check in wrong] == ["velocity", "acceleration"]
    assert all("velocity=deg/s" in check["do"] for check in wrong)
    code, out, err = _run(capsys, monkeypatch, *fit, "--trust")
    assert code == 0 and "note: accepted with --trust: d(position)/dt is" in err
    code, out, err = _run(capsys, monkeypatch, *fit, "--unit", "velocity=deg/s")
    assert code == 0
    # What agrees is one line; what nothing can decide says what to do.
    (passed,) = [line for line in err.splitlines() if line.startswith("note: checks passed: ")]
    assert "velocity = d(position)/dt within 0.01 %; acceleration = " in passed
    assert "cannot check" not in passed
    assert "note: cannot check where the torque ('torque') was measured" in err
    assert "state it with --torque-at" in err


def test_a_sidecar_may_trust(write):
    path = write(joint().with_columns(pl.col("velocity") * 9.5493))
    path.with_name(f"{path.name}.sidecar.toml").write_text('kind = "recording"\ntrust = true\n')
    assert read(path).trusted
    path.with_name(f"{path.name}.sidecar.toml").write_text('kind = "recording"\ntrust = 1\n')
    with pytest.raises(RecordingError, match="trust must be true or false"):
        read(path)


@pytest.mark.parametrize("follows", [True, False])
def test_a_load_torque_that_may_lack_an_inertia(write, follows):
    """A vertical screw: only the acceleration makes its load torque vary."""
    frame = joint()
    a, load = frame["acceleration"].to_numpy(), frame["load_torque"].to_numpy()
    part = 2.0 * a if follows else 5.0 * np.cos(3.0 * frame["time"].to_numpy())
    torque = frame["torque"].to_numpy() - load + 1.83 * part
    frame = frame.with_columns(torque=torque, load_torque=part)
    recording = read(write(frame), trust=True)
    said = _check(recording, "load_torque").said
    assert "times the load torque" in said
    assert said.endswith("or that lacks an inertia") is follows
