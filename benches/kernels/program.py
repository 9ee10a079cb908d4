"""The program that runs the kernels: built, and asked."""

from __future__ import annotations

import json
import subprocess
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@cache
def build() -> Path:
    """The program, built as a release is."""
    command = [
        "cargo",
        "build",
        "--release",
        "--locked",
        "--quiet",
        "--package",
        "stribeck-kernels",
        "--message-format=json",
    ]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    messages = map(json.loads, done.stdout.splitlines())
    return Path(next(path for path in (m.get("executable") for m in messages) if path))


def kernels() -> dict[str, int]:
    """Rows that each kernel goes through, by its name."""
    return {name: int(rows) for name, rows in _said("list")}


def times() -> dict[str, float]:
    """Nanoseconds a row of each kernel: medians of interleaved runs."""
    return {name: float(time) for name, _, time in _said("time")}


def peaks() -> dict[str, float]:
    """Operations a nanosecond that the machine can do at most, by their kind."""
    return {name: float(rate) for name, rate in _said("peak")}


def _said(word: str) -> list[list[str]]:
    text = subprocess.check_output([build(), word], text=True)
    return [line.split("\t") for line in text.splitlines()]
