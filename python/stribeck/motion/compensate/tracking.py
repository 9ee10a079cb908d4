"""Tracking of a trajectory without and with friction compensation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import polars as pl
from numpy.typing import ArrayLike

from stribeck.base.arguments import door
from stribeck.base.errors import SpecError
from stribeck.base.shown import Plotted
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import WITH_MODEL, ModelFile
from stribeck.motion.compensate.controller import HInfinity
from stribeck.motion.compensate.loop import Array, Bench, ClosedLoopMotion, Compensator
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Trajectory


@dataclass(frozen=True, repr=False)
class Tracking(Plotted):
    """The same trajectory, tracked with several compensations.

    Attributes
    ----------
    friction
        True friction of the joint.
    joint, controller, step
        The joint, its feedback controller, and the time step, s.
    motions
        The first is without compensation.
    desired_position
        rad or m, array [steps].
    observer
        Bandwidth of the friction observer, Hz; None: none.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.simulate.trajectory import Quintic
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> half, whole = sb.Compensator(friction, factor=0.5), sb.Compensator(friction)
    >>> joint, motion = sb.Joint.revolute(0.1), Quintic(0.0, 1.0, move=0.5)
    >>> tracked = sb.compensate(friction, joint, motion, [half, whole])
    >>> [round(tracked.reduction(one), 1) for one in tracked.motions]
    [0.0, 0.5, 0.9]
    """

    friction: Model
    joint: Joint
    controller: HInfinity
    step: float
    motions: tuple[ClosedLoopMotion, ...]
    desired_position: Array
    observer: float | None

    def reduction(self, motion: ClosedLoopMotion) -> float:
        """Return the relative reduction of the RMSE compared with no compensation."""
        without = self.motions[0].rmse
        return 1.0 - motion.rmse / without if without > 0.0 else 0.0

    def to_dict(self) -> dict[str, object]:
        """Return the comparison as JSON."""
        return {
            "friction": self.friction.spec,
            "inertia": self.joint.inertia,
            "seconds": self.desired_position.size * self.step,
            "step": self.step,
            "observer_hz": self.observer,
            "motions": self._rows(),
        }

    def to_frame(self) -> pl.DataFrame:
        """Return a table with one row for each motion."""
        return pl.DataFrame(self._rows())

    def _rows(self) -> list[dict[str, object]]:
        return [
            {
                "compensation": motion.name,
                "factor": 0.0 if motion.compensator is None else motion.compensator.factor,
                "feedback": motion.compensator is not None and motion.compensator.feedback,
                "rmse": motion.rmse,
                "largest_error": motion.largest_error,
                "rmse_reduction": self.reduction(motion),
            }
            for motion in self.motions
        ]


@door(friction=WITH_MODEL, joint=("a Joint, or None", (Joint, type(None))))
def compensate(
    friction: Model | ModelFile | Fit,
    joint: Joint | None,
    trajectory: Trajectory,
    compensators: Sequence[Compensator],
    *,
    controller: HInfinity | None = None,
    seconds: float | None = None,
    step: float = 1e-3,
    temperature: ArrayLike | None = None,
    observer: float | None = None,
    encoder: float = 0.0,
) -> Tracking:
    """Track a trajectory without compensation, then with each compensator.

    Parameters
    ----------
    friction : Model, ModelFile or Fit
        True friction of the joint.
    joint : Joint, optional
        The joint; None: with the inertia and gravity identified together with the friction.
    trajectory : Trajectory
    compensators : sequence of Compensator
    controller : HInfinity, optional
        The same for all motions; default: three poles at 5 Hz.
    seconds : float, optional
        Duration; default: that of the trajectory.
    step : float
        Time step, s; also the sampling time of the controller.
    temperature : float or array [steps], optional
        degC; default: the middle of the operating box of the friction.
    observer : float, optional
        Bandwidth, Hz, of an observer. Its estimate of the remaining friction is compensated too.
    encoder : float
        Resolution, rad or m. Velocity is the difference of positions; 0 measures both exactly.

    Raises
    ------
    SpecError
        An argument is missing or invalid.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.simulate.trajectory import Quintic
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> joint, motion = sb.Joint.revolute(0.1), Quintic(0.0, 1.0, move=0.5)
    >>> without, known = sb.compensate(friction, joint, motion, [sb.Compensator(friction)]).motions
    >>> known.rmse < 0.2 * without.rmse
    True
    """
    bench = Bench.of(friction, joint, trajectory, seconds, step, temperature, encoder, compensators)
    inertia = bench.acting.joint.inertia
    gains = HInfinity.with_bandwidth(inertia) if controller is None else controller
    if observer is not None and not (math.isfinite(observer) and observer > 0.0):
        raise SpecError(f"the observer's bandwidth is {observer:g} Hz: give one above 0")
    bandwidth = None if observer is None else math.tau * observer
    pid = gains.on(inertia)
    return Tracking(
        friction=bench.acting.friction,
        joint=bench.acting.joint,
        controller=gains,
        step=step,
        motions=tuple(bench.run(pid, c, bandwidth=bandwidth) for c in (None, *compensators)),
        desired_position=bench.desired[0],
        observer=observer,
    )
