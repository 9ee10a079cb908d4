"""The error of a model on a recording that it was not fitted to."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.fitting.evaluate import evaluated_on


def test_another_kind_of_joint_is_refused() -> None:
    t = np.arange(3000) / 100.0
    torque = np.sign(np.cos(t)) + np.random.default_rng(0).normal(0.0, 0.05, t.size)
    linear, turning = (
        sb.read(
            pl.DataFrame({"time": t, f"q_{unit}": np.sin(t), f"v_{unit}ps": np.cos(t), tau: torque})
        )
        for unit, tau in (("m", "force_N"), ("rad", "torque_Nm"))
    )
    fitted = sb.fit("coulomb", linear, starts=1)
    with pytest.raises(sb.FitError, match="it is a model of another kind of joint"):
        evaluated_on(fitted, [turning])
    for call in (sb.evaluate, lambda model, recording: sb.compare([fitted], recording)):
        with pytest.raises(sb.FitError, match="another kind of joint; give one in N m and rad"):
            call(fitted.model, turning)
    with pytest.raises(sb.FitError, match="another kind of joint; give one in N and m"):
        sb.evaluate(sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5), linear)
    with pytest.raises(sb.FitError, match="another kind of joint"):
        fitted.predict(turning)


def test_a_model_with_given_values_is_not_said_to_be_fitted() -> None:
    t = np.arange(3000) / 100.0
    r = sb.Recording.from_columns(time=t, velocity=np.cos(t), torque=np.sign(np.cos(t)))
    known = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    text = repr(sb.evaluate(known, r))
    assert "held-out error" in text and "the model is taken as it is, nothing is fitted" in text
    assert "by a model fitted without it" not in text
    assert "by a model fitted without it" in repr(sb.fit("coulomb", r, starts=1))


def test_friction_alone_where_no_load_torque_was_recorded_is_said() -> None:
    t = np.arange(3000) / 100.0
    r = sb.Recording.from_columns(
        time=t, position=np.sin(t), velocity=np.cos(t), torque=np.sign(np.cos(t))
    )
    known = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    (note,) = sb.evaluate(known, r).notes
    assert "stored without inertia and gravity, and no load torque is recorded" in note
    assert sb.evaluate(sb.fit("coulomb", r, starts=1).model, r).notes == ()


def test_a_torque_without_a_square_is_refused() -> None:
    t = np.arange(3000) / 100.0
    r = sb.Recording.from_columns(time=t, velocity=np.cos(t), torque=np.sign(np.cos(t)))
    huge = sb.model("coulomb", coulomb_friction=1e308, viscous_friction=0.5)
    with pytest.raises(sb.FitError, match="predicts a torque beyond 1e\\+100"):
        sb.evaluate(huge, r)
