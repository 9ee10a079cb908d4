"""Sentences and units as a page sets them."""

from __future__ import annotations

import re

from markupsafe import Markup, escape

from stribeck.report.numbers import MINUS

SPACE = "\N{NO-BREAK SPACE}"
#: One part of a unit: ``m``, ``rad/s2``, ``s/rad``; the catalog writes T for a torque or a force,
#: and X for an angle or a length.
_PART = r"(?:%|degC|rad|deg|kg|Hz|mm|ms|[NmsAVWJKTX])[23]?(?:/(?:rad|deg|kg|[NmsAVKX])[23]?)?"
_UNIT = rf"{_PART}(?: {_PART})*"
_AFTER_NUMBER = re.compile(rf"(?<=\d) {_UNIT}(?![\w/])")
_ALONE = re.compile(_UNIT)
_POWER = re.compile(r"(?<=[A-Za-z])[23]")
_NEGATIVE = re.compile(r"(?:(?<=[\s(])|^)-(?=\d)")
#: Spaces at which no line breaks: of thousands, after a sign of comparison, and within N m.
_TOGETHER = re.compile(r"(?<=\d) (?=\d{3}(?!\d))|(?<=[<>≤≥±]) (?=\d)|(?<=\bN) (?=m\b)")
_BETWEEN_NUMBERS = re.compile(r"(?<=\d) → (?=\d)")


def prose(text: str) -> Markup:
    """A sentence with minus signs, numbers kept whole and with their units, and code as code.

    Examples
    --------
    >>> prose("from -3.3 rad; see `stribeck robot` if a < b") == (
    ...     "from \N{MINUS SIGN}3.3\N{NO-BREAK SPACE}rad; see <code>stribeck robot</code> "
    ...     "if a &lt; b")
    True
    """
    pieces = text.split("`")
    if len(pieces) % 2 == 0:
        return escape(_set(text))
    made = [
        Markup("<code>{}</code>").format(piece) if k % 2 else escape(_set(piece))
        for k, piece in enumerate(pieces)
    ]
    return Markup("").join(made)


def unit(text: str) -> str:
    """A unit that stands alone, with its powers; any other text as it is.

    Examples
    --------
    >>> unit("rad/s2"), unit("T s2/X2"), unit("a2")
    ('rad/s²', 'T s²/X²', 'a2')
    """
    return _powers(text) if _ALONE.fullmatch(text) else text


def _set(text: str) -> str:
    text = _NEGATIVE.sub(MINUS, text)
    text = _TOGETHER.sub(SPACE, text)
    text = _BETWEEN_NUMBERS.sub(f"{SPACE}→{SPACE}", text)
    return _AFTER_NUMBER.sub(lambda found: _powers(found[0]).replace(" ", SPACE), text)


def _powers(text: str) -> str:
    raised = _POWER.sub(lambda found: "²" if found[0] == "2" else "³", text)
    # As on the axes of figures; in commands and files it is degC.
    return raised.replace("degC", "°C")
