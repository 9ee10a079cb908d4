"""What a notebook shows of results that are tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import polars as pl


class Tabular(Protocol):
    """A result that can be had as a table."""

    def to_frame(self) -> pl.DataFrame: ...


def frame(result: Tabular) -> str:
    """The table of a result as HTML."""
    return str(result.to_frame()._repr_html_())
