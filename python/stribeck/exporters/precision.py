"""Number formats of exported programs."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

__all__ = ["FIXED", "FLOATING", "FixedPrecision", "Precision"]

#: Floating point: double or single precision.
Precision: TypeAlias = Literal["f64", "f32"]
#: Fixed point: whole numbers of 32 or 16 bits.
FixedPrecision: TypeAlias = Literal["q31", "q15"]

FLOATING: tuple[Precision, ...] = get_args(Precision)
FIXED: tuple[FixedPrecision, ...] = get_args(FixedPrecision)
