"""The part of a model that is friction, which a check of passivity is about."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stribeck.models.catalog import catalog
from stribeck.models.model import Model


def friction_part(model: Model) -> tuple[Model, tuple[str, ...]]:
    """The friction of a model, and the names of the terms that are left out.

    An offset, a load, a delay or a wrong torque constant belong to the measurement, the drive or
    the rigid body. A constant torque that the law itself has stays.

    Returns
    -------
    friction : Model
    left_out : tuple of str
        Effects and identified rigid-body terms.
    """
    groups = {name: row["group"] for name, row in catalog()["effects"].items()}
    plain = model.friction
    others = tuple(effect for effect in plain.effects if groups[effect] != "friction")
    left_out = (*others, *plain.rigid_body)
    known = dict(zip(plain.names, plain.values, strict=True))
    kept = replace(
        plain,
        effects=tuple(effect for effect in plain.effects if effect not in others),
        rigid_body=(),
        values=np.empty(0),
    )
    # With the effect `offset` a law has no offset of its own: it is zero.
    return kept.with_values([known.get(name, 0.0) for name in kept.names]), left_out
