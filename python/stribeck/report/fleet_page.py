"""A page on a fleet: the figure, every joint that changed, every joint that stands out."""

from __future__ import annotations

from dataclasses import dataclass
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
from stribeck.report.fleet_figure import fleet_figure
from stribeck.report.page import picture_text, render

if TYPE_CHECKING:
    from stribeck.scale.fleet.result import Fleet


@dataclass(frozen=True)
class Section:
    """A title, what is said, and tables whose first row is the heading."""

    title: str
    sentences: list[str]
    tables: list[list[list[str]]]


def fleet_page(fleet: Fleet) -> str:
    """The whole answer as a page; no table is shortened."""
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
    return render(
        "fleet.html",
        name=f"Fleet {fleet.folder.name}",
        summary=heading(fleet),
        picture=picture_text(fleet_figure(fleet)),
        sections=sections,
    )
