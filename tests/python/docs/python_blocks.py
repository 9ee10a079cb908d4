"""The Python blocks of README.md and docs/, and those of them that no test runs."""

from __future__ import annotations

import re
from dataclasses import dataclass

from command_lines import ROOT

#: Pages whose blocks are not run, each with its reason.
NOT_RUN = {
    "docs/robots.md": "needs recordings of a whole robot; tests/python/robot has them",
}


@dataclass(frozen=True)
class Block:
    """A block of a page that is marked ``python``, and the line of the page that it begins at."""

    page: str
    line: int
    text: str


def blocks() -> list[Block]:
    """All blocks in the order of the pages."""
    found = []
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))):
        text = path.read_text(encoding="utf-8")
        name = path.relative_to(ROOT).as_posix()
        for match in re.finditer(r"^```python\n(.*?)^```", text, re.M | re.S):
            begins = text.count("\n", 0, match.start(1)) + 1
            found.append(Block(name, begins, match[1]))
    return found
