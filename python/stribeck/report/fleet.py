"""A fleet as text: what was done, which joints changed, which differ from their peers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from stribeck.base.errors import joint_called
from stribeck.report.layout import joined, paragraph, table
from stribeck.report.numbers import (
    DASH,
    MINUS,
    confidence_text,
    listed,
    percent,
    plain,
    thousands,
    unit_text,
    with_error,
)

if TYPE_CHECKING:
    from stribeck.scale.fleet.changes import Change, Changes, JointChange
    from stribeck.scale.fleet.effects import Effects, JointEffect
    from stribeck.scale.fleet.result import Failure, Fleet

#: Rows of a table before it says how many more there are.
MOST_ROWS = 20
PLUS_MINUS = "\N{PLUS-MINUS SIGN}"
CHANGED = "Which joints have changed"
ODD = "Which joints have an effect that their peers lack"


def fleet_text(fleet: Fleet) -> str:
    """The whole answer."""
    return joined(
        heading(fleet),
        f"{CHANGED}\n\n{_changes(fleet.changes)}",
        f"{ODD}\n\n{_effects(fleet.effects)}",
        "\n".join(paragraph(f"Note: {note}.", 0, 2) for note in fleet.reading_notes()),
        _failures(fleet.failures),
        f"Results of every joint and day:\n  {fleet.to_dict()['output']}",
    )


def heading(fleet: Fleet) -> str:
    """What was done, in a sentence."""
    count = fleet.counts()
    failed = f", {counted(count['failed'], 'task')} failed" if count["failed"] else ""
    return (
        f"{fleet.work.label} on {counted(count['robots'], 'robot')}, "
        f"{counted(count['joints'], 'joint')}, {counted(count['days'], 'day')}: "
        f"{counted(count['done'], 'task')} done ({thousands(count['new'])} in this run){failed}"
    )


def counted(count: int, what: str) -> str:
    """``1 joint``, ``1 200 joints``."""
    return f"{thousands(count)} {what}{'' if count == 1 else 's'}"


def joint_name(robot: str | None, joint: str | None) -> str:
    """Robot and joint, as far as they are named."""
    return " ".join(name for name in (robot, joint) if name) or "unnamed"


def _changes(changes: Changes) -> str:
    lines = [paragraph(changes_sentence(changes))]
    if changes.changed:
        lines += ["", table(change_rows(changes.changed[:MOST_ROWS]), right=(1, 3, 4))]
        lines += _more(len(changes.changed), "joints")
    shifts = shift_sentences(changes.joints)
    if shifts:
        lines += ["", *(paragraph(sentence, hang=2) for sentence in shifts[:MOST_ROWS])]
    return "\n".join(lines)


def _more(count: int, what: str) -> list[str]:
    return [f"  and {thousands(count - MOST_ROWS)} more {what}"] if count > MOST_ROWS else []


def changes_sentence(changes: Changes) -> str:
    """What was compared, and how many changed."""
    if changes.why is not None:
        return f"Not known: {changes.why}."
    asked = changes.question
    apart = ""
    if changes.not_compared:
        apart = f" Not compared, for lack of days: {counted(changes.not_compared, 'joint')}."
    return (
        f"{counted(len(changes.changed), 'joint')} of {thousands(len(changes.joints))} changed by "
        f"at least {percent(asked.least_change)}: {changes.since} to {changes.newest} compared "
        f"with the {asked.history} days before. False discovery rate: at most "
        f"{percent(asked.false_discovery_rate)}.{apart}"
    )


def change_rows(joints: Sequence[JointChange]) -> list[list[str]]:
    """A heading and a row a joint."""
    rows = [["joint", "mean friction", "most significant change", "before", "after", "days"]]
    for each in joints:
        change, friction = each.largest, each.friction
        rows.append(
            [
                joint_name(each.robot, each.joint),
                DASH if friction is None else relative_text(friction.relative),
                change.quantity.replace("_", " "),
                plain(change.before),
                _after(change),
                f"{each.days_before} + {each.days_after}",
            ]
        )
    return rows


def _after(change: Change) -> str:
    value, error = with_error(change.after, change.stderr)
    return f"{value} {PLUS_MINUS} {error} {unit_text(change.unit)}".strip()


def relative_text(share: float) -> str:
    """A relative change with its sign."""
    if not math.isfinite(share):
        return "from zero"
    return f"{'+' if share >= 0.0 else MINUS}{percent(abs(share))}"


def shift_sentences(joints: Sequence[JointChange]) -> list[str]:
    """Effects that appeared or disappeared."""
    return [
        f"{joint_name(each.robot, each.joint)}: {shift.effect} found on {shift.before} of "
        f"{each.days_before} days before, on {shift.after} of {each.days_after} since"
        for each in joints
        for shift in each.effects
    ]


def _effects(effects: Effects) -> str:
    lines = [paragraph(effects_sentence(effects))]
    if effects.odd:
        lines += ["", table(odd_rows(effects.odd[:MOST_ROWS]), right=(2, 3))]
        lines += _more(len(effects.odd), "findings")
    shares = share_rows(effects)
    if shares:
        right = range(1, len(shares[0]))
        lines += ["", "  Joints that have each effect:", "", table(shares, right)]
    return "\n".join(lines)


def effects_sentence(effects: Effects) -> str:
    """How many joints have an effect that their peers lack."""
    if effects.why is not None:
        return f"Not known: {effects.why}."
    if not effects.odd:
        return "None: no effect is limited to a few joints."
    joints = len({(each.robot, each.joint) for each in effects.odd})
    its = "its" if joints == 1 else "their"
    return (
        f"{counted(joints, 'joint')}. The effect was found on most of {its} days, but not on the "
        f"same joint of most other robots."
    )


def odd_rows(odd: Sequence[JointEffect]) -> list[list[str]]:
    """A heading and a row for each joint and effect that its peers lack."""
    rows = [["joint", "effect", "days", "peers with it", "confidence", "indistinguishable from"]]
    for each in odd:
        rows.append(
            [
                joint_name(each.robot, each.joint),
                each.effect,
                f"{each.days_found} of {each.days}",
                f"{each.peers_with} of {each.peers}",
                confidence_text(each.confidence),
                listed(each.tied) or DASH,
            ]
        )
    return rows


def share_rows(effects: Effects) -> list[list[str]]:
    """A heading and a row for each name of a joint: how many of them have each effect."""
    names = list(dict.fromkeys(share.effect for share in effects.shares))
    by_joint: dict[str | None, list[str]] = {}
    for share in effects.shares:
        by_joint.setdefault(share.joint, []).append(f"{share.having} of {share.joints}")
    rows = [[name or "unnamed", *cells] for name, cells in by_joint.items()]
    return [["joint", *names], *rows] if names else []


def _failures(failures: Sequence[Failure]) -> str:
    """Tasks without a result, and why."""
    if not failures:
        return ""
    lines = [f"Without a result ({counted(len(failures), 'task')}):", ""]
    lines += [paragraph(said, hang=2) for said in failure_sentences(failures[:MOST_ROWS])]
    return "\n".join([*lines, *_more(len(failures), "tasks")])


def failure_sentences(failures: Sequence[Failure]) -> list[str]:
    """A line for each file, joint and reason; the file once in it."""
    return [_failure_sentence(failure) for failure in failures]


def _failure_sentence(failure: Failure) -> str:
    if failure.joint is None and failure.reason.startswith(failure.file):
        return failure.reason
    joint = "" if failure.joint is None else f", {joint_called(failure.joint)}"
    reason = failure.reason.removeprefix(failure.file).removeprefix(": ")
    return f"{failure.file}{joint}: {reason}"
