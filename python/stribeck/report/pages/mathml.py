"""Formulas of the catalog as MathML, which browsers set without a script or a font.

The catalog writes products side by side, ``a2 exp(-|v/a3|^a4)``, subscripts after an underscore or
as digits, several statements apart by commas or semicolons, and words between them.
"""

from __future__ import annotations

import re
from html import escape

#: Words that stand between formulas.
_WORDS = {
    *("for", "where", "each", "per", "direction", "between", "quadrant", "over", "a period"),
    *("sticking", "sliding", "then", "until", "while", "passes", "through", "else", "or", "and"),
    *("counts", "as", "the", "sign", "of", "since", "last", "changed", "its", "by", "signs"),
    *("in", "height", "what", "adds", "at", "is", "below", "above"),
}
_GREEK = {
    "pi": "&#x3c0;",
    "tau": "&#x3c4;",
    "alpha": "&#x3b1;",
    "delta": "&#x3b4;",
    "eta": "&#x3b7;",
    "eps": "&#x3b5;",
    "rho": "&#x3c1;",
    "th": "&#x3b8;",
    "sigma": "&#x3c3;",
    "zeta": "&#x3b6;",
}
#: Parameters whose symbols look like the differential of another.
_NO_DIFFERENTIALS = {"dc", "dv"}
_FUNCTIONS = {"exp", "tanh", "atan", "cbrt", "sqrt", "sgn", "cos", "sin", "abs", "sign", "log"}
_RELATIONS = {"=": "=", "<": "&lt;", ">": "&gt;", "<=": "≤", ">=": "≥"}
_TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+\.?\d*(?:e[+-]?\d+)?)|(?P<name>d2\(\w+\)/dt2|d[A-Za-z]\w*/dt|[A-Za-z]\w*)"
    r"|(?P<mark>\.\.\.?|\*\*|<=|>=|[-+*/^|()=<>:,;]))"
)


class _Unreadable(ValueError):
    """A text that is not a formula of the catalog's notation."""


def mathml(formula: str) -> list[str]:
    """Each statement of a formula as one ``<math>`` element.

    A statement that is not in the notation of the catalog is set as text; all text is escaped.

    Examples
    --------
    >>> mathml("x = v")
    ['<math displaystyle="true"><mi>x</mi><mo>=</mo><mi>v</mi></math>']
    """
    made = []
    for statement in _split(formula):
        made.append(f'<math displaystyle="true">{_statement(statement.strip())}</math>')
    return made


def _split(formula: str) -> list[str]:
    """The statements: apart by semicolons, or by commas outside of brackets before a name and =."""
    parts, depth, start = [], 0, 0
    for k, letter in enumerate(formula):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and (letter == ";" or (letter == "," and _begins(formula[k + 1 :]))):
            parts.append(formula[start:k])
            start = k + 1
    return [part for part in (*parts, formula[start:]) if part.strip()]


def _begins(rest: str) -> bool:
    """Whether a new statement begins here: ``name =``, or a changed part of the friction."""
    return (
        re.match(r"\s*(?:[A-Za-z]\w*(?:\([^)]*\))?\s*=|[DV] [-+(]|d\w+/dt\s*=)", rest) is not None
    )


def _statement(text: str) -> str:
    try:
        return _Parser(_tokens(text)).whole()
    except _Unreadable:
        return f"<mtext>{escape(text)}</mtext>"


def _tokens(text: str) -> list[str]:
    found, at = [], 0
    text = text.rstrip()
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise _Unreadable(text)
        found.append(match.group().strip())
        at = match.end()
    return found


class _Parser:
    """Recursive descent over the tokens of one statement; a quotient becomes a fraction."""

    def __init__(self, tokens: list[str]) -> None:
        self.tokens = tokens
        self.at = 0
        self.bars = 0

    @property
    def next(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self) -> str:
        token = self.next
        self.at += 1
        return token

    def whole(self) -> str:
        """Sums apart by relations, words and commas."""
        made = ""
        while self.next:
            token = self.next
            if token in _RELATIONS:
                made += f"<mo>{_RELATIONS[self.take()]}</mo>"
            elif token in (",", ":", "..", "..."):
                made += f'<mo separator="true">{self.take()}</mo>'
            elif token in _WORDS:
                made += f"<mtext>&#xa0;{escape(self.take())}&#xa0;</mtext>"
            else:
                made += self.sum()
        return made

    def sum(self) -> str:
        made = ""
        if self.next in ("+", "-"):
            made += _sign(self.take())
        made += self.product()
        while self.next in ("+", "-"):
            made += _sign(self.take()) + (_dots(self) or self.product())
        return made

    def product(self) -> str:
        """Factors side by side; what stands before a slash is the numerator."""
        factors = [self.power()]
        while True:
            if self.next == "/":
                self.take()
                top = factors[0] if len(factors) == 1 else f"<mrow>{_joined(factors)}</mrow>"
                factors = [f"<mfrac>{_bare(top)}{_bare(self.power())}</mfrac>"]
            elif self.next == "*":
                self.take()
                factors.append(self.power())
            elif self._is_factor():
                factors.append(self.power())
            else:
                return _joined(factors)

    def _is_factor(self) -> bool:
        token = self.next
        if token == "|":
            return self.bars == 0
        return bool(token) and (token == "(" or token[0].isalnum()) and token not in _WORDS

    def power(self) -> str:
        base = self.atom()
        if self.next in ("^", "**"):
            self.take()
            sign = "<mo>&#x2212;</mo>" if self.next == "-" and self.take() else ""
            exponent = _bare(self.atom())
            exponent = f"<mrow>{sign}{exponent}</mrow>" if sign else exponent
            return f"<msup>{base}{exponent}</msup>"
        return base

    def atom(self) -> str:
        token = self.take()
        if token == "(":
            inner, self.bars, outer = "", 0, self.bars
            inner = self.sum()
            self._expect(")")
            self.bars = outer
            return f"<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>"
        if token == "|":
            self.bars += 1
            inner = self.sum()
            self._expect("|")
            self.bars -= 1
            return f"<mrow><mo>|</mo>{inner}<mo>|</mo></mrow>"
        if token in _FUNCTIONS or token == "sum_j":
            return self._applied(token)
        if token and token[0].isdigit():
            return f"<mn>{token}</mn>"
        if token and token[0].isalpha() and token not in _WORDS:
            return _symbol(token)
        raise _Unreadable(token)

    def _applied(self, name: str) -> str:
        """A function with what it is applied to: brackets, or the next factor."""
        if name == "sum_j":
            return "<munder><mo>∑</mo><mi>j</mi></munder>"
        argument = self.power()
        if name == "sqrt":
            return f"<msqrt>{_bare(argument)}</msqrt>"
        if name == "cbrt":
            return f"<mroot>{_bare(argument)}<mn>3</mn></mroot>"
        if name == "abs":
            return f"<mrow><mo>|</mo>{_bare(argument)}<mo>|</mo></mrow>"
        gap = "" if argument.startswith("<mrow><mo>(") else '<mspace width="0.17em"/>'
        return f"<mrow><mi>{name}</mi><mo>&#x2061;</mo>{gap}{argument}</mrow>"

    def _expect(self, token: str) -> None:
        if self.take() != token:
            raise _Unreadable(token)


def _dots(parser: _Parser) -> str:
    """An ellipsis in the place of a term."""
    return "<mo>⋯</mo>" if parser.next == "..." and parser.take() else ""


def _sign(token: str) -> str:
    return "<mo>&#x2212;</mo>" if token == "-" else "<mo>+</mo>"


def _joined(factors: list[str]) -> str:
    made = factors[0]
    for factor in factors[1:]:
        applied = "<mo>&#x2061;</mo>" in factor[:40]
        made += ('<mspace width="0.17em"/>' if applied else "<mo>&#x2062;</mo>") + factor
    return made


def _bare(made: str) -> str:
    """What stands in a pair of brackets, where a fraction or a root makes them superfluous."""
    start, end = "<mrow><mo>(</mo>", "<mo>)</mo></mrow>"
    if made.startswith(start) and made.endswith(end):
        return f"<mrow>{made[len(start) : -len(end)]}</mrow>"
    return made


def _symbol(name: str) -> str:
    """A symbol with its subscript: ``a12``, ``Fc``, ``s2_plus``, ``dz``, ``dz/dt``."""
    if name.endswith("/dt2"):
        square = "<msup><mi>d</mi><mn>2</mn></msup>"
        below = "<mi>d</mi><msup><mi>t</mi><mn>2</mn></msup>"
        return f"<mfrac><mrow>{square}{_symbol(name[3:-5])}</mrow><mrow>{below}</mrow></mfrac>"
    if name.startswith("dF"):
        return f"<mrow><mi>&#x394;</mi>{_symbol(name[1:])}</mrow>"
    if name.endswith("/dt"):
        above = f"<mrow><mi>d</mi>{_symbol(name[1:-3])}</mrow>"
        return f"<mfrac>{above}<mrow><mi>d</mi><mi>t</mi></mrow></mfrac>"
    if re.fullmatch(r"d[a-z]\d?(_i)?", name) and name not in _NO_DIFFERENTIALS:
        return f"<mrow><mi>d</mi>{_symbol(name[1:])}</mrow>"
    head, _, below = name.partition("_")
    if head in _GREEK:
        return _with_below(f"<mi>{_GREEK[head]}</mi>", below)
    match = re.fullmatch(r"([A-Za-z])(\d*[A-Za-z]*\d*)", head)
    if match is None or (len(head) > 3 and head.isalpha() and not head.endswith("max")):
        return f"<mi>{escape(name)}</mi>"
    return _with_below(f"<mi>{match[1]}</mi>", ",".join(part for part in (match[2], below) if part))


def _with_below(base: str, below: str) -> str:
    if not below:
        return base
    kind = "mn" if below.isdigit() else "mi"
    return f"<msub>{base}<{kind}>{escape(below)}</{kind}></msub>"
