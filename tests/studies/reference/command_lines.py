"""MkDocs: options in commands are not broken after a dash."""

from __future__ import annotations

import re

_COMMANDS = re.compile(r'<div class="language-console highlight">.*?</div>', re.DOTALL)
#: A tag; or an option, with its value where both are short, and any other short word with a dash.
_OPTION = re.compile(
    r"(<[^>]*>)|(?<=\s)(?:--?\w[\w-]*(?: [\w./:=+{},]{1,14}(?![^\s<]))?"
    r"|(?=\S{1,30}(?:\s|<))[^\s<>]+-[^\s<>]*)"
)


def on_page_content(html: str, **_: object) -> str:
    """Set each option as one word, which `docs/style.css` keeps whole."""
    return _COMMANDS.sub(
        lambda block: _OPTION.sub(
            lambda found: found[1] or f'<span class="whole">{found[0]}</span>', block[0]
        ),
        html,
    )
