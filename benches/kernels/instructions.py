"""Count the instructions of each kernel, and hold them against the table that is kept.

python benches/kernels/instructions.py           # 1 where a kernel takes more than the table says
python benches/kernels/instructions.py --write   # keep the counts in table.md

Unlike times, counts are the same whatever else the machine does.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import callgrind
import program

TABLE = Path(__file__).resolve().parent / "table.md"
HEADER = """\
Instructions of one run on x86_64 with AVX2, which valgrind emulates, built by {compiler}; those
of the C library, which clears and copies memory, are not counted.

| kernel | rows | instructions | a row |
|---|---|---|---|
"""
#: More than this above the table is a regression.
MARGIN = 0.05


def compiler() -> str:
    """Name and version of what builds the kernels."""
    return subprocess.check_output(["rustc", "--version"], text=True).split(" (")[0]


def text(counts: dict[str, int], rows: dict[str, int]) -> str:
    """The table."""
    lines = (
        f"| {kernel} | {rows[kernel]} | {count} | {count / rows[kernel]:.1f} |\n"
        for kernel, count in counts.items()
    )
    return HEADER.format(compiler=compiler()) + "".join(lines)


def kept() -> dict[str, int]:
    """The counts of the table that is kept."""
    found = re.findall(r"^\| (.+?) \| \d+ \| (\d+) \|", TABLE.read_text(), re.MULTILINE)
    return {kernel: int(count) for kernel, count in found}


def worse(counts: dict[str, int], before: dict[str, int]) -> list[str]:
    """One sentence for each kernel that takes too many, or of which nothing is known."""
    unknown = [f"{kernel} is not in {TABLE.name}" for kernel in counts if kernel not in before]
    gone = [f"{kernel} is in {TABLE.name} alone" for kernel in before if kernel not in counts]
    grown = [
        f"{kernel} takes {now} instructions, "
        f"{now / before[kernel] - 1.0:.1%} more than in {TABLE.name}"
        for kernel, now in counts.items()
        if kernel in before and now > before[kernel] * (1.0 + MARGIN)
    ]
    return unknown + gone + grown


def main() -> int:
    """Count, print, compare; 0, or 1 with a sentence for everything that is wrong."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true", help="keep the counts in table.md")
    said = parser.parse_args()
    try:
        callgrind.install()
    except callgrind.Unavailable as reason:
        print(f"skipped: the instructions of the kernels, because {reason}")
        return 0
    path, rows = program.build(), program.kernels()
    with ThreadPoolExecutor(2) as pool:
        executed = pool.map(lambda kernel: callgrind.by_address(path, kernel), rows)
        counts = {kernel: each.total() for kernel, each in zip(rows, executed, strict=True)}
    print(text(counts, rows), end="")
    if said.write:
        TABLE.write_text(text(counts, rows))
    wrong = worse(counts, kept())
    for sentence in wrong:
        print(f"wrong: {sentence}", file=sys.stderr)
    if wrong and f"built by {compiler()};" not in TABLE.read_text():
        print(f"{TABLE.name} is of another compiler than {compiler()}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
