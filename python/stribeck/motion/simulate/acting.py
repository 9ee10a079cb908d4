"""Split a model into friction, the rigid body of the joint, and effects of the measurement."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stribeck.base.errors import SpecError
from stribeck.effect.describe import is_drive_train
from stribeck.effect.registry import of_catalog
from stribeck.models.channels import RIGID_BODY_EFFECTS
from stribeck.models.model import Model
from stribeck.motion.simulate.joint import Joint


@dataclass(frozen=True)
class Acting:
    """The parts of a model in a simulation.

    Attributes
    ----------
    friction
        The parts that act as torque: friction, and offsets, ripple or springs of the model.
    joint
        The joint, with the inertia and gravity of the model if it has them.
    left_out
        Effects of the measurement.
    """

    friction: Model
    joint: Joint
    left_out: tuple[str, ...]


def take_apart(model: Model, joint: Joint | None) -> Acting:
    """Return the friction of a model and the joint on which it acts.

    If no joint is given, it has the rigid-body terms identified with the friction. The effects
    ``inertia`` and ``gravity`` correct a given joint.

    Raises
    ------
    SpecError
        There is no inertia, or the model has a drive-train effect that cannot be simulated.
    """
    plain = model.friction
    friction, left_out = friction_of(model)
    if joint is not None and joint.kind == "revolute" and plain.position_unit == "m":
        raise SpecError(f"{plain.spec} is in N and m: give the mass of a prismatic joint")
    known = dict(zip(plain.names, plain.values, strict=True))
    return Acting(friction, _joint(plain, joint, known), left_out)


def friction_of(model: Model) -> tuple[Model, tuple[str, ...]]:
    """Return the part of a model that acts as friction, and the effects that are ignored.

    Raises
    ------
    SpecError
        Values are missing, or the model has a drive-train effect that cannot be simulated.
    """
    model.known_values()
    plain = model.friction
    trains = [e for e in plain.effects if is_drive_train(e)]
    if trains:
        raise SpecError(
            f"{plain.spec} has {trains[0]}, which describes recordings and cannot be simulated: "
            f"use a model without it"
        )
    taken = (*plain.rigid_body, *(e for e in plain.effects if e in RIGID_BODY_EFFECTS))
    left_out = tuple(e for e in plain.effects if of_catalog(e).in_motion == "measurement")
    if not (taken or left_out):
        return plain, ()
    known = dict(zip(plain.names, plain.values, strict=True))
    friction = replace(
        plain,
        effects=tuple(e for e in plain.effects if e not in (*taken, *left_out)),
        rigid_body=(),
        values=np.empty(0),
    )
    return friction.with_values([known.get(name, 0.0) for name in friction.names]), left_out


def _joint(model: Model, joint: Joint | None, known: dict[str, float]) -> Joint:
    """Return the joint with the rigid-body terms of the model."""
    terms = model.effects if joint is not None else (*model.effects, *model.rigid_body)
    inertia = known["inertia"] if "inertia" in terms else 0.0
    cos, sin = (known["gravity_cos"], known["gravity_sin"]) if "gravity" in terms else (0.0, 0.0)
    if joint is None:
        if "inertia" not in terms:
            raise SpecError(
                f"{model.spec} has no inertia to move: give that of the joint, or its mass"
            )
        kind = "revolute" if model.position_unit == "rad" else "prismatic"
        return Joint(inertia, gravity_cos=cos, gravity_sin=sin, kind=kind)
    if not any(effect in terms for effect in RIGID_BODY_EFFECTS):
        return joint
    return replace(
        joint,
        inertia=joint.inertia + inertia,
        gravity_cos=joint.gravity_cos + cos,
        gravity_sin=joint.gravity_sin + sin,
    )
