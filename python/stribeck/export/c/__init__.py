"""Self-contained C99: header, source, test vectors, self-test."""

from __future__ import annotations

from stribeck.export.c.files import c_files
from stribeck.export.c.number import FORMATS, Format, Precision

__all__ = ["FORMATS", "Format", "Precision", "c_files"]
