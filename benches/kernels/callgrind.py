"""Instructions that a kernel takes, counted by valgrind on the processor that it emulates.

That has AVX2 and nothing wider, wherever it runs, so that the counts are the same on every machine
with AVX2 that builds with the same compiler.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

PROCESSOR_FLAGS = Path("/proc/cpuinfo")


class Unavailable(Exception):
    """Why nothing can be counted on this machine, in one sentence."""


def install() -> None:
    """Install valgrind where it is missing; Unavailable where that cannot be."""
    if platform.machine() != "x86_64" or not PROCESSOR_FLAGS.exists():
        raise Unavailable("they are those of Linux on x86_64, which this is not")
    if "avx2" not in PROCESSOR_FLAGS.read_text().split():
        raise Unavailable("they are those of AVX2, which this processor does not have")
    if shutil.which("valgrind") is not None:
        return
    if shutil.which("apt-get") is None or os.geteuid() != 0:
        raise Unavailable("valgrind is missing and apt-get cannot install it here")
    # A mirror that does not answer would be waited for.
    apt = ["timeout", "600", "apt-get", "--yes", "--quiet"]
    install = [*apt, "install", "--no-install-recommends", "valgrind", "libc6-dbg"]
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for commands in ([install], [[*apt, "update"], install]):
        for command in commands:
            subprocess.run(
                command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, check=False
            )
        if shutil.which("valgrind") is not None:
            return
    raise Unavailable("apt-get could not install valgrind")


def by_address(program: Path, kernel: str) -> Counter[int]:
    """How often each instruction of a program is executed in one run of a kernel, by its address.

    Not those of the C library: how it copies and clears memory depends on where that lies.
    """
    with TemporaryDirectory() as folder:
        report = Path(folder) / "callgrind.out"
        command: list[str | Path] = [
            *("valgrind", "--tool=callgrind", f"--callgrind-out-file={report}"),
            *("--dump-instr=yes", "--compress-pos=no", "--compress-strings=no"),
            *("--collect-atstart=no", "--toggle-collect=*measured_run*"),
            *(program, "run", kernel),
        ]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{kernel} under valgrind: {done.stderr}")
        return _executed(report.read_text(), program)


def _executed(report: str, program: Path) -> Counter[int]:
    """The lines of a report that are an instruction's own: `address line count`."""
    executed: Counter[int] = Counter()
    own = called = False
    for line in report.splitlines():
        if line.startswith("ob="):
            own = line == f"ob={program}"
        elif line.startswith("calls="):
            called = True  # the next line is what was called, which has lines of its own
        elif line.startswith("0x"):
            if own and not called:
                address, _, count = line.split()
                executed[int(address, 16)] += int(count)
            called = False
    return executed
