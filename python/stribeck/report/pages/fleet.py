"""A page on a fleet: the figure, every joint that changed, every joint that stands out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from stribeck.report.fleet import (
    CHANGED,
    ODD,
    change_rows,
    changes_sentence,
    counted,
    effects_sentence,
    failure_sentences,
    heading,
    odd_rows,
    share_rows,
    shift_sentences,
)
from stribeck.report.fleet_figure import with_friction
from stribeck.report.interactive.fleet_changes import fleet_changes
from stribeck.report.interactive.fleet_effects import fleet_effects
from stribeck.report.pages.figures import figures_of
from stribeck.report.pages.recording import sections_page
from stribeck.report.pages.sections import Section

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.scale.fleet.result import Fleet


def fleet_page(fleet: Fleet, command: str = "", spell: Callable[[str], str] = str) -> str:
    """The whole answer as a page; no table is shortened.

    Parameters
    ----------
    command
        The command that made it.
    spell
        Writes the options in its sentences.
    """
    changes, effects = fleet.changes, fleet.effects
    changed = change_rows(changes.changed)
    odd = odd_rows(effects.odd)
    sections = [
        Section(
            CHANGED,
            [changes_sentence(changes), *shift_sentences(changes.joints)],
            [changed] if len(changed) > 1 else [],
        ),
        Section(
            ODD,
            [effects_sentence(effects)],
            [rows for rows in (odd, share_rows(effects)) if len(rows) > 1],
        ),
    ]
    if fleet.failures:
        title = f"Without a result ({counted(len(fleet.failures), 'task')})"
        sections.append(Section(title, failure_sentences(fleet.failures), []))
    return sections_page(
        f"Fleet in the folder {fleet.folder.name}",
        "changed joints and unusual effects",
        heading(fleet),
        figures_of(fleet_plots(fleet)),
        [replace(one, sentences=[*map(spell, one.sentences)]) for one in sections],
        command,
    )


def fleet_plots(fleet: Fleet) -> dict[str, figure]:
    """The figures of a fleet that have something to show, by their captions."""
    plots: dict[str, figure] = {}
    if with_friction(fleet.changes):
        plots["Change of mean friction of every joint, with 95 % intervals"] = fleet_changes(
            fleet.changes
        )
    if fleet.effects.shares:
        plots["Share of the joints that have an effect; framed: some robots stand out"] = (
            fleet_effects(fleet.effects)
        )
    return plots
