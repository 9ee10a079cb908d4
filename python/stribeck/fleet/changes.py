"""Which joints have changed: the newest days against those before."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date, timedelta
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.fleet.effects import str_or_none
from stribeck.fleet.friction_at import DayModel, common_conditions, common_speeds
from stribeck.fleet.moderated import (
    Difference,
    Scatter,
    common_scatter,
    difference,
    false_discovery,
    moderated,
    two_sided,
)
from stribeck.fleet.store import DONE
from stribeck.passivity.friction import friction_part

Array = NDArray[np.float64]
#: Robot and name of a joint; each may be unnamed.
JointId = tuple[str | None, str | None]
MEAN_FRICTION = "mean friction"


@dataclass(frozen=True)
class Question:
    """What counts as a change.

    Attributes
    ----------
    since
        First of the new days; None: the newest `window` days.
    false_discovery_rate
        Largest share of the joints listed that may be there by chance.
    least_change
        Smallest change that matters: of friction relative to the joint's friction, of another
        parameter relative to itself.
    """

    since: date | None = None
    window: int = 7
    false_discovery_rate: float = 0.05
    least_change: float = 0.02


@dataclass(frozen=True)
class Change:
    """A quantity of a joint before and after.

    Attributes
    ----------
    quantity
        A parameter, or ``"friction at +0.5 rad/s"``.
    relative
        Change relative to what `Question.least_change` speaks of.
    stderr
        Of the change, with the scatter between days; `p_value` is that of the quantity alone.
    """

    quantity: str
    unit: str
    before: float
    after: float
    stderr: float
    relative: float
    p_value: float

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return {
            "quantity": self.quantity, "unit": self.unit, "before": self.before,
            "after": self.after, "stderr": self.stderr, "relative": self.relative,
            "p_value": self.p_value,
        }  # fmt: skip


@dataclass(frozen=True)
class EffectShift:
    """On how many of the days an effect was found, before and after."""

    effect: str
    before: int
    after: int

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return {"effect": self.effect, "days_before": self.before, "days_after": self.after}


@dataclass(frozen=True)
class JointChange:
    """One joint, its newest days against those before.

    Attributes
    ----------
    changes
        Every quantity that could be compared; those that are large enough to matter come first,
        and of these the surest.
    q_value
        Smallest false discovery rate at which the joint is listed.
    effects
        Effects found on most of the days of one period and not of the other.
    """

    robot: str | None
    joint: str | None
    days_before: int
    days_after: int
    changes: tuple[Change, ...]
    effects: tuple[EffectShift, ...]
    q_value: float
    changed: bool

    @property
    def largest(self) -> Change:
        """The surest of the changes that are large enough to matter."""
        return self.changes[0]

    @property
    def friction(self) -> Change | None:
        """The change of the mean friction over the common speeds; None where there are none."""
        return next((c for c in self.changes if c.quantity == MEAN_FRICTION), None)

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return {
            "robot": self.robot, "joint": self.joint, "changed": self.changed,
            "q_value": self.q_value, "days_before": self.days_before,
            "days_after": self.days_after,
            "quantities": [change.to_dict() for change in self.changes],
            "effects": [shift.to_dict() for shift in self.effects],
        }  # fmt: skip


@dataclass(frozen=True)
class Changes:
    """Which joints of a fleet have changed.

    Attributes
    ----------
    joints
        Every joint that could be compared, the surest change first.
    not_compared
        Joints without a day in one of the periods.
    why
        Why nothing could be compared; None where something was.
    """

    question: Question
    since: date | None
    newest: date | None
    joints: tuple[JointChange, ...]
    not_compared: int
    why: str | None

    @property
    def changed(self) -> tuple[JointChange, ...]:
        """The joints that have changed."""
        return tuple(joint for joint in self.joints if joint.changed)

    def to_dict(self) -> dict[str, Any]:
        """JSON."""
        return {
            "since": None if self.since is None else self.since.isoformat(),
            "newest": None if self.newest is None else self.newest.isoformat(),
            "false_discovery_rate": self.question.false_discovery_rate,
            "least_change": self.question.least_change,
            "compared": len(self.joints),
            "not_compared": self.not_compared,
            "why": self.why,
            "changed": len(self.changed),
            "joints": [joint.to_dict() for joint in self.joints],
        }


@dataclass(frozen=True)
class _Compared:
    """A quantity of one joint before the scatter of the others is known.

    `kind` is the same for a like quantity of all joints: ``"coulomb_friction"``, ``"friction
    forwards at 0.5 of the speed"``. `size` is what the change is relative to.
    """

    kind: str
    quantity: str
    unit: str
    size: float
    found: Difference


def find_changes(rows: pl.DataFrame, question: Question) -> Changes:
    """Compare the newest days of every joint with those before.

    Parameters
    ----------
    rows
        The data set of a fleet (`stribeck.fleet.store.SCHEMA`).
    """
    dated = rows.filter(pl.col("status") == DONE, pl.col("day").is_not_null())
    every = rows.filter(pl.col("status") == DONE).select("robot", "joint").n_unique()
    newest = dated["day"].max() if dated.height else None
    if not isinstance(newest, date):
        undated = "no file has a date: name it by --name with {day}, or by --day COLUMN"
        return Changes(question, None, None, (), every, undated)
    since = question.since or newest - timedelta(days=question.window - 1)
    compared: dict[JointId, tuple[list[_Compared], pl.DataFrame, pl.DataFrame]] = {}
    for names, days in dated.group_by("robot", "joint", maintain_order=True):
        robot, joint = map(str_or_none, names)
        before, after = days.filter(pl.col("day") < since), days.filter(pl.col("day") >= since)
        if before.height and after.height:
            compared[robot, joint] = _compare(before, after), before, after
    why = None
    if not compared:
        why = f"no joint has days both before {since} and since"
    return Changes(question, since, newest, _judge(compared, question), every - len(compared), why)


def _judge(
    compared: Mapping[JointId, tuple[Sequence[_Compared], pl.DataFrame, pl.DataFrame]],
    question: Question,
) -> tuple[JointChange, ...]:
    """Weigh every change by the scatter that joints have in common."""
    by_kind: dict[str, list[Difference]] = {}
    for quantities, _, _ in compared.values():
        for each in quantities:
            by_kind.setdefault(each.kind, []).append(each.found)
    scatters = {kind: common_scatter(found) for kind, found in by_kind.items()}
    made, smallest = [], []
    for (robot, joint), (quantities, before, after) in compared.items():
        changes = [_change(each, scatters[each.kind]) for each in quantities]
        changes.sort(key=lambda c: (abs(c.relative) < question.least_change, c.p_value))
        # The surest of several quantities has had several chances.
        matter = [c.p_value for c in changes if abs(c.relative) >= question.least_change]
        smallest.append(min([1.0, *(p * len(changes) for p in matter)]))
        shifts = _effect_shifts(before, after)
        made.append(
            JointChange(
                robot, joint, before.height, after.height, tuple(changes), shifts, 1.0, False
            )
        )
    judged = [
        replace(each, q_value=q, changed=q <= question.false_discovery_rate)
        for each, q in zip(made, false_discovery(smallest), strict=True)
    ]
    judged.sort(key=lambda j: (j.q_value, j.robot or "", j.joint or ""))
    return tuple(judged)


def _change(each: _Compared, common: Scatter) -> Change:
    found = each.found
    stderr, freedom = moderated(found, common)
    return Change(
        each.quantity, each.unit, found.before, found.after, stderr,
        found.change / each.size if each.size else math.inf,
        two_sided(found.change, stderr, freedom),
    )  # fmt: skip


def _compare(before: pl.DataFrame, after: pl.DataFrame) -> list[_Compared]:
    """Friction and parameters of one joint in two periods."""
    earlier, later = _models(before), _models(after)
    friction = _compare_friction(earlier, later)
    size = next((abs(c.found.before) for c in friction if c.quantity == MEAN_FRICTION), 0.0)
    return friction + _compare_parameters(earlier, later, size)


def _models(days: pl.DataFrame) -> list[DayModel]:
    stored = days.select("model_file", "covariance")
    return [DayModel.of(text, covariance) for text, covariance in stored.iter_rows()]


def _compare_friction(before: Sequence[DayModel], after: Sequence[DayModel]) -> list[_Compared]:
    """The friction at each of the common speeds, and its mean over them."""
    models = [day.model for day in (*before, *after)]
    speeds, conditions = common_speeds(models), common_conditions(models)
    if speeds.size == 0:
        return []
    # What opposes the motion, whichever its direction.
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
            made.append(_Compared(kind, name, unit, abs(found.before), found))
    return made


def _weighted_friction(
    days: Sequence[DayModel], speeds: Array, conditions: Mapping[str, float], weights: Array
) -> tuple[Array, Array]:
    """Combinations of the friction at the common speeds, and their standard errors.

    Parameters
    ----------
    weights : array [m, n]
        Of each of the n speeds in each of the m combinations.

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
) -> list[_Compared]:
    """Each parameter of the newest model, on the days that have this model.

    Where fixed numbers of the model differ from day to day (a reference temperature), the friction
    parameters mean something else each day, and are left out.
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
            made.append(_Compared(name, name, parameter.unit, size, found))
    return made


def _values(days: Sequence[DayModel], k: int) -> tuple[Array, Array]:
    """Values [days] of one parameter and their standard errors [days]."""
    values = np.array([day.model.values[k] for day in days], dtype=np.float64)
    errors = np.sqrt([day.covariance[k, k] for day in days])
    return values, np.asarray(errors, dtype=np.float64)


def _difference(before: tuple[Array, Array], after: tuple[Array, Array]) -> Difference | None:
    """Compare the days that have a standard error; None where a period has none."""
    kept = [
        (values[known], errors[known])
        for values, errors in (before, after)
        for known in [(errors > 0.0) & np.isfinite(errors) & np.isfinite(values)]
    ]
    (values, errors), (later, later_errors) = kept
    if values.size == 0 or later.size == 0:
        return None
    return difference(values, later, errors, later_errors)


def _effect_shifts(before: pl.DataFrame, after: pl.DataFrame) -> tuple[EffectShift, ...]:
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
