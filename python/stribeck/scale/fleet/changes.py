"""Which joints have changed: comparison of the newest days with earlier days."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date, timedelta

import polars as pl

from stribeck.base.checks import check_count, check_number, check_share
from stribeck.base.errors import option
from stribeck.scale.fleet.moderated import (
    Difference,
    Scatter,
    common_scatter,
    false_discovery,
    moderated,
    two_sided,
)
from stribeck.scale.fleet.periods import (
    MEAN_FRICTION,
    Compared,
    EffectShift,
    compare_periods,
    effect_shifts,
)
from stribeck.scale.fleet.store import DONE, as_name

#: Robot and name of a joint; each may be unnamed.
JointId = tuple[str | None, str | None]


@dataclass(frozen=True)
class Question:
    """Definition of a change.

    Attributes
    ----------
    since
        First of the new days; None: the newest `window` days.
    history
        Number of earlier days to compare with. Friction changes with the season.
    false_discovery_rate
        Largest expected share of false alarms among the joints listed.
    least_change
        Smallest relevant change: of friction relative to the joint's friction, of another parameter
        relative to its own value.
    """

    since: date | None = None
    window: int = 7
    history: int = 28
    false_discovery_rate: float = 0.05
    least_change: float = 0.02

    def __post_init__(self) -> None:
        check_count("window", self.window)
        check_count("history", self.history)
        check_share("false_discovery", self.false_discovery_rate)
        check_number("least_change", self.least_change, 0.0)


@dataclass(frozen=True)
class Change:
    """A quantity of a joint before and after.

    Attributes
    ----------
    quantity
        A parameter, or ``"friction at +0.5 rad/s"``.
    relative
        Change divided by the reference of `Question.least_change`.
    stderr
        Standard error of the change, including the scatter between days; `p_value` is not corrected
        for the number of quantities.
    """

    quantity: str
    unit: str
    before: float
    after: float
    stderr: float
    relative: float
    p_value: float

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            "quantity": self.quantity,
            "unit": self.unit,
            "before": self.before,
            "after": self.after,
            "stderr": self.stderr,
            "relative": self.relative,
            "p_value": self.p_value,
        }


@dataclass(frozen=True)
class JointChange:
    """Comparison of the newest days of a joint with earlier days.

    Attributes
    ----------
    changes
        Every quantity that could be compared: relevant changes first, then by p-value.
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
        """The relevant change with the smallest p-value."""
        return self.changes[0]

    @property
    def friction(self) -> Change | None:
        """The change of the mean friction over the common speeds; None without common speeds."""
        return next((c for c in self.changes if c.quantity == MEAN_FRICTION), None)

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            "robot": self.robot,
            "joint": self.joint,
            "changed": self.changed,
            "q_value": self.q_value,
            "days_before": self.days_before,
            "days_after": self.days_after,
            "quantities": [change.to_dict() for change in self.changes],
            "effects": [shift.to_dict() for shift in self.effects],
        }


@dataclass(frozen=True)
class Changes:
    """Comparison of all joints of a fleet.

    Attributes
    ----------
    joints
        Every joint that could be compared, the smallest q-value first.
    not_compared
        Joints without a day in one of the periods.
    why
        Why no joint could be compared; None if at least one was.
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

    def to_dict(self) -> dict[str, object]:
        """JSON."""
        return {
            "since": None if self.since is None else self.since.isoformat(),
            "newest": None if self.newest is None else self.newest.isoformat(),
            "history_days": self.question.history,
            "false_discovery_rate": self.question.false_discovery_rate,
            "least_change": self.question.least_change,
            "compared": len(self.joints),
            "not_compared": self.not_compared,
            "why": self.why,
            "changed": len(self.changed),
            "joints": [joint.to_dict() for joint in self.joints],
        }


def find_changes(rows: pl.DataFrame, question: Question) -> Changes:
    """Compare the newest days of every joint with earlier days.

    Parameters
    ----------
    rows
        The data set of a fleet (`stribeck.scale.fleet.store.SCHEMA`).
    """
    dated = rows.filter(pl.col("status") == DONE, pl.col("day").is_not_null())
    every = rows.filter(pl.col("status") == DONE).select("robot", "joint").n_unique()
    newest = dated["day"].max() if dated.height else None
    if not isinstance(newest, date):
        undated = (
            f"no file has a date: give {option('name')} a pattern with {{day}}, or {option('day')} "
            f"a column"
        )
        return Changes(question, None, None, (), every, undated)
    since = question.since or newest - timedelta(days=question.window - 1)
    first = since - timedelta(days=question.history)
    compared: dict[JointId, tuple[list[Compared], pl.DataFrame, pl.DataFrame]] = {}
    for names, days in dated.group_by("robot", "joint", maintain_order=True):
        robot, joint = map(as_name, names)
        before = days.filter(pl.col("day").is_between(first, since, closed="left"))
        after = days.filter(pl.col("day") >= since)
        if before.height and after.height:
            compared[robot, joint] = compare_periods(before, after), before, after
    why = None
    if not compared:
        why = f"no joint has days both from {since} on and in the {question.history} days before"
    return Changes(question, since, newest, _judge(compared, question), every - len(compared), why)


def _judge(
    compared: Mapping[JointId, tuple[Sequence[Compared], pl.DataFrame, pl.DataFrame]],
    question: Question,
) -> tuple[JointChange, ...]:
    """Test every change with the scatter common to all joints."""
    by_kind: dict[str, list[Difference]] = {}
    for quantities, _, _ in compared.values():
        for each in quantities:
            by_kind.setdefault(each.kind, []).append(each.found)
    scatters = {kind: common_scatter(found) for kind, found in by_kind.items()}
    made, smallest = [], []
    for (robot, joint), (quantities, before, after) in compared.items():
        changes = [_change(each, scatters[each.kind]) for each in quantities]
        changes.sort(key=lambda c: (abs(c.relative) < question.least_change, c.p_value))
        # The smallest p-value of several quantities is corrected for their number.
        matter = [c.p_value for c in changes if abs(c.relative) >= question.least_change]
        smallest.append(min([1.0, *(p * len(changes) for p in matter)]))
        shifts = effect_shifts(before, after)
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


def _change(each: Compared, common: Scatter) -> Change:
    found = each.found
    stderr, freedom = moderated(found, common)
    return Change(
        each.quantity,
        each.unit,
        found.before,
        found.after,
        stderr,
        found.change / each.size if each.size else math.inf,
        two_sided(found.change, stderr, freedom),
    )
