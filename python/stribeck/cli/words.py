"""Words that a shell may complete: laws, effects, files."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem

from stribeck.models.catalog import effect_ids, effect_row, law_ids, law_row

__all__ = ["complete_effect", "complete_law", "complete_model"]


def complete_law(
    ctx: click.Context, param: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Ids of laws."""
    rows = ((law, law_row(law)) for law in law_ids() if law.startswith(incomplete))
    return [CompletionItem(law, help=row and row["title"]) for law, row in rows]


def complete_effect(
    ctx: click.Context, param: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Ids of effects."""
    rows = ((id, effect_row(id)) for id in effect_ids() if id.startswith(incomplete))
    return [CompletionItem(id, help=row and row["title"]) for id, row in rows]


def complete_model(
    ctx: click.Context, param: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Files, and specs: a law, or an effect after the last plus sign."""
    before, plus, begun = incomplete.rpartition("+")
    if not plus:
        files = [CompletionItem(incomplete, type="file")]
        return files + (complete_law(ctx, param, incomplete) if incomplete else [])
    found = complete_effect(ctx, param, begun)
    return [CompletionItem(f"{before}+{one.value}", help=one.help) for one in found]
