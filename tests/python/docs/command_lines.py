"""The command lines of README.md and docs/, and those of them that no test runs."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]

#: Beginnings of the lines that are not run, each with its reason.
NOT_RUN = {
    "python3 develop.py": "tasks of a checkout, among them this test",
    ".venv/bin/python": "tests, which run on their own",
    "cargo test": "tests, which run on their own",
    "pip install": "installs from the network",
    "jupyter": "waits for clicks; tests/python/tutorials runs the notebooks",
    "stribeck completion": "writes into the home; tests/python/cli/test_terminal.py",
    'eval "$(stribeck completion': "is for a shell; tests/python/cli/test_terminal.py",
    "stribeck demo": "tests/python/cli/test_demo.py compares the README with it",
    "stribeck app": "waits for clicks; tests/python/report/workbench makes them",
    "stribeck robot": "needs recordings of a whole robot; tests/python/robot has them",
    "stribeck benchmark": "takes minutes to hours; tests/python/benchmark",
    "python tests/studies": "reads answers of the benchmark; tests/python/benchmark",
    "stribeck improve ../shared": "needs ../shared; tests/real/table.py, tests/python/same",
    "stribeck fit ../shared": "needs ../shared; tests/real/table.py, tests/python/same",
    'stribeck fleet "logs/*/*.parquet" --scheduler': "needs a cluster; tests/python/scale/fleet",
    "stribeck points": "needs recordings of benches; tests/python/fitting",
    "stribeck fit points.csv": "needs recordings of benches; tests/python/fitting",
    "stribeck inspect LOG.csv --map position=q_link": "needs two encoders; tests/python/fitting",
}


@dataclass(frozen=True)
class Line:
    """A command line of a page."""

    page: str
    text: str

    @property
    def words(self) -> list[str]:
        """The words, without a comment."""
        return shlex.split(self.text, comments=True)

    @property
    def reason(self) -> str | None:
        """Why it is not run; None where it is."""
        return next((why for head, why in NOT_RUN.items() if self.text.startswith(head)), None)


def lines() -> list[Line]:
    """The command lines of blocks marked ``console``, and those after a ``$`` in ``text``."""
    found = []
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))):
        text = path.read_text(encoding="utf-8").replace("\\\n", " ")
        for kind, block in re.findall(r"^```(console|text)\n(.*?)^```", text, re.M | re.S):
            prompted = "$ " in block
            for line in block.splitlines():
                if line.startswith("#"):
                    continue
                if line.startswith("$ ") or (kind == "console" and not prompted and line):
                    name = path.relative_to(ROOT).as_posix()
                    found.append(Line(name, line.removeprefix("$ ")))
    return found
