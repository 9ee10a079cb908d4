"""The largest compensation factor that never overcompensates, proved over an operating box."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from stribeck import _core
from stribeck.base.arguments import door
from stribeck.base.errors import SpecError
from stribeck.base.shown import Shown
from stribeck.fitting.result import Fit
from stribeck.models.model import Model
from stribeck.models.model_file import WITH_MODEL, ModelFile
from stribeck.passivity.friction import friction_part
from stribeck.passivity.operating_box import Box, operating_box, refuse_unread_sides

#: Largest number of evaluations of the friction over a box; takes some seconds.
BUDGET = 100_000
#: Half-width of the 95 % intervals of the parameters, in standard errors.
STANDARD_ERRORS = 1.96


@dataclass(frozen=True, repr=False)
class Factor(Shown):
    """The largest safe compensation factor.

    Attributes
    ----------
    value
        The largest factor, at most 1, with which compensation never exceeds friction, proved for
        the whole box and all parameters within their intervals. 0: no factor is safe.
    bound
        The factor without the limits 0 and 1; above 1 the compensator never reaches the friction.
    at_point
        The ratio of friction to compensation at `point`, the operating point that limits the
        factor.
    box
        Operating box of the proof.
    exact
        Parameters of the friction without a standard error, which are treated as exact.
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


@door(compensator=WITH_MODEL)
def largest_factor(
    compensator: Model | ModelFile | Fit,
    friction: Model | ModelFile | Fit | None = None,
    box: Box | None = None,
) -> Factor:
    """Return the largest ``alpha`` with which the compensator never exceeds the friction.

    Parameters
    ----------
    compensator : Model, ModelFile or Fit
        The model that the controller evaluates.
    friction : Model, ModelFile or Fit, optional
        The true friction, with each parameter anywhere in its 95 % interval; a parameter without a
        standard error is exact. Default: the compensator, with its own intervals.
    box : dict of (low, high), optional
        Operating box; missing sides are taken from the boxes of friction and compensator.

    Returns
    -------
    Factor

    Raises
    ------
    SpecError
        Values or sides are missing, or a law is unbounded at a temperature of the box.

    Notes
    -----
    With compensation ``alpha g`` of friction ``f``, the torque ``f - alpha g`` remains. In steady
    sliding it dissipates energy at every operating point if and only if ``alpha g <= f`` along the
    motion, so the largest alpha is the minimum of ``f/g`` over the box where ``g > 0``. The result
    is a lower bound of this minimum, proved by interval arithmetic with subdivision. Parameters are
    treated as independent, which is conservative compared with their joint 95 % region. The result
    does not cover bristle transients.

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
    read = {*cancels.core.needs, *resists.core.needs}
    refuse_unread_sides(box or {}, f"the friction of {cancels.spec} and {resists.spec}", read)
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
    """Return the intervals of the friction's parameters, and the parameters without an error."""
    errors = dict(_reach(given))
    below, above = np.array([errors.get(name, (0.0, 0.0)) for name in friction.names]).T
    lower, upper = friction.values - below, friction.values + above
    for k, p in enumerate(friction.parameters):
        # Intervals end where a parameter becomes meaningless, such as a negative speed.
        if p.lower >= 0.0 and friction.values[k] >= 0.0:
            lower[k] = max(lower[k], 0.0)
    exact = tuple(name for name in friction.names if name not in errors)
    return lower, upper, exact


def _reach(given: Model | ModelFile | Fit) -> Iterator[tuple[str, tuple[float, float]]]:
    """Yield how far the interval of each parameter reaches below and above its value, if known.

    Raises
    ------
    SpecError
        An interval is infinite.
    """
    if isinstance(given, Fit):
        for name, estimate in given.estimates.items():
            if estimate.ci95 is None:
                continue
            low, high = estimate.ci95
            if not np.isfinite([low, high]).all():
                raise SpecError(
                    f"the interval of {name} is infinite: give it bounds in the fit, or fix it"
                )
            half = 0.5 * (high - low)
            symmetric = given.errors in ("robust", "independent")
            yield name, (half, half) if symmetric else (estimate.value - low, high - estimate.value)
    elif isinstance(given, ModelFile):
        for name, error in given.stderr.items():
            yield name, (STANDARD_ERRORS * error, STANDARD_ERRORS * error)
