"""MkDocs: numbers stay with their units, names are not broken, and pictures open in full size."""

from __future__ import annotations

import re
from html import escape, unescape

from stribeck.report.pages.prose import SPACE, prose, unit

#: What is not text: code, formulas, drawings, and every tag.
_NOT_TEXT = re.compile(
    r"(<(pre|code|math|svg|script|style)\b.*?</\2>|<!--.*?-->|<[^>]*>)", re.DOTALL
)
_CODE = re.compile(r"<code>([^<]*)</code>")
_PICTURE = re.compile(r'<p>(<img [^>]*?src="([^"]+)"[^>]*>)</p>')
_LINKED = re.compile(r"<p>(?=<a [^>]*><img [^>]*></a></p>)")
_CELL = re.compile(r"<td>(.*?)</td>", re.DOTALL)
_TAG = re.compile(r"<[^>]*>")
_COMMENT = re.compile(r'(^|<code>)<span class="gp"># </span>(.*)$', re.MULTILINE)
_CONSOLE = re.compile(r'<div class="language-console highlight">.*?</div>', re.DOTALL)

_UNIT = (
    r"(?:[kMG]?Hz|[kMG]i?B|KB|[µun]s|min|h|MN m/rad|mN|mrad|mA|[kMG]W|°C|°|x|\u00d7|bytes|samples|"
    "rows)"
)
_AFTER_NUMBER = re.compile(rf"(?<=\d) (?={_UNIT}(?![\w/]))")
_NEWTON_METRES = re.compile(r"(?<=\bN) (?=m\b)|(?<=\bN.m) (?=s(?![a-z]))")
_POWER = re.compile(r"(?:(?<=kg.m)|(?<=/s)|(?<=/rad)|(?<=N.m.s))2(?!\w)")
_DEGREES = re.compile(r"(?<!\w)degC(?!\w)")
_PER_CENT = re.compile(r"(?<=\d)%")
_THOUSANDS = re.compile(r"(?<=\d) (?=\d{3}(?!\d))")
_SIGN = re.compile(r" ([=≤≥<>±\u00d7·+\u2212/][ \u00a0])(?=\S)")
_AFTER_SIGN = re.compile(
    r"(?<=[±\u00d7·]) (?=\S)|(?<=[=≤≥<>+\u2212/]) (?=[\w\u2212(]{1,7}(?:[\s),.;:]|$))"
)
#: A word with a hyphen and a digit: AVX-512, Cortex-M4F, 8-14.
_PART_NUMBER = re.compile(r"(?<![\w-])(?=[\w.-]*\d)\w+(?:-[\w.]*\w)+\*?")
#: Code up to so many characters is one word; a cell up to so many is not broken, and a cell with
#: more than so many is prose.
WORD, SHORT, PROSE = 30, 18, 40


def on_page_content(html: str, **_: object) -> str:
    """Set the text of a page, and mark what `docs/style.css` keeps whole."""
    html = _PICTURE.sub(r'<p class="picture"><a href="\2">\1</a></p>', html)
    html = _LINKED.sub('<p class="picture">', html)
    html = _CONSOLE.sub(lambda block: _COMMENT.sub(_comment, block[0]), html)
    html = _CELL.sub(_cell, html)
    pieces = _NOT_TEXT.split(html)
    # Of each three pieces the first is text, the second what is not, the third its name.
    made = []
    for text, other in zip(pieces[::3], [*pieces[1::3], ""], strict=True):
        made += [_text(text), _CODE.sub(_code, other) if other.startswith("<code>") else other]
    return "".join(made)


def _comment(line: re.Match[str]) -> str:
    return f'{line[1]}<span class="c1"># {_TAG.sub("", line[2])}</span>'


def _cell(cell: re.Match[str]) -> str:
    said = unescape(_TAG.sub("", cell[1]))
    if unit(said) != said:
        return f'<td class="whole">{unit(said)}</td>'
    kind = "prose" if len(said) > PROSE else "whole" if len(said) <= SHORT else ""
    return f'<td class="{kind}">{cell[1]}</td>' if kind and said else cell[0]


def _code(code: re.Match[str]) -> str:
    said = unescape(code[1])
    if len(said) <= WORD and " " not in said:
        return f'<code class="whole">{code[1]}</code>'
    words = [
        f'<span class="whole">{word}</span>' if len(word) <= WORD and "-" in word else word
        for word in code[1].split(" ")
    ]
    return f"<code>{' '.join(words).replace('|', '|<wbr>')}</code>"


def _text(text: str) -> str:
    if not text.strip():
        return text
    said = unescape(prose(_PER_CENT.sub(" %", unescape(text))))
    said = _DEGREES.sub("°C", _POWER.sub("²", said))
    for pattern in (_AFTER_NUMBER, _NEWTON_METRES, _THOUSANDS, _AFTER_SIGN):
        said = pattern.sub(SPACE, said)
    said = _SIGN.sub(rf"{SPACE}\1", said)
    return _PART_NUMBER.sub(r'<span class="whole">\g<0></span>', escape(said, quote=False))
