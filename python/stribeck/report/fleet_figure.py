"""The figure of a fleet: the change of each joint's friction, and which joint has which effect."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stribeck.report.fleet import changes_sentence, joint_name
from stribeck.report.numbers import percent
from stribeck.report.style import AFTER, BEFORE, MEASURED, new_figure, style, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.scale.fleet.changes import Change, Changes, JointChange
    from stribeck.scale.fleet.effects import Effects, JointEffect
    from stribeck.scale.fleet.result import Fleet

#: Joints that are named beside their change, and in a cell of the table of effects.
MOST_NAMED, MOST_IN_A_CELL = 12, 2


def fleet_figure(fleet: Fleet) -> Figure:
    """Change of the mean friction of every joint, and the effects of the joints of each name."""
    names = {share.joint for share in fleet.effects.shares}
    if not names:
        figure = new_figure(6.5, 4.0)
        _draw_changes(figure.subplots(), fleet.changes)
        return figure
    figure = new_figure(11.0, max(4.0, 1.6 + 0.55 * len(names)))
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    _draw_changes(left, fleet.changes)
    _draw_effects(right, fleet.effects)
    return figure


def with_friction(changes: Changes) -> list[tuple[JointChange, Change]]:
    """The joints with their change of mean friction, where it is known."""
    return [(j, c) for j in changes.joints if (c := j.friction) is not None and c.before]


def _draw_changes(axes: Axes, changes: Changes) -> None:
    """Every joint by the change of its mean friction, with a 95 % interval."""
    style(axes)
    title(axes, "Change of mean friction, every joint")
    drawn = with_friction(changes)
    if not drawn:
        axes.set_axis_off()
        axes.text(
            0.5,
            0.5,
            changes_sentence(changes),
            ha="center",
            va="center",
            wrap=True,
            fontsize=10,
            color=MEASURED,
            transform=axes.transAxes,
        )
        return
    drawn.sort(key=lambda pair: pair[1].relative)
    shares = np.array([100.0 * change.relative for _, change in drawn])
    errors = np.array([196.0 * change.stderr / abs(change.before) for _, change in drawn])
    changed = np.array([joint.changed for joint, _ in drawn])
    places = np.arange(shares.size)
    for chosen, colour, label in (
        (~changed, MEASURED, "within the variation from day to day"),
        (changed, BEFORE, "changed"),
    ):
        if chosen.any():
            axes.errorbar(
                shares[chosen],
                places[chosen],
                xerr=errors[chosen],
                fmt="o",
                color=colour,
                markersize=4.0,
                elinewidth=1.0,
                label=label,
            )
    for place in np.flatnonzero(changed)[:MOST_NAMED]:
        joint = drawn[place][0]
        axes.annotate(
            joint_name(joint.robot, joint.joint),
            (shares[place], place),
            xytext=(0, 5),
            textcoords="offset points",
            ha="center",
            fontsize=8.5,
            color=BEFORE,
        )
    axes.axvline(0.0, color=MEASURED, linewidth=0.8)
    axes.margins(y=0.12)
    axes.set_yticks([])
    axes.set_xlabel(f"change since {changes.since} [%], with 95 % intervals")
    axes.legend(loc="lower right", frameon=False, fontsize=8.5)


def _draw_effects(axes: Axes, effects: Effects) -> None:
    """Share of the joints of a name that have an effect, and the robots that stand out."""
    title(axes, "Share of the joints that have an effect")
    rows = list(dict.fromkeys(share.joint for share in effects.shares))
    columns = list(dict.fromkeys(share.effect for share in effects.shares))
    shares = np.zeros((len(rows), len(columns)))
    for share in effects.shares:
        shares[rows.index(share.joint), columns.index(share.effect)] = share.having / share.joints
    axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
    for i, row in enumerate(rows):
        for k, column in enumerate(columns):
            odd = [e for e in effects.odd if e.joint == row and e.effect == column]
            text = _cell(shares[i, k], odd)
            colour = BEFORE if odd else "white" if shares[i, k] > 0.6 else MEASURED
            weight = "bold" if odd else "normal"
            axes.text(
                k, i, text, ha="center", va="center", fontsize=8.5, color=colour, fontweight=weight
            )
    axes.set_xticks(range(len(columns)), columns, rotation=30, ha="right", fontsize=9)
    axes.set_yticks(range(len(rows)), [row or "unnamed" for row in rows], fontsize=9)
    axes.set_xlabel("effect")
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_color(AFTER)
        side.set_linewidth(0.6)


def _cell(share: float, odd: list[JointEffect]) -> str:
    """The share, and the robots that have an effect that their peers lack."""
    if share == 0.0:
        return ""
    robots = [each.robot or "unnamed" for each in odd]
    named = ", ".join(robots[:MOST_IN_A_CELL])
    more = f" +{len(robots) - MOST_IN_A_CELL}" if len(robots) > MOST_IN_A_CELL else ""
    return f"{percent(share)}\n{named}{more}" if named else percent(share)
