"""Number literals in C."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.exporters.precision import Precision


@dataclass(frozen=True)
class Format:
    """A floating-point format, for the templates.

    Attributes
    ----------
    real, word
        The type, and the unsigned integer of the same size.
    bits, stored
        Its size, and the stored bits of its significand.
    suffix
        Of literals.

    Examples
    --------
    >>> FORMATS["f32"].literal(0.1)
    '0.1F'
    """

    real: str
    word: str
    bits: int
    stored: int
    suffix: str

    @property
    def bias(self) -> int:
        """The exponent field of 1."""
        return (1 << (self.bits - self.stored - 2)) - 1

    @property
    def single(self) -> bool:
        """Whether it is single precision."""
        return self.bits == 32

    def literal(self, x: float) -> str:
        """A finite number with the fewest digits that read back with the same bits."""
        text = str(np.float32(x)) if self.single else repr(float(x))
        if not any(mark in text for mark in ".e"):
            text += ".0"
        return f"({text}{self.suffix})" if text.startswith("-") else f"{text}{self.suffix}"

    def integer(self, x: int) -> str:
        """An unsigned integer of the format's size."""
        return f"UINT{self.bits}_C({x})"

    def hexadecimal(self, x: int) -> str:
        """The same in hexadecimal."""
        return f"UINT{self.bits}_C({x:#x})"


FORMATS: dict[Precision, Format] = {
    "f64": Format(real="double", word="uint64_t", bits=64, stored=52, suffix=""),
    "f32": Format(real="float", word="uint32_t", bits=32, stored=23, suffix="F"),
}
