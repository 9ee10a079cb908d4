"""What tests ask of a page that a browser shows."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

#: Folder in which screenshots are kept; none: they are not taken.
KEPT = os.environ.get("STRIBECK_ARTEFACTS")


def faults(page: Any) -> list[str]:
    """What axe finds that keeps people from using the page."""
    import axe_core_python

    if not page.evaluate("typeof window.axe !== 'undefined'"):
        # By the debugger: the policy of a page may admit no other script.
        script = Path(axe_core_python.__file__).parent / "axe.min.js"
        page.evaluate(script.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run({ resultTypes: ['violations'] })")
    return [
        f"{row['id']}: {row['nodes'][0]['html'][:200]}"
        for row in found["violations"]
        if row["impact"] in ("serious", "critical")
    ]


def wider(page: Any) -> list[str]:
    """That the page is wider than the window."""
    wide = page.evaluate("document.documentElement.scrollWidth - window.innerWidth")
    return [f"{wide} pixels wider than the window"] if wide > 0 else []


def keep(page: Any, name: str) -> None:
    """Keep a screenshot of the whole page."""
    if KEPT:
        Path(KEPT).mkdir(parents=True, exist_ok=True)
        page.screenshot(path=str(Path(KEPT) / name), full_page=True)
