"""Is a model passive? Proved over a box by interval bounds with subdivision, never by samples."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Protocol

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.models.model import Model
from stribeck.passivity.certificate import Certificate, Counterexample, Margin
from stribeck.passivity.friction import friction_part
from stribeck.passivity.operating_box import Box, operating_box

#: Evaluations of the model over a box after which a check gives up: some seconds.
BUDGET = 4_000_000


class HasModel(Protocol):
    """A result that holds a model, such as a fit or a model file."""

    @property
    def model(self) -> Model:
        """The model."""
        ...


def check(model: Model | HasModel, box: Box | None = None) -> Certificate:
    """Certify that a model gives off no energy over an operating box, or break it.

    Every motion inside the box counts: velocity, temperature and load may change at any time in any
    way. The friction alone is meant; an offset, a rigid body or a delay is none.

    Parameters
    ----------
    model : Model, ModelFile or Fit
        With values for all parameters.
    box : dict of (low, high)
        ``velocity``, ``temperature``, ``load_torque``, ``position`` ..., SI units and degC. What it
        leaves out is taken from the model's own box.

    Returns
    -------
    Certificate
        `passive` is True with a proof, False with a counterexample, None if neither was found.

    Raises
    ------
    SpecError
        Values or sides are missing, the box holds a temperature at which the law has no limit, or
        points at which dry friction is not positive and a bristle cannot be.

    Notes
    -----
    Tadese et al. 2021, property 1, is tried first; it is sufficient only. For a single deflection
    the exact condition follows: at every force that is reached, the least work per deflection on
    the way up and on the way down must not sum to less than zero.

    Examples
    --------
    >>> from stribeck.models.build import model
    >>> friction = model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> check(friction, {"velocity": (-3.0, 3.0)}).passive
    True

    A bristle with a hundred times the damping that property 1 allows, ``4 D/|v|`` = 8/3 N m s/rad:
    where dry friction is constant, no damping is too much.

    >>> bristle = {"presliding_stiffness": 1e4, "presliding_damping": 267.0}
    >>> damped = model(
    ...     "coulomb+presliding", coulomb_friction=2.0, viscous_friction=0.5, **bristle
    ... )
    >>> answer = check(damped, {"velocity": (-3.0, 3.0)})
    >>> answer.passive, answer.condition
    (True, 'storage')
    """
    asked = model if isinstance(model, Model) else model.model
    asked.known_values()
    friction, left_out = friction_part(asked)
    sides = operating_box(friction, box or {})
    try:
        answer = _core.passivity(friction.core, friction.values, sides, BUDGET)
    except _core.ModelError as error:
        raise SpecError(f"{friction.spec} cannot be checked: {error}") from None
    example = answer["counterexample"]
    return Certificate(
        model=asked,
        friction=friction,
        left_out=left_out,
        box=sides,
        passive=answer["passive"],
        condition=answer["condition"],
        margins=tuple(_margin(row) for row in answer["margins"]),
        counterexample=None if example is None else Counterexample(
            friction, example["deflection"], tuple(example["steps"]), example["work"]
        ),
    )  # fmt: skip


def _margin(row: Mapping[str, Any]) -> Margin:
    lower, upper = row["lower"], row["upper"]
    return Margin(
        condition=row["condition"],
        lower=lower if math.isfinite(lower) else None,
        upper=upper if upper is not None and math.isfinite(upper) else None,
        at=row["at"],
    )
