"""A planned motion shows what the data could not, and what it promises comes true."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from click.testing import CliRunner
from numpy.typing import NDArray
from stribeck.cli.main import cli
from stribeck.models.reader import read_model_file
from synthetic import COULOMB, VISCOUS, ar1, joint, motion, record

Array = NDArray[np.float64]
LIMITS = {"position": (-1.2, 1.2), "speed": 2.0, "acceleration": 10.0}
NOISE, MEMORY = 0.03, 0.5


def recorded(
    folder: Path, q: Array, v: Array, a: Array, extra: Array, seed: int, rate: float = 100.0
) -> sb.Recording:
    """A joint with inertia and gravity, Coulomb and viscous friction, and `extra` torque."""
    rng = np.random.default_rng(seed)
    load = 6.0 * np.sin(q + 0.4) + 0.3 * a
    friction = COULOMB * np.sign(v) + VISCOUS * v
    frame = pl.DataFrame(
        {
            "time": np.arange(q.size) / rate,
            "position": q,
            "velocity": v + 1e-4 * rng.standard_normal(q.size),
            "acceleration": a,
            "torque": load + friction + extra + ar1(rng, q.size, MEMORY, NOISE),
            "load_torque": load,
        }
    )
    return record(folder, frame, f"made_{seed}")


@pytest.fixture(scope="module")
def narrow(tmp_path_factory: pytest.TempPathFactory) -> sb.Fit:
    """Coulomb friction fitted to a motion over 0.1 rad, where a weight looks like an offset."""
    _, q, v, a = motion()
    folder = tmp_path_factory.mktemp("narrow")
    return sb.fit("coulomb", recorded(folder, 0.05 * q, 0.05 * v, 0.05 * a, 0.0 * q, 1))


@pytest.fixture(scope="module")
def planned(narrow: sb.Fit) -> sb.Plan:
    """A motion that tells them apart."""
    return sb.plan(narrow, separate=("offset", "gravity"), duration=30.0, **LIMITS)


def test_the_motion_keeps_to_its_limits(planned: sb.Plan) -> None:
    assert planned.limits.hold(planned.motion)
    frame = planned.to_frame()
    assert frame.columns == ["time", "position", "velocity", "acceleration"]
    assert frame["time"][-1] == pytest.approx(30.0) and planned.rate == 100.0


def test_what_looked_alike_no_longer_does(planned: sb.Plan) -> None:
    """Uniform passes of +-1.2 rad would leave 0.970: a constant against cos q and sin q."""
    ((pair, (before, after)),) = planned.cosines.items()
    assert pair == ("offset", "gravity")
    assert before is not None and before > 0.99 and after < 0.97
    for row in planned.prospects:
        assert row.gain is None or row.gain > 3.0
        assert row.after.value is not None


@pytest.mark.slow
def test_what_is_promised_comes_true(planned: sb.Plan, tmp_path: Path) -> None:
    """An offset of twice the promised size is found on the motion and told from a weight."""
    m = planned.motion
    row = next(row for row in planned.prospects if row.effect == "offset")
    assert row.after.value is not None
    for seed in range(4):
        extra = np.full(m.time.size, 2.0 * row.after.value)
        rec = recorded(tmp_path, m.position, m.velocity, m.acceleration, extra, 100 + seed)
        first = sb.diagnose(sb.fit("coulomb", rec)).findings[0]
        assert first.effect == "offset" and "gravity" not in first.indistinguishable_from


def test_a_fit_to_the_planned_motion_errs_as_little_as_promised(
    planned: sb.Plan, narrow: sb.Fit, tmp_path: Path
) -> None:
    """The scatter of the sizes falls by the stated gain, over recordings of both motions."""
    _, q, v, a = motion()
    m = planned.motion
    motions = {
        "before": (0.05 * q, 0.05 * v, 0.05 * a),
        "after": (m.position, m.velocity, m.acceleration),
    }
    row = next(row for row in planned.prospects if row.effect == "gravity")
    scatter = {}
    for name, (q_, v_, a_) in motions.items():
        found = [
            sb.fit("coulomb+offset+gravity", recorded(tmp_path, q_, v_, a_, 0.0 * q_, seed))
            for seed in range(12)
        ]
        scatter[name] = np.std([fit.model.value("gravity_sin") for fit in found])
        scatter[name] += np.std([fit.model.value("gravity_cos") for fit in found])
    assert scatter["before"] / scatter["after"] > (row.gain or 3.0) / 3.0
    assert scatter["before"] > 5.0 * scatter["after"]


@pytest.mark.slow
def test_the_same_seed_gives_the_same_motion(narrow: sb.Fit) -> None:
    one, same, other = (
        sb.plan(narrow, show=("stribeck",), duration=10.0, rate=50.0, seed=seed, **LIMITS)
        for seed in (3, 3, 4)
    )
    np.testing.assert_array_equal(one.motion.position, same.motion.position)
    assert not np.array_equal(one.motion.position, other.motion.position)


@pytest.mark.slow
def test_what_a_motion_cannot_do_is_said(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb", plain)
    rows = sb.plan(fit, show=("temperature_dry", "load"), duration=10.0, **LIMITS).prospects
    said = {row.effect: row.advice for row in rows}
    assert "warmer" in said["temperature_dry"] and "payload" in said["load"]


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"separate": ("load",)}, "two effects"),
        ({}, "no effect"),
        ({"show": ("laod",)}, "did you mean 'load'"),
        ({"show": ("viscosity",)}, "unknown"),
        ({"show": ("stribeck",), "duration": 0.1}, "out of range"),
        ({"show": ("stribeck",), "rate": 1.0}, "out of range"),
        ({"show": ("stribeck",), "speed": 1e-4}, "lost in the noise"),
        ({"separate": ("load", "load")}, "two effects"),
    ],
)
def test_bad_wishes(plain: sb.Recording, wrong: dict[str, object], word: str) -> None:
    with pytest.raises(sb.StribeckError, match=word):
        sb.plan(sb.fit("coulomb", plain), **{**LIMITS, **wrong})


def test_slow_data_name_the_rate_to_give() -> None:
    t = 2.0 * np.arange(500)
    v = 0.2 * np.cos(0.2 * t)
    torque = 2.0 * np.sign(v) + 0.05 * np.random.default_rng(0).standard_normal(t.size)
    slow = sb.Recording.from_columns(time=t, position=np.sin(0.2 * t), velocity=v, torque=torque)
    fitted, wishes = sb.fit("coulomb", slow, starts=1), {"position": (-1.0, 1.0), "speed": 1.0}
    said = "rate of 0.5 Hz, that of the recording, is out of range.*with option `rate`"
    with pytest.raises(sb.SpecError, match=said):
        sb.plan(fitted, **wishes, acceleration=5.0, show=("stribeck",))


def test_a_voltage_on_a_motor_is_refused(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb", plain)
    driven = replace(fit, model=replace(fit.model, drive="voltage"))
    with pytest.raises(sb.SpecError, match="plan with a model of the torque"):
        sb.plan(driven, show=("stribeck",), **LIMITS)


@pytest.mark.slow
def test_the_joint_of_an_identified_rigid_body(tmp_path: Path) -> None:
    """Its load torque follows from the model, and a repeated pose order is broken up."""
    fit = sb.fit("coulomb", record(tmp_path, joint().drop("load_torque")))
    made = sb.plan(fit, separate=("load", "position"), duration=10.0, rate=50.0, **LIMITS)
    assert all(row.after.value is not None for row in made.prospects)
    with pytest.raises(sb.StribeckError, match="gain"):
        sb.plan(fit, show=("gain",), duration=10.0, **LIMITS)


def test_an_effect_that_the_model_has_is_refused(plain: sb.Recording) -> None:
    with pytest.raises(sb.SpecError, match="has stribeck already"):
        sb.plan(sb.fit("coulomb+stribeck", plain), show=("stribeck",), **LIMITS)


def run(*arguments: str) -> tuple[int, str]:
    """Run a command; its exit code and what it printed, or the error."""
    result = CliRunner().invoke(cli, arguments)
    return result.exit_code, result.output if result.exception is None else str(result.exception)


COMMAND = ("--position", "-1:1", "--speed", "2", "--acceleration", "8", "--duration", "10")


@pytest.mark.slow
def test_command_with_data(tmp_path: Path) -> None:
    log, out, picture = tmp_path / "log.csv", tmp_path / "motion.csv", tmp_path / "motion.png"
    joint(rows=1500).write_csv(log)
    result = CliRunner().invoke(
        cli,
        [
            "plan",
            str(log),
            "coulomb",
            "--separate",
            "offset,gravity",
            *COMMAND,
            "--json",
            "--joint-kind",
            "revolute",
            "-o",
            str(out),
            "--plot",
            str(picture),
        ],
    )
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert answer["motion"]["speed"] <= 2.0 and answer["motion"]["acceleration"] <= 8.0
    assert {row["effect"] for row in answer["effects"]} == {"offset", "gravity"}
    frame = pl.read_csv(out)
    assert frame.columns == ["time", "position", "velocity", "acceleration"]
    assert frame["position"].abs().max() <= 1.0 and frame["velocity"].abs().max() <= 2.0
    assert picture.read_bytes()[:4] == b"\x89PNG"


@pytest.mark.slow
def test_command_without_data(tmp_path: Path, plain: sb.Recording) -> None:
    path = tmp_path / "joint.toml"
    fitted = sb.fit("coulomb", plain).model
    fitted.save(str(path))
    # A fitted model knows the error of its fit; the same values entered by hand do not.
    code, _ = run("plan", str(path), "--show", "stribeck", *COMMAND)
    assert code == 0
    fitted.with_values(fitted.values).save(str(path))
    code, text = run("plan", str(path), "--show", "stribeck", *COMMAND)
    assert code != 0 and "give option `noise`" in text
    code, text = run("plan", str(path), "--show", "stribeck", *COMMAND, "--noise", "0.05")
    assert code == 0 and "stribeck_height" in text and "on this data" not in text
    code, text = run("plan", str(path), "--show", "load", *COMMAND, "--noise", "0.05")
    assert code != 0 and "depends on the load" in text
    assert read_model_file(str(path)).model.spec == "coulomb"


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("--position", "1", "--speed", "1", "--acceleration", "1"), "LOW:HIGH"),
        (("--position", "1:0", "--speed", "1", "--acceleration", "1"), "are not a range"),
        (("--position", "0:1", "--speed", "-1", "--acceleration", "1"), "above 0"),
        ((*COMMAND, "-o", "motion.xlsx"), ".csv or .parquet"),
        ((*COMMAND, "-o", "nowhere/motion.csv"), "does not exist"),
    ],
)
def test_bad_commands(plain_file: Path, arguments: tuple[str, ...], word: str) -> None:
    code, text = run("plan", str(plain_file), "coulomb", "--show", "stribeck", *arguments)
    assert code != 0 and word in text


def test_plan_text_fits_a_terminal(planned: sb.Plan) -> None:
    text = repr(planned)
    assert max(map(len, text.splitlines())) <= 98
    assert "offset" in text and "planned" in text
    assert planned.plot().get_size_inches()[0] > 5


def test_limits_within_which_nothing_is_scored_are_refused(narrow: sb.Fit) -> None:
    tiny = {"position": (0.0, 1e-6), "speed": 2.0, "acceleration": 10.0}
    with pytest.raises(sb.SpecError, match="no sample at 10 Hz moves faster than"):
        sb.plan(narrow, show=["presliding"], duration=10.0, rate=10.0, **tiny)
