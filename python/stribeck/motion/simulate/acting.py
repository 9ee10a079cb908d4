"""What of a model acts on a joint as torque, and what of it is the joint or the measurement."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stribeck.base.errors import SpecError
from stribeck.effect.registry import of_catalog
from stribeck.models.model import RIGID_BODY_EFFECTS, Model
from stribeck.motion.simulate.joint import Joint


@dataclass(frozen=True)
class Acting:
    """The parts of a model in a simulation.

    Attributes
    ----------
    friction
        What acts as torque: friction, and offsets, ripple or springs where the model has them.
    joint
        With the model's inertia and gravity, where it has them.
    left_out
        Effects of the measurement.
    """

    friction: Model
    joint: Joint
    left_out: tuple[str, ...]


def take_apart(model: Model, joint: Joint | None) -> Acting:
    """Return the friction of a model and the joint on which it acts.

    Rigid-body terms that were identified with the friction are the joint's where none is given;
    the effects ``inertia`` and ``gravity`` correct the one that is.

    Raises
    ------
    SpecError
        There is no inertia, or the model holds a drive train that only explains recordings.
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
        Values are missing, or the model holds a drive train that only explains recordings.
    """
    model.known_values()
    plain = model.friction
    trains = [e for e in plain.effects if of_catalog(e).in_motion == "drive train"]
    if trains:
        raise SpecError(
            f"{plain.spec} has {trains[0]}, which explains a recording and moves nothing: "
            f"simulate a model without it"
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
    """The joint with what the model says of its rigid body."""
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
