"""Comparison of one joint in two periods."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.passivity.friction import friction_part
from stribeck.scale.fleet.friction_at import DayModel, common_conditions, common_speeds
from stribeck.scale.fleet.moderated import Difference, difference

Array = NDArray[np.float64]

MEAN_FRICTION = "mean friction"


@dataclass(frozen=True)
class Compared:
    """A quantity of one joint, before the scatter common to all joints is estimated.

    `kind` is the same for the same quantity of all joints: ``"coulomb_friction"``, ``"friction
    forwards at 0.5 of the speed"``. The relative change is the change divided by `size`.
    """

    kind: str
    quantity: str
    unit: str
    size: float
    found: Difference


@dataclass(frozen=True)
class EffectShift:
    """Number of days on which an effect was found, before and after."""

    effect: str
    before: int
    after: int

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {"effect": self.effect, "days_before": self.before, "days_after": self.after}


def compare_periods(before: pl.DataFrame, after: pl.DataFrame) -> list[Compared]:
    """Compare friction and parameters of one joint in two periods.

    Parameters
    ----------
    before, after
        Rows of the data set; each file is treated as one day.
    """
    earlier, later = _models(before), _models(after)
    friction = _compare_friction(earlier, later)
    size = next((abs(c.found.before) for c in friction if c.quantity == MEAN_FRICTION), 0.0)
    return friction + _compare_parameters(earlier, later, size)


def _models(days: pl.DataFrame) -> list[DayModel]:
    stored = days.select("model_file", "covariance")
    return [DayModel.of(text, covariance) for text, covariance in stored.iter_rows()]


def _compare_friction(before: Sequence[DayModel], after: Sequence[DayModel]) -> list[Compared]:
    """Compare the friction at each common speed, and its mean over them."""
    models = [day.model for day in (*before, *after)]
    speeds, conditions = common_speeds(models), common_conditions(models)
    if speeds.size == 0:
        return []
    # Friction in both directions, positive if it opposes motion.
    along = np.sign(speeds)
    weights = np.vstack([along / speeds.size, np.diag(along)])
    periods = [_weighted_friction(days, speeds, conditions, weights) for days in (before, after)]
    unit, per = models[0].load_unit, f"{models[0].position_unit}/s"
    names = [MEAN_FRICTION, *(f"friction at {v:+.3g} {per}" for v in speeds)]
    top = np.abs(speeds).max()
    kinds = [MEAN_FRICTION, *(f"friction at {v / top:+.2f}" for v in speeds)]
    made = []
    for k, (kind, name) in enumerate(zip(kinds, names, strict=True)):
        found = _difference(*[(torque[:, k], error[:, k]) for torque, error in periods])
        if found is not None:
            made.append(Compared(kind, name, unit, abs(found.before), found))
    return made


def _weighted_friction(
    days: Sequence[DayModel], speeds: Array, conditions: Mapping[str, float], weights: Array
) -> tuple[Array, Array]:
    """Return weighted sums of the friction at the common speeds, and their standard errors.

    Parameters
    ----------
    weights : array [m, n]
        Weight of each of n speeds in each of m sums.

    Returns
    -------
    values, errors : arrays [days, m]
        NaN on a day whose model has no friction there.
    """
    values, errors = np.full((2, len(days), len(weights)), np.nan)
    for k, day in enumerate(days):
        try:
            torque, covariance = day.friction_at(speeds, conditions)
        except ValueError:
            continue
        values[k] = weights @ torque
        variance = np.einsum("ij,jk,ik->i", weights, covariance, weights)
        errors[k] = np.sqrt(np.maximum(variance, 0.0))
    return values, errors


def _compare_parameters(
    before: Sequence[DayModel], after: Sequence[DayModel], friction: float
) -> list[Compared]:
    """Return each parameter of the newest model, for the days with this model.

    If constants of the model differ from day to day (a reference temperature), its friction
    parameters are not comparable and are left out.
    """
    spec = Counter(day.model.spec for day in after).most_common(1)[0][0]
    periods = [[day for day in days if day.model.spec == spec] for days in (before, after)]
    every = [day.model for days in periods for day in days]
    alike = all(model.constants == every[0].constants for model in every)
    left_out = set() if alike else set(friction_part(every[0])[0].names)
    made = []
    for k, parameter in enumerate(every[0].parameters):
        found = _difference(*[_values(days, k) for days in periods])
        if parameter.name not in left_out and found is not None:
            torque_like = parameter.unit == every[0].load_unit and friction > 0.0
            size = friction if torque_like else abs(found.before)
            name = parameter.name
            made.append(Compared(name, name, parameter.unit, size, found))
    return made


def _values(days: Sequence[DayModel], k: int) -> tuple[Array, Array]:
    """Values [days] of one parameter and their standard errors [days]."""
    values = np.array([day.model.values[k] for day in days], dtype=np.float64)
    errors = np.sqrt([day.covariance[k, k] for day in days])
    return values, np.asarray(errors, dtype=np.float64)


def _difference(before: tuple[Array, Array], after: tuple[Array, Array]) -> Difference | None:
    """Compare the days that have a standard error; None if a period has none."""
    kept = [
        (values[known], errors[known])
        for values, errors in (before, after)
        for known in [(errors > 0.0) & np.isfinite(errors) & np.isfinite(values)]
    ]
    (values, errors), (later, later_errors) = kept
    if values.size == 0 or later.size == 0:
        return None
    return difference(values, later, errors, later_errors)


def effect_shifts(before: pl.DataFrame, after: pl.DataFrame) -> tuple[EffectShift, ...]:
    """Effects found on most of the days of one period and not of the other."""
    counts = [
        Counter(each["effect"] for found in days["found"].to_list() for each in found)
        for days in (before, after)
    ]
    mostly = [
        {effect for effect, count in of.items() if 2 * count > days.height}
        for of, days in zip(counts, (before, after), strict=True)
    ]
    return tuple(
        EffectShift(effect, counts[0][effect], counts[1][effect])
        for effect in sorted(mostly[0] ^ mostly[1])
    )
