"""What an effect does under load is said for the load that was recorded."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.effect.base import Identified
from stribeck.effect.describe import where
from synthetic import behind_a_filter, joint, record


def on(recording: sb.Recording, fitted: Identified) -> Identified:
    """The same model, identified on a recording."""
    return cast(Identified, SimpleNamespace(model=fitted.model, recording=recording))


def with_values(spec: str, **values: float) -> Identified:
    """A model with an RMS load of 4 N m, as identified."""
    made = replace(
        sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5),
        box={"velocity": (-1.0, 1.0), "load_torque": (-9.0, 9.0)},
    )
    constants = {"load": {"reference_load": 4.0}, "warm_up": {"duration": 60.0}}
    for effect in spec.split("+"):
        made = made.with_effect(effect, constants.get(effect, {}))
    known = dict(zip(made.names, made.values, strict=True)) | values
    model = made.with_values([known[name] for name in made.names])  # type: ignore[arg-type]
    recorded = {"acceleration": SimpleNamespace(derived=False)}
    recording = SimpleNamespace(columns=recorded)
    return cast(Identified, SimpleNamespace(model=model, recording=recording))


CURVE = {"stribeck_height": 0.5, "stribeck_velocity": 0.2, "stribeck_exponent": 2.0}
LOAD = {"load_coulomb": 0.25, "load_exponent": 1.0, "load_stribeck_ratio": 2.0}


@pytest.mark.parametrize(("part", "said"), [(0.3, True), (0.1, False)])
def test_a_curve_that_the_load_makes(part: float, said: bool) -> None:
    """0.3 of 4 N m is more than the 0.5 N m without load, 0.1 of them less."""
    after = with_values("stribeck+load", **CURVE, **LOAD, load_stribeck=part)
    text = where("stribeck", after, after)
    assert "0.5 N m higher than the Coulomb level" in text
    more = "under 4 N m of load 1.2 N m more, falling around 0.4 rad/s"
    assert (more in text) is said


@pytest.mark.parametrize(("spec", "distance"), [("presliding", 0.02), ("load+presliding", 0.03)])
def test_bristles_bend_further_under_load(spec: str, distance: float) -> None:
    values = {"presliding_stiffness": 100.0, "presliding_damping": 0.0}
    load = {"load_coulomb": 0.25, "load_exponent": 1.0} if "load" in spec else {}
    after = with_values(spec, **values, **load)
    assert f"over about {distance} rad" in where("presliding", after, after)


@pytest.mark.parametrize(("share", "said"), [(-(0.09**2) / 24.0, True), (1e-3, False)])
def test_a_load_torque_that_was_smoothed_does_the_same_as_elasticity(
    share: float, said: bool
) -> None:
    """A moving average over 0.09 s takes away that part of the second derivative."""
    after = with_values("elasticity", elasticity=share)
    assert (
        "a load torque averaged over 0.09 s does the same" in where("elasticity", after, after)
    ) is said


@pytest.mark.parametrize("spec", ["warm_up", "gain+warm_up"])
def test_an_amplifier_that_warms_up_beside_a_gain_is_compared_with_its_end(spec: str) -> None:
    """The gain of the model is that at the end, so that both may cancel at the start."""
    values = {"gain": 0.1} if "gain" in spec else {}
    after = with_values(spec, warm_up=-0.1, warm_up_zero=0.0, warm_up_rate=3.0, **values)
    text = where("warm_up", after, after)
    assert ("shows, compared with the end, 10 % too little" in text) == ("gain" in spec)
    assert "time constant of 20 s" in text


@pytest.mark.parametrize(
    ("filtered", "delay", "said"),
    [
        (0.018, -0.008, ", as behind a filter, which explains it"),
        (0.018, 0.008, ", as behind a filter; the torque lags behind the position by 16 ms"),
        (0.018, -0.003, ", as behind a filter; the torque lags behind the position by 4.99 ms"),
        (0.01, -0.008, ""),
    ],
)
def test_a_filter_of_the_velocity_explains_a_torque_that_leads(
    filtered: float, delay: float, said: str, tmp_path: Path
) -> None:
    """The discrete filter is a sample of 0.01 s faster than its time constant."""
    recording = record(tmp_path, behind_a_filter(joint(), filtered), trust=True)
    late = on(recording, with_values("delay", delay=delay))
    text = where("delay", late, late)
    assert text.endswith(said)
    assert ("the velocity is 7.99 ms behind the position" in text) is bool(said)


@pytest.mark.parametrize(("second", "period"), [(0.02, "0.1 rad"), (0.2, "0.05 rad")])
def test_a_ripple_whose_second_harmonic_dominates_has_that_period(
    second: float, period: str, tmp_path: Path
) -> None:
    """The period of 0.1 rad is that of the first harmonic."""
    values = {"ripple_cos": 0.03, "ripple_sin": 0.0, "ripple_second_sin": 0.0}
    zero = {"ripple_second_cos": second, "ripple_detuning": 0.0}
    made = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    constants = {"position_length": 1.0, "position_start": 0.0, "ripple_period": 0.1}
    model = made.with_effect("ripple", constants)
    known = dict(zip(model.names, model.values, strict=True)) | values | zero
    after = cast(
        Identified,
        SimpleNamespace(
            model=model.with_values([known[name] for name in model.names]),  # type: ignore[arg-type]
            recording=record(tmp_path, joint()),
        ),
    )
    assert f"repeats every {period} " in where("ripple", after, after)


@pytest.mark.parametrize(
    ("turned", "said"), [(True, "in both directions"), (False, "forward only")]
)
def test_friction_along_the_stroke_says_which_directions_pass(
    tmp_path: Path, turned: bool, said: str
) -> None:
    """The friction is highest near 1.2 rad, which the joint passes forward, or to and fro."""
    t = np.arange(0.0, 60.0, 0.01)
    q = 2.0 * np.sin(0.6 * t)
    v = np.gradient(q, t)
    dry = 1.0 + 0.5 * np.exp(-(((q - 1.2) / 0.3) ** 2))
    frame = pl.DataFrame({"time": t, "position": q, "velocity": v, "torque": np.sign(v) * dry})
    if not turned:
        frame = frame.filter(~((pl.col("velocity") < 0.0) & (pl.col("position") > 0.9)))
    fitted = sb.fit("coulomb+position", sb.read(frame), starts=1)
    assert said in where("position", fitted, fitted)


@pytest.mark.parametrize(
    ("viscous", "said"),
    [
        (0.3, "by 0.4 N m near rest and by 1 N m at 1 rad/s, larger forward"),
        (-0.3, "by 0.4 N m near rest, larger forward, and by 0.2 N m at 1 rad/s, larger backward"),
    ],
)
def test_directions_whose_difference_changes_its_sign(viscous: float, said: str) -> None:
    after = with_values("direction", direction_coulomb=0.2, direction_viscous=viscous)
    assert said in where("direction", after, after)
