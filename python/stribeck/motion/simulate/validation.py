"""Comparison of simulated and measured motion (Gantry, section 4)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import ArrayLike, NDArray

from stribeck.base import linear
from stribeck.base.errors import SpecError
from stribeck.base.shown import Plotted
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.motion.simulate.acting import take_apart
from stribeck.motion.simulate.drive import Controller, Follow, Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.run import simulate
from stribeck.motion.simulate.trajectory import Sampled
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Prediction horizons at which positions are compared, s.
HORIZONS = (0.1, 0.3, 1.0, 3.0, 10.0)
#: Number of starts for each horizon.
STARTS = 100
#: Smallest number of starts for which an error is stated.
FEWEST_STARTS = 5
#: Largest relative difference between time steps that are treated as equal.
EVEN = 0.05


@dataclass(frozen=True)
class Growth:
    """Error of a simulation at one prediction horizon.

    Attributes
    ----------
    seconds
        Time after the start, s.
    error, way
        RMS of the position error and of the displacement since the start, rad or m, over `starts`
        starts spread over the recording.
    """

    seconds: float
    error: float
    way: float
    starts: int


@dataclass(frozen=True, repr=False)
class Validation(Plotted):
    """A simulated motion compared with the measured one.

    Attributes
    ----------
    closed_loop
        Whether the joint was driven by a controller on the desired position; otherwise by the
        measured torque.
    time, measured, simulated
        Times in s and positions in rad or m of the simulated samples, arrays [n].
    torque, measured_torque
        Motor torques, N m or N, arrays [n].
    growth
        Growth of the error with time, in open loop.
    """

    model: Model
    joint: Joint
    closed_loop: bool
    time: Array
    measured: Array
    simulated: Array
    torque: Array
    measured_torque: Array
    growth: tuple[Growth, ...]

    @property
    def error(self) -> float:
        """RMS of simulated minus measured position, rad or m."""
        return float(np.sqrt(np.mean((self.simulated - self.measured) ** 2)))

    @property
    def relative_error(self) -> float:
        """Norm of the error over the norm of the measured position about its mean."""
        return _relative(self.simulated, self.measured)

    @property
    def relative_torque_error(self) -> float:
        """The relative error of the motor torque; 0 if the measured torque drives the joint."""
        return _relative(self.torque, self.measured_torque)

    def to_frame(self) -> pl.DataFrame:
        """Both motions as a table, one row per sample."""
        return pl.DataFrame(
            {
                "time": self.time,
                "position": self.measured,
                "simulated_position": self.simulated,
                "torque": self.measured_torque,
                "simulated_torque": self.torque,
            }
        )

    def to_dict(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "model": self.model.spec,
            "closed_loop": self.closed_loop,
            "inertia": self.joint.inertia,
            "rows": self.time.size,
            "position_rmse": self.error,
            "position_largest_error": float(np.abs(self.simulated - self.measured).max()),
            "position_relative_error": self.relative_error,
            "torque_relative_error": self.relative_torque_error,
            "growth": [
                {"seconds": g.seconds, "rmse": g.error, "way": g.way, "starts": g.starts}
                for g in self.growth
            ],
        }


def validate(
    model: Model | ModelFile | Fit,
    recording: Recording,
    joint: Joint | None = None,
    *,
    horizons: Sequence[float] = HORIZONS,
) -> Validation:
    """Simulate the model with the measured torque, and compare the motion.

    Every run starts at the measured state and is not corrected afterwards, so errors of the torque
    are integrated twice. For `growth`, simulations are started throughout the recording and
    compared at the prediction horizons.

    Parameters
    ----------
    model : Model, ModelFile or Fit
    recording : Recording
        Recording with motor torque and position. A recorded load torque acts on the joint, without
        its inertial part.
    joint : Joint, optional
        Default: the inertia and gravity identified with the friction.
    horizons : sequence of float
        Prediction horizons, s; each is rounded to a whole number of samples.

    Raises
    ------
    SpecError
        The inertia, the motor torque or the position is missing.
    """
    bench = _Bench.of(model, recording, joint)
    pieces = [bench.run(rows) for rows in bench.stretches]
    rows = np.concatenate(bench.stretches)
    return Validation(
        model=bench.model,
        joint=bench.joint,
        closed_loop=False,
        time=recording.time[rows],
        measured=bench.position[rows],
        simulated=np.concatenate(pieces),
        torque=recording.torque[rows],
        measured_torque=recording.torque[rows],
        growth=tuple(bench.growth(horizons)),
    )


def validate_closed_loop(
    model: Model | ModelFile | Fit,
    recording: Recording,
    desired_position: ArrayLike,
    controller: Controller,
    joint: Joint | None = None,
) -> Validation:
    """Simulate the model with the controller of the recording; compare position and torque.

    Parameters
    ----------
    desired_position : array [rows]
        Input of the controller, rad or m.
    controller : Controller
        Controller with one sample per row.

    Raises
    ------
    SpecError
        As in `validate`, or the recording has several runs or uneven time steps.
    """
    bench = _Bench.of(model, recording, joint)
    if len(bench.stretches) != 1:
        raise SpecError("a closed loop is simulated over one run without gaps: select one")
    rows = bench.stretches[0]
    desired = np.asarray(desired_position, dtype=np.float64)
    if desired.shape != bench.position.shape:
        raise SpecError(
            f"desired_position has {desired.size} values for {bench.position.size} rows: "
            f"give one per row"
        )
    step = _even_step(recording, rows)
    moved = simulate(
        bench.model,
        bench.joint_given,
        Follow(Sampled(desired[rows], step), controller),
        seconds=(rows.size - 1) * step,
        step=step,
        **bench.begin(rows),
    )
    return Validation(
        model=bench.model,
        joint=bench.joint,
        closed_loop=True,
        time=recording.time[rows[:-1]],
        measured=bench.position[rows[:-1]],
        simulated=moved.instant_position[:-1],
        torque=moved.torque,
        measured_torque=recording.torque[rows[:-1]],
        growth=(),
    )


@dataclass(frozen=True)
class _Bench:
    """A recording to compare simulations with."""

    model: Model
    joint: Joint
    joint_given: Joint | None
    recording: Recording
    position: Array
    external: Array
    stretches: list[NDArray[np.intp]]

    @classmethod
    def of(
        cls, model: Model | ModelFile | Fit, recording: Recording, joint: Joint | None
    ) -> _Bench:
        asked = model if isinstance(model, Model) else model.model
        acting = take_apart(asked, joint)
        if recording.position is None:
            raise SpecError(f"{recording.path} has no position to compare with")
        if recording.drive is not None or "friction_torque" in recording.columns:
            raise SpecError(f"{recording.path} has no motor torque to drive a joint with")
        external = np.zeros(recording.position.size)
        if recording.load_torque is not None:
            external = acting.joint.inertia * recording.acceleration - recording.load_torque
        stretches = [np.flatnonzero(recording.segment == k) for k in np.unique(recording.segment)]
        stretches = [rows for rows in stretches if rows.size > 1]
        return cls(asked, acting.joint, joint, recording, recording.position, external, stretches)

    def begin(self, rows: NDArray[np.intp]) -> dict[str, Any]:
        """Return the measured state at the first sample, and the external torque."""
        temperature = None
        if "temperature" in self.model.core.needs:
            temperature = self.recording.temperature
        return {
            "position": float(self.position[rows[0]]),
            "velocity": float(self.recording.velocity[rows[0]]),
            "temperature": None if temperature is None else temperature[rows[:-1]],
            "external_torque": self.external[rows[:-1]],
        }

    def run(self, rows: NDArray[np.intp]) -> Array:
        """Return the position at the samples, driven by the measured torque."""
        moved = simulate(
            self.model,
            self.joint_given,
            Torque(self.recording.torque[rows[:-1]]),
            step=np.diff(self.recording.time[rows]),
            **self.begin(rows),
        )
        return moved.instant_position

    def growth(self, horizons: Sequence[float]) -> Iterator[Growth]:
        """Yield the error at each horizon, a whole number of samples, that the recording has."""
        steps = np.concatenate([np.diff(self.recording.time[rows]) for rows in self.stretches])
        step = float(np.median(steps))
        for ahead in dict.fromkeys(round(seconds / step) for seconds in horizons):
            ends = [rows[:-ahead] for rows in self.stretches if ahead and rows.size > ahead]
            if not ends:
                continue
            starts = np.concatenate(ends)
            starts = starts[np.unique(np.linspace(0, starts.size - 1, STARTS).astype(np.intp))]
            if starts.size < FEWEST_STARTS:
                continue
            simulated = [self.run(np.arange(k, k + ahead + 1))[-1] for k in starts]
            reached = self.position[starts + ahead]
            yield Growth(
                # Four digits of a measured step are those of the nominal step.
                seconds=float(f"{ahead * step:.4g}"),
                error=float(np.sqrt(np.mean((np.array(simulated) - reached) ** 2))),
                way=float(np.sqrt(np.mean((reached - self.position[starts]) ** 2))),
                starts=starts.size,
            )


def _even_step(recording: Recording, rows: NDArray[np.intp]) -> float:
    """Return the time step of the recording, s."""
    steps = np.diff(recording.time[rows])
    step = float(np.median(steps))
    if np.any(np.abs(steps - step) > EVEN * step):
        raise SpecError(
            f"{recording.path}: time steps go from {steps.min():g} to {steps.max():g} s, and a "
            f"controller samples evenly: resample it"
        )
    return step


def _relative(values: Array, true: Array) -> float:
    """The error as a share of what varies in `true`; NaN where nothing does."""
    varies = linear.length(true - true.mean())
    return linear.length(values - true) / varies if varies > 0.0 else math.nan
