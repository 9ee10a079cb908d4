"""A robot to export: its rigid bodies, and the friction of every joint as a program."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from stribeck.base.errors import SpecError, joint_called
from stribeck.base.version import __version__
from stribeck.exporters.precision import Precision
from stribeck.exporters.program import Program
from stribeck.models.catalog import law_row
from stribeck.models.model import Model
from stribeck.robot.arm import Robot

#: Channels that the exported program has from the motion and from the rigid bodies.
OF_MOTION = ("position", "velocity", "acceleration", "load_torque")


@dataclass(frozen=True)
class Joints:
    """The joints of a robot with their friction.

    Attributes
    ----------
    robot
        With the inertial parameters of every link.
    friction
        Of each joint, without a delay.
    programs
        A step of the friction of each joint.
    """

    robot: Robot
    friction: tuple[Model, ...]
    programs: tuple[Program, ...]
    precision: Precision

    @classmethod
    def of(cls, robot: Robot, friction: Mapping[str, Model], precision: Precision) -> Joints:
        """Of a robot and the friction by joint.

        Raises
        ------
        SpecError
            Inertial parameters or friction of a joint are not known.
        """
        if not robot.has_inertia:
            raise SpecError(f"{robot.name}: the inertial parameters of its links are not known")
        missing = [name for name in robot.names if name not in friction]
        if missing:
            raise SpecError(
                f"{robot.name}: the friction of {joint_called(missing[0])} is not known"
            )
        models = tuple(friction[name].friction.without_effect("delay") for name in robot.names)
        for model in models:
            model.known_values()
        programs = tuple(
            Program.of(model, "single" if precision == "f32" else "double") for model in models
        )
        return cls(robot, models, programs, precision)

    @property
    def count(self) -> int:
        """Number of joints."""
        return len(self.friction)

    @property
    def specs(self) -> tuple[tuple[str, str], ...]:
        """Name and model of each joint."""
        return tuple((n, m.spec) for n, m in zip(self.robot.names, self.friction, strict=True))

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """The channels that laws read, in order of their first use."""
        return tuple(dict.fromkeys(c for program in self.programs for c in program.channels))

    @property
    def given(self) -> tuple[str, ...]:
        """The channels that a caller gives in addition to the motion."""
        return tuple(channel for channel in self.channels if channel not in OF_MOTION)

    def about(self) -> Iterator[str]:
        """Lines of a comment."""
        yield (
            f"Torques of the {self.count} joints of {self.robot.name}: gravity, inertia and "
            f"friction. Written by stribeck {__version__}."
        )
        if self.robot.coupling:
            yield ""
            yield (
                "The planned motion is that of the joints; torques and friction are those of the "
                "motors, which turn with several joints."
            )
        yield ""
        yield "Rigid bodies: recursive Newton-Euler (Featherstone 2008, section 5.3)."
        if self.robot.source:
            yield f"Robot: {self.robot.source}"
        for k, (joint, model) in enumerate(zip(self.robot.joints, self.friction, strict=True)):
            row = law_row(model.law)
            law = str(row["formula"]) if row else model.own[0].text
            yield f"Joint {k + 1}, {joint.name} [{joint.torque_unit}]: {model.spec}: {law}"
