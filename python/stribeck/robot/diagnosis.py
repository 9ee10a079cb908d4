"""What every joint of a robot lacks, before anything is added."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from stribeck.base.shown import Shown
from stribeck.diagnosis.result import Diagnosis
from stribeck.robot.causes import Found
from stribeck.robot.improve import RobotImprovement
from stribeck.robot.result import RobotFit


@dataclass(frozen=True, repr=False)
class RobotDiagnosis(Shown):
    """The effects that each joint lacks under the load of the identified rigid bodies.

    Attributes
    ----------
    joints
        The diagnosis of each joint, by name.
    rigid_body
        Causes in the rigid bodies.

    Examples
    --------
    >>> import numpy as np
    >>> from stribeck import model, read, robot
    >>> arm = robot.from_tables("arm", [{}], gravity=(0.0, -9.81, 0.0))
    >>> arm = arm.with_bodies(np.array([[3.0, 0.6, 0, 0, 0, 0, 0.2, 0, 0, 0.2, 0.1]]))
    >>> law = {"stribeck_height": 1.0, "stribeck_velocity": 0.2, "stribeck_exponent": 1.0}
    >>> law = model("coulomb+stribeck", coulomb_friction=2.0, viscous_friction=1.0, **law)
    >>> run = robot.simulate_robot(arm, {"1": law}, seconds=10.0, rate=50.0, noise=0.01)
    >>> motion = robot.RobotMotion.of(arm, [read(run)])
    >>> searched = robot.improve_robot(motion, "coulomb", starts=1, most_steps=0)
    >>> found = robot.RobotDiagnosis.of(searched).joints["1"]
    >>> found.verdict, found.findings[0].effect
    ('missing', 'stribeck')
    """

    fit: RobotFit
    joints: Mapping[str, Diagnosis]
    rigid_body: tuple[Found, ...]

    @classmethod
    def of(cls, found: RobotImprovement) -> RobotDiagnosis:
        """The diagnoses of a search that added nothing."""
        return cls(found.final, found.last, found.rigid_body)

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck robot diagnose`."""
        return {
            "joints": [{"joint": name, **one.to_dict()} for name, one in self.joints.items()],
            "rigid_body": [found.to_dict() for found in self.rigid_body],
            "payload": None if self.fit.payload is None else self.fit.payload.to_dict(),
        }
