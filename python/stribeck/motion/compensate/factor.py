"""The largest compensation factor that overcompensates nowhere, proved over a box."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stribeck import _core
from stribeck.base.errors import SpecError
from stribeck.base.shown import Shown
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.passivity.friction import friction_part
from stribeck.passivity.operating_box import Box, operating_box

#: Largest number of evaluations of the friction over a box: some seconds.
BUDGET = 100_000
#: Half width of the intervals of the parameters in standard errors, as for 95 %.
STANDARD_ERRORS = 1.96


@dataclass(frozen=True, repr=False)
class Factor(Shown):
    """The largest safe compensation factor.

    Attributes
    ----------
    value
        The largest factor, at most 1, with which compensation nowhere exceeds friction: proved for
        all of the box and all parameters within their intervals. 0: none is.
    bound
        The same without the limits 0 and 1; above 1 the compensator never reaches the friction.
    at_point
        What the bound comes to at the single operating point `point`, which stands in the way.
    box
        Over which it is proved.
    exact
        Parameters of the friction that count as known exactly: nothing is known of their error.
    """

    compensator: Model
    friction: Model
    value: float
    bound: float
    at_point: float
    point: dict[str, float] | None
    box: dict[str, tuple[float, float]]
    exact: tuple[str, ...]

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "compensation": self.compensator.spec,
            "friction": self.friction.spec,
            "factor": self.value,
            "bound": self.bound if math.isfinite(self.bound) else None,
            "bound_at_point": self.at_point if math.isfinite(self.at_point) else None,
            "point": self.point,
            "box": {name: list(side) for name, side in self.box.items()},
            "taken_as_exact": list(self.exact),
        }


def largest_factor(
    compensator: Model | ModelFile | Fit,
    friction: Model | ModelFile | Fit | None = None,
    box: Box | None = None,
) -> Factor:
    """Return the largest ``alpha`` with which the compensator never exceeds the friction.

    Parameters
    ----------
    compensator : Model, ModelFile or Fit
        Its values are what a controller computes with.
    friction : Model, ModelFile or Fit, optional
        What resists: each parameter may lie anywhere in its 95 % interval, which a model without
        standard errors does not have. Default: the compensator, within its own intervals.
    box : dict of (low, high), optional
        Operating box; what it leaves out is taken from the boxes of friction and compensator.

    Returns
    -------
    Factor

    Raises
    ------
    SpecError
        Values or sides are missing, or the box holds a temperature at which a law has no limit.

    Notes
    -----
    With compensation ``f - alpha g`` is left of the friction ``f``. In steady sliding it takes
    energy at every operating point if and only if ``alpha g <= f`` along the motion, so alpha is
    the least ``f/g`` over the box where ``g > 0``. Its lower bound by interval arithmetic with
    subdivision is the answer: a proof, no sample. Parameters count as independent, which allows
    for more than their joint 95 % region does. Of the transient of a bristle it says nothing.

    Examples
    --------
    >>> from stribeck.models.build import model
    >>> cold = model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    >>> warm = model("coulomb", coulomb_friction=1.5, viscous_friction=0.2)
    >>> round(largest_factor(cold, warm, {"velocity": (-1.0, 1.0)}).value, 2)
    0.68
    """
    cancels, _ = friction_part(_checked(compensator))
    resisting = compensator if friction is None else friction
    resists, _ = friction_part(_checked(resisting))
    lower, upper, exact = _intervals(resists, resisting)
    known = {**cancels.box, **resists.box, **(box or {})}
    sides = {**operating_box(cancels, known), **operating_box(resists, known)}
    try:
        bound, at_point, point = _core.largest_factor(
            (cancels.core, cancels.values), (resists.core, lower, upper), sides, BUDGET
        )
    except _core.ModelError as error:
        raise SpecError(f"{resists.spec} has no largest factor: {error}") from None
    value = min(max(bound, 0.0), 1.0)
    return Factor(cancels, resists, value, bound, at_point, point, sides, exact)


def _checked(given: Model | ModelFile | Fit) -> Model:
    model = given if isinstance(given, Model) else given.model
    model.known_values()
    return model


def _intervals(
    friction: Model, given: Model | ModelFile | Fit
) -> tuple[np.ndarray, np.ndarray, tuple[str, ...]]:
    """Between what each parameter of the friction lies, and which have no error."""
    errors = dict(_reach(given))
    reach = np.array([errors.get(name, 0.0) for name in friction.names])
    lower, upper = friction.values - reach, friction.values + reach
    for k, p in enumerate(friction.parameters):
        # Intervals end where a parameter loses its meaning, such as a speed below zero.
        if p.lower >= 0.0 and friction.values[k] >= 0.0:
            lower[k] = max(lower[k], 0.0)
    exact = tuple(name for name in friction.names if name not in errors)
    return lower, upper, exact


def _reach(given: Model | ModelFile | Fit) -> Iterator[tuple[str, float]]:
    """How far each parameter may be off either way, where that is known."""
    if isinstance(given, Fit):
        for name, estimate in given.estimates.items():
            if estimate.ci95 is not None:
                yield name, 0.5 * (estimate.ci95[1] - estimate.ci95[0])
    elif isinstance(given, ModelFile):
        for name, error in given.stderr.items():
            yield name, STANDARD_ERRORS * error
