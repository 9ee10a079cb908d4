"""Conditions of a planned motion: the model, noise, load and temperature of a joint.

With a motion they give the recording that would be made, without torque noise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.base.errors import FitError, SpecError, option
from stribeck.diagnosis.visibility.power import ExpectedNoise
from stribeck.fitting.result import Fit
from stribeck.identify.errors.covariance import correlation_length
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.models.rigid_body import own_load
from stribeck.motion.design.motion import Limits, SampledMotion
from stribeck.recording.recording import Column, Recording
from stribeck.recording.rows import held_out_blocks

Array = NDArray[np.float64]

#: Temperature if none is known, degC.
ROOM = 25.0
#: Share of the largest speed below which a joint is treated as at rest, if the noise is unknown.
STANDSTILL = 1e-3
#: Share of a recorded load torque that inertia and gravity of one payload must explain.
EXPLAINED = 0.95


@dataclass(frozen=True)
class Setting:
    """Conditions of a planned recording.

    Attributes
    ----------
    model
        Model with values.
    noise, memory
        RMS of the torque noise, and its correlation time, s.
    load : array [4] or None
        Coefficients of the load torque on ``(a, 1, cos q, sin q)``; None: identified with the
        friction, or unknown.
    temperatures
        The motion is recorded once at each of these temperatures, degC.
    slowest
        Speed below which a sample is treated as at rest.
    """

    model: Model
    noise: float
    memory: float
    load: Array | None
    temperatures: tuple[float, ...]
    slowest: float
    joint_kind: str
    notes: tuple[str, ...] = ()

    def recording(self, motion: SampledMotion, rate: float) -> Recording:
        """Return the noise-free recording of `motion`, one run for each temperature."""
        made = self._moved(motion, rate)
        if not made.moving.any():
            return made
        # Some laws read the sign of the motor torque, which follows from friction without it.
        for _ in range(2 if "motor_torque" in self.model.core.needs else 1):
            made = replace(made, torque=self.problem(made).predict(self.model.values))
        return made

    def _moved(self, motion: SampledMotion, rate: float) -> Recording:
        """Return a recording of `motion` with torque 0."""
        runs = len(self.temperatures)
        n = motion.time.size
        q, v, a = (
            np.tile(column, runs)
            for column in (motion.position, motion.velocity, motion.acceleration)
        )
        run = np.repeat(np.arange(runs), n)
        dt = np.tile(np.diff(motion.time, prepend=motion.time[:1]), runs)
        load, external = None, None
        if self.load is not None:
            load = _regressors(self.joint_kind, q, a) @ self.load
            external = -_regressors(self.joint_kind, q, np.zeros_like(q)) @ self.load
        time = np.tile(motion.time, runs) + run * (motion.time[-1] + 1.0 / rate)
        block, blocks = held_out_blocks(dt, run, run, 1.0 / rate)
        unit, position_unit = self.model.torque_unit, self.model.position_unit
        return Recording(
            path="planned motion",
            sha256="",
            joint=None,
            joint_kind=self.joint_kind,
            torque_unit=unit,
            position_unit=position_unit,
            time=time,
            segment=run,
            run=run,
            run_names=tuple(f"{t:g} degC" for t in self.temperatures),
            dt=dt,
            position=q,
            velocity=v,
            acceleration=a,
            torque=np.zeros_like(q),
            load_torque=load,
            temperature=np.repeat(self.temperatures, n),
            position_smooth=q,
            velocity_smooth=v,
            acceleration_smooth=a,
            load_torque_smooth=load,
            columns={"position": Column("position", "plan", position_unit, False)},
            notes=(),
            velocity_noise=self.slowest / 5.0,
            velocity_threshold=self.slowest,
            moving=np.abs(v) > self.slowest,
            block=block,
            block_count=blocks,
            rate_hz=rate,
            gaps=0,
            rows_dropped=0,
            averaged=False,
            cutoff_hz=None,
            external_torque=external,
        )

    def problem(self, recording: Recording) -> Problem:
        """Return the model on the moving samples of a planned recording."""
        return Problem(
            recording, self.model, np.flatnonzero(recording.moving), own_load(self.model, recording)
        )

    def expected_noise(self, recording: Recording) -> ExpectedNoise:
        """Return the expected noise of the moving samples of a planned recording."""
        memory = max(1.0, self.memory * recording.rate_hz)
        return ExpectedNoise(self.noise, memory, int(recording.moving.sum()))


def setting_of_fit(fitted: Fit) -> Setting:
    """Return the conditions of a recording and of the model fitted to it."""
    r = fitted.recording
    _refuse_drive(fitted.model)
    residual = fitted.residual[fitted.rows]
    if r.averaged or r.rate_hz <= 0:
        raise FitError(
            f"{r.path} holds steady-state points, which do not show the noise of a motion: "
            f"give a recording of a motion, or a model file alone"
        )
    load, notes = _load_of(r)
    temperature = ROOM if r.temperature is None else float(np.mean(r.temperature[r.moving]))
    return Setting(
        fitted.model,
        rms(residual),
        correlation_length(residual) / r.rate_hz,
        load,
        (temperature,),
        r.velocity_threshold,
        r.joint_kind,
        notes,
    )


def setting_of_file(stored: ModelFile, limits: Limits, noise: float | None) -> Setting:
    """Return the conditions that a model file states, without a recording.

    Parameters
    ----------
    noise
        RMS of the torque noise; default: the error with which the model was fitted.
    """
    model, source = stored.model, stored.fitted_on
    _refuse_drive(model)
    level = noise if noise is not None else source.get("rmse")
    if level is None or not level > 0:
        raise SpecError(
            f"the size of the torque noise is unknown: give {option('noise')}, or a recording"
        )
    memory = 0.0
    if "time_span" in source and source.get("rows"):
        memory = float(np.diff(source["time_span"])[0]) / float(source["rows"])
    temperature = 0.5 * sum(model.box["temperature"]) if "temperature" in model.box else ROOM
    kind = "revolute" if model.position_unit == "rad" else "prismatic"
    return Setting(
        model, float(level), memory, None, (temperature,), STANDSTILL * limits.speed, kind
    )


def _refuse_drive(model: Model) -> None:
    if model.drive is not None:
        raise SpecError(
            f"{model.spec} predicts the {model.drive} on a motor, which a motion does not "
            f"determine: plan with a model of the torque"
        )


def _regressors(joint_kind: str, position: Array, acceleration: Array) -> Array:
    """Return the regressors of inertia and gravity for a load torque, array [n, 4]."""
    one = np.ones_like(position)
    turn = 1.0 if joint_kind == "revolute" else 0.0
    return np.column_stack([acceleration, one, turn * np.cos(position), turn * np.sin(position)])


def _load_of(r: Recording) -> tuple[Array | None, tuple[str, ...]]:
    """Return the coefficients of a recorded load torque on `_regressors`, and notes."""
    if r.load_torque is None:
        return None, ()
    if r.position is None:
        raise FitError(f"{r.path} has no position, so the load of a new motion is unknown")
    columns = _regressors(r.joint_kind, r.position, r.acceleration)
    shares = linear.least_norm(columns, r.load_torque, 1e-9)
    left = rms(r.load_torque - columns @ shares)
    explained = 1.0 - (left / (rms(r.load_torque) or 1.0)) ** 2
    if explained >= EXPLAINED:
        return shares, ()
    note = (
        f"inertia and gravity of one payload explain {100.0 * explained:.0f} % of the recorded "
        f"load torque; the plan uses these alone"
    )
    return shares, (note,)
