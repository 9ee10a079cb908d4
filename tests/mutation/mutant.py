"""A change of the source, what the tests made of it, and the table of a run."""

from __future__ import annotations

import json
import random
import shutil
import subprocess
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import tomllib

ROOT = Path(__file__).resolve().parents[2]
#: Copies of the sources, what is built from them, and the results.
WORK = ROOT / "target" / "mutants"
#: Changes that alter no answer, by file and name; see the file itself.
EQUIVALENT = Path(__file__).with_name("equivalent.toml")
#: Share of the changes, without equivalent ones, that the tests must catch.
ENOUGH = 0.9


@dataclass(frozen=True)
class Mutant:
    """One change.

    Attributes
    ----------
    area : str
        Part of the sources, such as "scalar" or "covariance".
    file : str
        Path from the root of the project.
    line : int
        The first line that changes, from 1.
    before, after : str
        That line, without its indentation, before and after the change.
    """

    area: str
    file: str
    line: int
    before: str
    after: str

    @property
    def key(self) -> tuple[str, str, str]:
        """What identifies the change while other lines move."""
        return self.file, self.before, self.after

    def __str__(self) -> str:
        return f"{self.file}:{self.line}\n    - {self.before}\n    + {self.after}"


@dataclass(frozen=True)
class Sample:
    """Which part of the changes of each area is tested: a share, but at least `fewest`."""

    share: float
    fewest: int
    seed: int

    def of(self, mutants: Sequence[Mutant], spare: float = 1.0) -> list[Mutant]:
        """Random changes in an order that follows from the seed, `spare` times as many."""
        known = sorted(mutants, key=lambda m: (m.file, m.line, m.after))
        count = max(self.fewest, round(self.share * len(known)))
        return random.Random(self.seed).sample(known, min(len(known), round(spare * count)))


def copy_of_the_sources(name: str) -> Path:
    """The files that git knows, in a folder of their own: a mutant never touches the originals."""
    folder = WORK / name
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, text=True
    ).stdout
    for path in listed.split("\0")[:-1]:
        target = folder / path
        source = ROOT / path
        if not source.is_file():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        # An unchanged file keeps its time, so that cargo does not build it again.
        if not target.exists() or target.read_bytes() != source.read_bytes():
            shutil.copyfile(source, target)
    return folder


def report(results: dict[Mutant, str], language: str) -> bool:
    """Print the table and the survivors, keep the results as JSON; whether enough are caught.

    `results` has "caught" or "survived" of each change.
    """
    listed = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))["mutant"]
    equivalent = {(m["file"], m["before"], m["after"]) for m in listed}
    outcome = {
        m: "equivalent" if said == "survived" and m.key in equivalent else said
        for m, said in results.items()
    }
    path = WORK / f"{language}.json"
    path.write_text(json.dumps([{**asdict(m), "outcome": o} for m, o in outcome.items()], indent=1))
    print(f"\n{'area':<12} {'drawn':>7} {'caught':>7} {'equivalent':>11} {'survived':>9}  caught")
    for area in dict.fromkeys(m.area for m in outcome):
        count = Counter(o for m, o in outcome.items() if m.area == area)
        drawn = count["caught"] + count["equivalent"] + count["survived"]
        share = count["caught"] / max(1, count["caught"] + count["survived"])
        print(
            f"{area:<12} {drawn:>7} {count['caught']:>7} {count['equivalent']:>11} "
            f"{count['survived']:>9}  {share:6.0%}"
        )
    print(f"results in {path}")
    for mutant, said in outcome.items():
        if said == "survived":
            print(f"survived  {mutant}")
    caught = sum(o == "caught" for o in outcome.values())
    survived = sum(o == "survived" for o in outcome.values())
    return caught >= ENOUGH * (caught + survived)
