"""Direct teaching (Tadese et al. 2021, eq 26): a hand guides a joint, friction is cancelled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from stribeck.base.arguments import door
from stribeck.base.errors import SpecError
from stribeck.base.shown import Shown
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import WITH_MODEL, ModelFile
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
        The motion that the hand intends.
    stiffness, damping
        N m/rad, N m s/rad, or N for N m and m for rad.
    """

    trajectory: Trajectory
    stiffness: float
    damping: float

    @classmethod
    def with_bandwidth(cls, trajectory: Trajectory, inertia: float, hertz: float = 2.0) -> Guidance:
        """Return a hand that places both poles of an inertia (kg m2 or kg) at a frequency."""
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
        True friction of the joint.
    step
        Time step, s.
    motions
        Motions, whose `controller_torque` is the torque of the hand.
    """

    friction: Model
    joint: Joint
    step: float
    motions: tuple[ClosedLoopMotion, ...]

    def interaction(self, motion: ClosedLoopMotion) -> tuple[float, float]:
        """RMS and largest magnitude of the torque of the hand, N m or N."""
        hand: Array = motion.controller_torque
        return float(np.sqrt(np.mean(hand**2))), float(np.abs(hand).max())

    def overcompensated(self, motion: ClosedLoopMotion) -> float:
        """Return the share of the time in motion in which compensation exceeds friction.

        Compensation then drives the motion. A bristle that springs back opposes no motion: its
        friction is taken as 0.
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


@door(friction=WITH_MODEL)
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
    """Guide a joint by hand; its motor applies ``g + alpha tf``, in the first motion with alpha 0.

    Parameters
    ----------
    friction : Model, ModelFile or Fit
        True friction of the joint.
    joint : Joint, optional
        The joint; None: with the inertia and gravity identified together with the friction.
    guidance : Guidance
    compensators : sequence of Compensator
        Compensators with feedback: the motor does not know the desired motion.
    seconds : float, optional
        Duration; default: that of the trajectory.
    step : float
        Time step, s.
    temperature : float or array [steps], optional
        degC; default: the middle of the operating box of the friction.
    encoder : float
        Resolution, rad or m. Velocity is the difference of positions; 0 measures both exactly.

    Raises
    ------
    SpecError
        An argument is missing or invalid, or a compensator uses feedforward.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.compensate.teaching import Guidance
    >>> from stribeck.motion.simulate.trajectory import Quintic
    >>> friction = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> hand = Guidance.with_bandwidth(Quintic(0.0, 1.0, move=0.5), inertia=0.1)
    >>> taught = sb.teach(friction, sb.Joint.revolute(0.1), hand, [sb.Compensator(friction, 0.8)])
    >>> [round(taught.interaction(motion)[0], 1) for motion in taught.motions]
    [2.4, 1.4]
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
        compensators,
    )
    hand = Controller(guidance.stiffness, guidance.damping)
    return Teaching(
        friction=bench.acting.friction,
        joint=bench.acting.joint,
        step=step,
        motions=tuple(bench.run(hand, c, guided=True) for c in (None, *compensators)),
    )
