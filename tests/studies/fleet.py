"""A fleet of six robots over ten days, and what `stribeck fleet` says of it: the README's example.

One joint wears by 20 % in the last four days, another one has a Stribeck curve that its peers lack;
friction of all joints scatters by 2 % from day to day. Needs some minutes:

    python tests/studies/fleet.py [FOLDER]  # prints the answer, writes docs/fleet.png

Logs and results are kept in FOLDER, if one is given, and a second run goes on from there.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import stribeck as sb
from stribeck.base.files import save_figure
from stribeck.scale.fleet.changes import Question

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/python"), str(ROOT / "tests/python/scale/fleet")]


def main() -> None:
    if len(sys.argv) > 1:
        answer(Path(sys.argv[1]))
        return
    with tempfile.TemporaryDirectory() as folder:
        answer(Path(folder))


def answer(folder: Path) -> None:
    from fleet_logs import write_logs

    if not (folder / "logs").exists():
        write_logs(folder / "logs", robots=6, days=10, rows=1500)
    found = sb.fleet(
        [folder / "logs" / "*" / "*.parquet"],
        folder / "fleet",
        "improve",
        question=Question(window=4),
    )
    print(found)
    save_figure(found.plot(), ROOT / "docs" / "fleet.png")


if __name__ == "__main__":
    main()
