"""Numbers with as many digits as the data supports."""

from __future__ import annotations

import math

MINUS = "\N{MINUS SIGN}"
DASH = "\N{EN DASH}"
#: Digits where no standard error is known.
PLAIN_DIGITS = 4
#: The lowest confidence of what is possible; below it is unlikely.
POSSIBLE = 0.05


def minus_signs(text: str) -> str:
    """A formatted number as it is read: with minus signs in place of hyphens."""
    return text.replace("-", MINUS)


def plain(value: float, digits: int = 3) -> str:
    r"""`value` with significant digits; an exponent only for very small and very large values.

    Examples
    --------
    >>> plain(0.012345), plain(1234.5), plain(2.5e7), plain(8.0)
    ('0.0123', '1234', '2.5e+07', '8.00')
    >>> plain(-1.5) == "\N{MINUS SIGN}1.50"
    True
    """
    return minus_signs(typed(value, digits))


def typed(value: float, digits: int = 3) -> str:
    """`value` as `plain`, with the hyphen that programs read: for fields that take numbers.

    Examples
    --------
    >>> typed(-1.5), typed(2.5e-7)
    ('-1.50', '2.5e-07')
    """
    if not math.isfinite(value):
        return "unknown"
    if value == 0.0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if size < -4 or size > 6:
        return f"{value:.{digits}g}"
    return f"{value:.{max(digits - 1 - size, 0)}f}"


def with_error(value: float, error: float | None) -> tuple[str, str]:
    r"""`value` and its standard error, both ending at the error's second digit.

    Examples
    --------
    >>> with_error(8.01234, 0.0223), with_error(1234.5, 87.0), with_error(0.25, None)
    (('8.012', '0.022'), ('1234', '87'), ('0.2500', ''))
    >>> with_error(28595.0, 11071.0), with_error(-0.0004, 0.12)
    (('29000', '11000'), ('0.00', '0.12'))
    >>> with_error(-3.1724, 0.0223)[0] == "\N{MINUS SIGN}3.172"
    True
    """
    if error is None or not math.isfinite(error):
        return plain(value, PLAIN_DIGITS), ""
    if error <= 0.0:
        return plain(value, PLAIN_DIGITS), "0"
    last = math.floor(math.log10(error)) - 1
    size = math.floor(math.log10(abs(value))) if value else last
    if min(size, last) < -7 or size > 6:
        digits = min(max(size - last, 0), 9)
        return minus_signs(f"{value:.{digits}e}"), minus_signs(f"{error:.1e}")
    return _rounded(value, last), _rounded(error, last)


def _rounded(value: float, last: int) -> str:
    """`value` with its last digit at this power of ten; zero has no sign."""
    return minus_signs(f"{round(value, -last) or 0.0:.{max(-last, 0)}f}")


def unit_text(unit: str) -> str:
    """A unit, or a dash for a pure number: a lone 1 reads like a value."""
    return DASH if unit == "1" else unit


def signed(value: float, beside: float) -> str:
    """`value` with its sign and as many decimals as `plain` shows of `beside`.

    Examples
    --------
    >>> signed(0.01234, 0.0456), signed(0.00001, 0.0456)
    ('+0.0123', '0.0000')
    """
    shown = plain(beside)
    decimals = 9 if "e" in shown else len(shown.partition(".")[2])
    text = f"{abs(value):.{decimals}f}"
    return ("+" if value > 0 else MINUS) + text if text.strip("0.") else text


def percent(share: float) -> str:
    """A share as a percentage with two digits; 100 % and 0 % only where they are exact.

    Examples
    --------
    >>> percent(0.4712), percent(0.9999), percent(0.0312), percent(1.0)
    ('47 %', '> 99 %', '3.1 %', '100 %')
    """
    value = 100.0 * share
    if not math.isfinite(value):
        return "unknown"
    if 99.5 <= value < 100.0:
        return "> 99 %"
    if abs(value) >= 10.0 or value == 0.0:
        return f"{value:.0f} %"
    return "< 0.1 %" if 0.0 < value < 0.1 else f"{value:.1f} %"


def confidence_words(confidence: float) -> str:
    """A confidence (0..1) in words and as a number; the words are those of the number as printed.

    Examples
    --------
    >>> confidence_words(0.998), confidence_words(0.5)
    ('practically certain (confidence > 0.99)', 'as likely as not (confidence 0.50)')
    """
    levels = {
        0.99: "practically certain",
        0.95: "very likely",
        0.8: "likely",
        0.55: "probable",
        0.45: "as likely as not",
        POSSIBLE: "possible",
    }
    shown = round(confidence, 2)
    words = next((said for least, said in levels.items() if shown >= least), "unlikely")
    return f"{words} (confidence {confidence_text(confidence)})"


def hedge(confidence: float) -> str:
    """The word that a claim of this confidence needs before it; empty for a sure one.

    Examples
    --------
    >>> hedge(0.98), hedge(0.9), hedge(0.3)
    ('', 'probably', 'perhaps')
    """
    shown = round(confidence, 2)
    if shown >= 0.95:
        return ""
    return "probably" if shown >= 0.55 else "perhaps"


def confidence_text(confidence: float) -> str:
    """A confidence (0..1) with two digits; never rounded to 0 or 1.

    Examples
    --------
    >>> confidence_text(0.998), confidence_text(0.5), confidence_text(1e-9)
    ('> 0.99', '0.50', '< 0.01')
    """
    if confidence > 0.99:
        return "> 0.99"
    return f"{confidence:.2f}" if confidence >= 0.01 else "< 0.01"


def change_text(before: float, after: float) -> str:
    """The relative change of a number in per cent, with its sign.

    Examples
    --------
    >>> change_text(5.0, 5.5), change_text(5.0, 5.001), change_text(5.0, 5.0)
    ('+10 %', '< +0.1 %', '0 %')
    >>> change_text(5.0, 4.999) == f"> {MINUS}0.1 %", change_text(5.0, 0.01) == f"< {MINUS}99 %"
    (True, True)
    """
    if not before:
        return ""
    size, fell = percent(abs(1.0 - after / before)), after < before
    if size[0] in "<>":
        # An inequality of a fall turns with its sign.
        way = {"<": ">", ">": "<"}[size[0]] if fell else size[0]
        return f"{way} {MINUS if fell else '+'}{size[2:]}"
    return size if after == before else f"{MINUS if fell else '+'}{size}"


def thousands(count: int) -> str:
    """A count with a space every three digits.

    Examples
    --------
    >>> thousands(1234567), thousands(12)
    ('1 234 567', '12')
    """
    return f"{count:,}".replace(",", " ")


def listed(words: list[str] | tuple[str, ...], last: str = "and") -> str:
    """``a, b and c``."""
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} {last} {words[-1]}"
