"""MkDocs: options in commands are not broken after a dash."""

from __future__ import annotations

import re

_COMMANDS = re.compile(r'<div class="language-console highlight">.*?</div>', re.DOTALL)
_OPTION = re.compile(r"(?<=\s)--?\w[\w-]*")


def on_page_content(html: str, **_: object) -> str:
    """Set each option as one word, which `docs/style.css` keeps whole."""
    return _COMMANDS.sub(
        lambda block: _OPTION.sub(r'<span class="option">\g<0></span>', block[0]), html
    )
