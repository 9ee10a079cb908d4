"""Is a model passive? Proved over a box by interval bounds and subdivision, not by sampling."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

from stribeck import _core
from stribeck.base.arguments import door
from stribeck.base.errors import SpecError
from stribeck.models.fitted import HasModel
from stribeck.models.model import Model
from stribeck.models.model_file import WITH_MODEL
from stribeck.passivity.certificate import Certificate, Counterexample, Margin
from stribeck.passivity.friction import friction_part
from stribeck.passivity.operating_box import Box, operating_box, refuse_unread_sides

if TYPE_CHECKING:
    from stribeck.passivity.rows import AnswerRow, MarginRow

#: A check stops undecided after so many evaluations of the model, which take some seconds.
BUDGET = 4_000_000
#: Answers that are kept: a model is printed, reported and exported with the same proof.
KEPT = 64


@door(model=WITH_MODEL)
def check(model: Model | HasModel, box: Box | None = None) -> Certificate:
    """Prove that a model generates no energy over an operating box, or find a counterexample.

    Every motion inside the box is covered: velocity, temperature and load may change at any time
    in any way. The check is about the friction alone; an offset, a rigid body or a delay is left
    out. A check that is repeated with the same model, values and box costs nothing.

    Parameters
    ----------
    model : Model, ModelFile or Fit
        With values for all parameters.
    box : dict of (low, high)
        ``velocity``, ``temperature``, ``load_torque``, ``position`` ..., SI units and degC. Sides
        that are left out are taken from the model's own box.

    Returns
    -------
    Certificate
        `passive` is True with a proof, False with a counterexample, None if neither was found.

    Raises
    ------
    SpecError
        Values or sides are missing, a side is not read, or the box holds a temperature at which the
        law has no limit, or a bristle with dry friction that is not positive.

    Notes
    -----
    Property 1 of Tadese et al. 2021 is tried first. It is sufficient, not necessary. For models
    with a single deflection an exact condition follows: at every force that the bristle reaches,
    the least work per deflection with rising and with falling deflection must not sum to less than
    zero.

    Examples
    --------
    >>> from stribeck.models.build import model
    >>> friction = model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> check(friction, {"velocity": (-3.0, 3.0)}).passive
    True

    A bristle with a hundred times the damping that property 1 allows, ``4 D/|v|`` = 8/3 N m s/rad.
    Where dry friction is constant the model is passive with any damping.

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
    refuse_unread_sides(box or {}, f"the friction of {asked.spec}", friction.core.needs)
    sides = operating_box(friction, box or {})
    return _certificate(asked, friction, left_out, sides)


def _certificate(
    asked: Model,
    friction: Model,
    left_out: tuple[str, ...],
    box: Mapping[str, tuple[float, float]],
) -> Certificate:
    answer = _answer(_Question.of(friction, box))
    example = answer["counterexample"]
    return Certificate(
        model=asked,
        friction=friction,
        left_out=left_out,
        box=box,
        passive=answer["passive"],
        condition=answer["condition"],
        margins=tuple(_margin(row) for row in answer["margins"]),
        counterexample=None
        if example is None
        else Counterexample(
            friction,
            example["deflection"],
            tuple(dict(step) for step in example["steps"]),
            example["work"],
        ),
    )


@dataclass(frozen=True)
class _Question:
    """All that an answer depends on; questions are equal if their answers are."""

    friction: Model = field(compare=False)
    spec: str
    formulas: tuple[tuple[str, tuple[str, ...]], ...]
    constants: tuple[tuple[str, float], ...]
    values: bytes
    box: tuple[tuple[str, tuple[float, float]], ...]

    @classmethod
    def of(cls, friction: Model, box: Box) -> _Question:
        core = friction.core
        return cls(
            friction,
            friction.spec,
            tuple((terms.text, terms.names) for terms in friction.own),
            tuple(sorted(core.constants.items())),
            friction.values.tobytes(),
            tuple(sorted(box.items())),
        )


@lru_cache(maxsize=KEPT)
def _answer(question: _Question) -> AnswerRow:
    friction = question.friction
    try:
        return _core.passivity(friction.core, friction.values, dict(question.box), BUDGET)
    except _core.ModelError as error:
        raise SpecError(f"{friction.spec} cannot be checked: {error}") from None


def _margin(row: MarginRow) -> Margin:
    lower, upper = row["lower"], row["upper"]
    return Margin(
        condition=row["condition"],
        lower=lower if math.isfinite(lower) else None,
        upper=upper if upper is not None and math.isfinite(upper) else None,
        at=None if row["at"] is None else dict(row["at"]),
    )
