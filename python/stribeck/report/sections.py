"""The sections of a page that is made of tables."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Section:
    """A title, what is said, and tables whose first row is the heading."""

    title: str
    sentences: list[str]
    tables: list[list[list[str]]]
