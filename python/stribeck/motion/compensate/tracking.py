"""A joint follows a trajectory without friction compensation, and with it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import polars as pl
from numpy.typing import ArrayLike

from stribeck.base.errors import SpecError
from stribeck.base.shown import Plotted
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.motion.compensate.controller import HInfinity
from stribeck.motion.compensate.loop import Array, Bench, ClosedLoopMotion, Compensator
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Trajectory


@dataclass(frozen=True, repr=False)
class Tracking(Plotted):
    """The same trajectory followed several times.

    Attributes
    ----------
    friction
        What really resists.
    joint, controller, step
        What is moved, and by whom: step in s.
    motions
        The first is without compensation.
    desired_position
        rad or m, array [steps].
    observer
        Bandwidth of the friction observer, Hz; None: none.
    """

    friction: Model
    joint: Joint
    controller: HInfinity
    step: float
    motions: tuple[ClosedLoopMotion, ...]
    desired_position: Array
    observer: float | None

    def reduction(self, motion: ClosedLoopMotion) -> float:
        """By which share the RMSE is below that without compensation."""
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
    """Follow a trajectory without compensation, then with each compensator.

    Parameters
    ----------
    friction : Model, ModelFile or Fit
        What really resists.
    joint : Joint, optional
        None: the inertia and gravity identified with the friction.
    trajectory : Trajectory
    compensators : sequence of Compensator
    controller : HInfinity, optional
        The same for all; the default has three poles at 5 Hz.
    seconds : float, optional
        Default: as long as the trajectory.
    step : float
        s; the controller's sampling time too.
    temperature : float or array [steps], optional
        degC; the default is the middle of the friction's operating box.
    observer : float, optional
        Bandwidth, Hz, of an observer whose estimate of the friction that is left is compensated
        too, in all motions.
    encoder : float
        Resolution of the encoder, rad or m: position in these steps and velocity by their
        differences are all that is measured; 0 measures both exactly.

    Raises
    ------
    SpecError
        Something is missing, or cannot be.

    Examples
    --------
    >>> from stribeck.models.build import model
    >>> from stribeck.motion.simulate import Quintic
    >>> friction = model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> ahead = Compensator(friction, feedback=False)
    >>> moved = compensate(friction, Joint.revolute(0.1), Quintic(0.0, 1.0, 2.0), [ahead])
    >>> moved.motions[1].rmse < 0.1 * moved.motions[0].rmse
    True
    """
    bench = Bench.of(
        friction,
        joint,
        trajectory,
        seconds=seconds,
        step=step,
        temperature=temperature,
        encoder=encoder,
    )
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
