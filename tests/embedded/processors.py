"""Compare an identification on emulated processors with different vector units.

python tests/embedded/processors.py     # 1 where bits or digits differ more than is promised

Torque, gradient and triangular factors must have the same bits; what faer decomposes may differ by
`SHARE` of a standard error.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import debian

ROOT = Path(__file__).resolve().parents[2]
#: SSE4.2 alone; AVX2 and fused multiply-add.
PROCESSORS = ("Nehalem", "Haswell-noTSX")
EMULATOR = "qemu-x86_64"
#: Of a standard error.
SHARE = 1e-9


def missing() -> list[str]:
    """Programs that are not there."""
    return [name for name in ("cargo", EMULATOR) if shutil.which(name) is None]


def main() -> int:
    """Run everything; 0, or 1 with a sentence for everything that is wrong."""
    try:
        debian.install(("qemu-user",), missing)
    except debian.Unavailable as reason:
        print(f"skipped: the emulated processors, because {reason}")
        return 0
    build = ["cargo", "build", "--quiet", "--locked", "--release", "--features", "identify"]
    subprocess.run([*build, "--example", "processors"], cwd=ROOT, check=True)
    folder = subprocess.check_output(["cargo", "metadata", "--format-version=1", "--no-deps"])
    program = target_directory(folder.decode()) / "release" / "examples" / "processors"
    here = printed([str(program)])
    wrong = []
    for processor in PROCESSORS:
        there = printed([EMULATOR, "-cpu", processor, str(program)])
        differing, largest = compare(here, there)
        wrong += [f"{name} differs on {processor}" for name in differing]
        equal = sum(here[name] == there.get(name) for name in here)
        print(
            f"{processor}: {equal} of {len(here)} numbers with the same bits, the others within "
            f"{largest:.1g} standard errors"
        )
    for sentence in wrong:
        print(f"wrong: {sentence}", file=sys.stderr)
    return 1 if wrong else 0


def target_directory(metadata: str) -> Path:
    """Where cargo builds."""
    return Path(json.loads(metadata)["target_directory"])


def printed(command: list[str]) -> dict[str, list[str]]:
    """What a run prints: by kind and name of a number, the number and its standard error."""
    lines = subprocess.check_output(command, text=True).splitlines()
    return dict(named(line) for line in lines)


def named(line: str) -> tuple[str, list[str]]:
    """Kind and name of a line, and the numbers after them."""
    words = line.split()
    numbers = 1 if words[0] == "bits" else 2
    return " ".join(words[:-numbers]), words[-numbers:]


def compare(here: dict[str, list[str]], there: dict[str, list[str]]) -> tuple[list[str], float]:
    """Names of the numbers that differ too much, and the largest difference in standard errors."""
    differing = [name for name in here.keys() ^ there.keys()]
    largest = 0.0
    for name in here.keys() & there.keys():
        if name.startswith("bits"):
            differing += [name] if here[name] != there[name] else []
            continue
        (value, error), (other, _) = here[name], there[name]
        share = abs(float(value) - float(other)) / float(error)
        largest = max(largest, share)
        differing += [] if share <= SHARE else [name]
    return sorted(differing), largest


if __name__ == "__main__":
    sys.exit(main())
