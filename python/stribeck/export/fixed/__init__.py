"""C in fixed point, with a bound of the error over the operating box."""

from __future__ import annotations

from stribeck.export.fixed.files import FIXED, FixedPrecision, analyse, fixed_files

__all__ = ["FIXED", "FixedPrecision", "analyse", "fixed_files"]
