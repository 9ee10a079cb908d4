"""Operations on numbers that a kernel carries out, read from the machine code that ran.

Each instruction has been counted by its address, and the disassembly says what stands there: so
elementary functions, shared expressions and what the compiler has left out are counted as they are.
"""

from __future__ import annotations

import re
import subprocess
from collections import Counter
from functools import cache
from pathlib import Path

import callgrind

#: Kinds of operations and the instructions that carry them out; comparisons go through the adders.
KINDS = {
    "add": r"add|sub|addsub|hadd|hsub|min|max|cmp[a-z_]*|u?comi|fn?m(?:add|sub)\d+",
    "multiply": r"mul|fn?m(?:add|sub)\d+",
    "divide": r"div",
    "square root": r"sqrt",
}
PATTERNS = {kind: re.compile(rf"v?(?:{names})(p|s)(s|d)") for kind, names in KINDS.items()}
LINE = re.compile(r"^\s*([0-9a-f]+):\t(\S+)(.*)$")
#: Bytes of a register by the first letter of its name.
WIDTHS = {"x": 16, "y": 32, "z": 64}


def of(program: Path, kernel: str) -> Counter[str]:
    """How many operations of each kind one run takes, lane by lane."""
    found: Counter[str] = Counter()
    carried_out = _arithmetic(program)
    for address, count in callgrind.by_address(program, kernel).items():
        for kind, lanes in carried_out.get(address, ()):
            found[kind] += lanes * count
    return found


@cache
def _arithmetic(program: Path) -> dict[int, list[tuple[str, int]]]:
    """Kind and lanes of each instruction that computes with numbers, by its address."""
    listing = subprocess.check_output(
        ["objdump", "--disassemble", "--no-show-raw-insn", program], text=True
    )
    found: dict[int, list[tuple[str, int]]] = {}
    for address, name, operands in filter(None, map(_parts, listing.splitlines())):
        for kind, pattern in PATTERNS.items():
            match = pattern.fullmatch(name)
            if match:
                packed, size = match.groups()
                found.setdefault(address, []).append((kind, _lanes(packed, size, operands)))
    return found


def _parts(line: str) -> tuple[int, str, str] | None:
    match = LINE.match(line)
    return (int(match[1], 16), match[2], match[3]) if match else None


def _lanes(packed: str, size: str, operands: str) -> int:
    """Numbers that an instruction works on at once."""
    if packed == "s":
        return 1
    width = max(WIDTHS[letter] for letter in re.findall(r"%([xyz])mm", operands))
    return width // (8 if size == "d" else 4)
