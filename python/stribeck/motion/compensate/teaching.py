"""Direct teaching (Tadese et al. 2021, eq 26): a hand guides a joint, friction is cancelled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from stribeck.base.errors import SpecError
from stribeck.base.shown import Shown
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.motion.compensate.loop import Array, Bench, ClosedLoopMotion, Compensator
from stribeck.motion.simulate.drive import Controller
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Trajectory


@dataclass(frozen=True)
class Guidance:
    """A hand that guides the joint along a trajectory, modelled as a spring and a damper.

    Attributes
    ----------
    trajectory
        What the hand wants.
    stiffness, damping
        N m/rad, N m s/rad, or N for N m and m for rad.
    """

    trajectory: Trajectory
    stiffness: float
    damping: float

    @classmethod
    def with_bandwidth(cls, trajectory: Trajectory, inertia: float, hertz: float = 2.0) -> Guidance:
        """A hand that places both poles of this inertia (kg m2 or kg) there."""
        if not (math.isfinite(hertz) and hertz > 0.0):
            raise SpecError(f"the hand's bandwidth is {hertz:g} Hz: give one above 0")
        pole = math.tau * hertz
        return cls(trajectory, inertia * pole**2, 2.0 * inertia * pole)


@dataclass(frozen=True, repr=False)
class Teaching(Shown):
    """The same guidance with several compensators.

    Attributes
    ----------
    friction
        What really resists.
    step
        s.
    motions
        Their `controller_torque` is the hand's.
    """

    friction: Model
    joint: Joint
    step: float
    motions: tuple[ClosedLoopMotion, ...]

    def interaction(self, motion: ClosedLoopMotion) -> tuple[float, float]:
        """RMS and largest size of the hand's torque, N m or N."""
        hand: Array = motion.controller_torque
        return float(np.sqrt(np.mean(hand**2))), float(np.abs(hand).max())

    def overcompensated(self, motion: ClosedLoopMotion) -> float:
        """Return the share of the time in motion in which compensation exceeds friction.

        It pushes along the motion; a bristle that springs back pushes by itself and holds nothing.
        """
        way = np.diff(motion.position)
        moving = way != 0.0
        if not moving.any():
            return 0.0
        pushed, held = motion.compensation * np.sign(way), motion.friction_torque * np.sign(way)
        return float(np.mean((pushed > np.maximum(held, 0.0))[moving]))

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        rows = []
        for motion in self.motions:
            rms, largest = self.interaction(motion)
            rows.append(
                {
                    "compensation": motion.name,
                    "factor": 0.0 if motion.compensator is None else motion.compensator.factor,
                    "interaction_rms": rms,
                    "interaction_largest": largest,
                    "overcompensated": self.overcompensated(motion),
                }
            )
        return {"friction": self.friction.spec, "inertia": self.joint.inertia, "motions": rows}


def teach(
    friction: Model | ModelFile | Fit,
    joint: Joint | None,
    guidance: Guidance,
    compensators: Sequence[Compensator],
    *,
    seconds: float | None = None,
    step: float = 1e-3,
    temperature: ArrayLike | None = None,
    encoder: float = 0.0,
) -> Teaching:
    """Guide a joint by hand: its motor gives ``g + alpha tf``, first with ``alpha`` 0.

    Parameters
    ----------
    friction : Model, ModelFile or Fit
        What really resists.
    joint : Joint, optional
        None: the inertia and gravity identified with the friction.
    guidance : Guidance
    compensators : sequence of Compensator
        By feedback: nobody tells the motor where the hand is going.
    seconds : float, optional
        Default: as long as the trajectory.
    step : float
        s.
    temperature : float or array [steps], optional
        degC; the default is the middle of the friction's operating box.
    encoder : float
        Resolution of the encoder, rad or m: position in these steps and velocity by their
        differences are all that is measured; 0 measures both exactly.

    Raises
    ------
    SpecError
        Something is missing, or cannot be; a compensator is a feedforward.
    """
    for compensator in compensators:
        if not compensator.feedback:
            raise SpecError(
                f"{compensator.label} compensates the desired motion, which is unknown in direct "
                f"teaching: use feedback"
            )
    bench = Bench.of(
        friction,
        joint,
        guidance.trajectory,
        seconds,
        step,
        temperature,
        encoder,
    )
    hand = Controller(guidance.stiffness, guidance.damping)
    return Teaching(
        friction=bench.acting.friction,
        joint=bench.acting.joint,
        step=step,
        motions=tuple(bench.run(hand, c, guided=True) for c in (None, *compensators)),
    )
