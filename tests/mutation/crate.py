"""Changes of the Rust crate: all of them in one build, chosen when a test starts.

cargo-mutants lists the changes. It would build the crate once for each, which takes minutes. Here
the body of a changed function becomes a `match` over the number of the change, which the tests
read from an environment variable.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import limited
from mutant import Mutant, Sample, copy_of_the_sources

#: Programs of tests, and which of their tests: those of all areas, the quickest first ...
QUICK = (("golden", ""), ("model", ""), ("passivity_factor", ""), ("effects_with_a_state", ""),
         ("dynamics", ""))  # fmt: skip
#: ... then the slower ones of each area.
TESTS: dict[str, tuple[tuple[str, str], ...]] = {
    "passivity": (("stribeck", "passivity"), ("passivity", "")),
    "scalar": (("stribeck", "passivity"), ("gradient", "")),
    "law": (("gradient", ""), ("stribeck", "dynamics"), ("passivity", "")),
    "dynamics": (("stribeck", "dynamics"), ("gradient", ""), ("passivity", "")),
}
#: So many times as many changes are built as are tested: not every change compiles.
SPARE = 1.6
VARIABLE = "STRIBECK_MUTANT"
#: Processor time after which a test hangs, s; the longest takes a tenth of it.
LONGEST = 90
CHOSEN = f"""
pub(crate) mod mutant {{
    pub(crate) fn chosen() -> u32 {{
        static CHOSEN: std::sync::OnceLock<u32> = std::sync::OnceLock::new();
        *CHOSEN.get_or_init(|| {{
            std::env::var("{VARIABLE}").ok().and_then(|text| text.parse().ok()).unwrap_or(0)
        }})
    }}
}}
"""
HEAD_OF_FUNCTION = re.compile(r"^\s*(pub(\([^)]*\))?\s+)?(const\s+)?(unsafe\s+)?fn\s", re.MULTILINE)


@dataclass(frozen=True)
class Edit:
    """A change, as places in the text of its file: the function, its body and what is replaced."""

    mutant: Mutant
    body: int
    end: int
    start: int
    stop: int
    replacement: str


def listed(area: str, folder: Path) -> list[Edit]:
    """All changes of an area, except in `const` functions, which cannot choose."""
    command = ["cargo", "mutants", "--list", "--json", f"--file=src/{area}.rs",
               f"--file=src/{area}/**/*.rs"]  # fmt: skip
    text = subprocess.run(command, cwd=folder, capture_output=True, check=True, text=True).stdout
    edits = (_edit(item, area, folder) for item in json.loads(text) if item["function"])
    return [edit for edit in edits if edit is not None]


def _edit(item: dict, area: str, folder: Path) -> Edit | None:
    text = (folder / item["file"]).read_text(encoding="utf-8")
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def place(point: dict) -> int:
        return starts[point["line"] - 1] + point["column"] - 1

    function, span = item["function"]["span"], item["span"]
    first, end = place(function["start"]), place(function["end"])
    head = HEAD_OF_FUNCTION.search(text, first, end)
    if head is None or head.group(3):
        return None
    start, stop = place(span["start"]), place(span["end"])
    left = text.rfind("\n", 0, start) + 1
    right = text.find("\n", stop)
    before = " ".join(text[left:right].split())
    after = " ".join((text[left:start] + item["replacement"] + text[stop:right]).split())
    mutant = Mutant(area, item["file"], span["start"]["line"], before, after)
    return Edit(mutant, text.index("{", head.end()), end, start, stop, item["replacement"])


def drawn(sample: Sample, areas: Sequence[str], folder: Path) -> dict[int, Edit]:
    """Random changes of each area, as many as are built, numbered from 1."""
    edits: list[Edit] = []
    for area in areas:
        by_mutant = {edit.mutant: edit for edit in listed(area, folder)}
        edits += [by_mutant[m] for m in sample.of(list(by_mutant), SPARE)]
    return dict(enumerate(edits, 1))


def write(
    edits: dict[int, Edit], originals: Path, folder: Path
) -> dict[tuple[str, int], list[int]]:
    """Write the changed files; give the changes that each of their lines belongs to."""
    by_file: dict[str, dict[tuple[int, int], list[int]]] = defaultdict(lambda: defaultdict(list))
    for number, edit in edits.items():
        by_file[edit.mutant.file][edit.body, edit.end].append(number)
    owners: dict[tuple[str, int], list[int]] = {}
    for file, functions in by_file.items():
        text = (originals / file).read_text(encoding="utf-8")
        pieces: list[tuple[str, list[int]]] = []
        at = 0
        for (body, end), numbers in sorted(functions.items()):
            if body < at:  # a function inside another one that changes
                continue
            pieces.append((text[at:body] + "{ match crate::mutant::chosen() {\n", []))
            for number in numbers:
                e = edits[number]
                changed = text[body : e.start] + e.replacement + text[e.stop : end]
                pieces.append((f"{number}u32 => {changed}\n", [number]))
            pieces.append((f"_ => {text[body:end]}\n", numbers))
            pieces.append(("}}", []))
            at = end
        pieces.append((text[at:], []))
        line = 1
        for piece, numbers in pieces:
            for _ in range(piece.count("\n")):
                owners[file, line] = numbers
                line += 1
        (folder / file).write_text("".join(p for p, _ in pieces), encoding="utf-8")
    return owners


def build(edits: dict[int, Edit], originals: Path, folder: Path) -> set[int]:
    """Write the changes that compile together; give the numbers of the others."""
    root = folder / "src/lib.rs"
    root.write_text((originals / "src/lib.rs").read_text(encoding="utf-8") + CHOSEN)
    refused: set[int] = set()
    while True:
        kept = {n: e for n, e in edits.items() if n not in refused}
        for file in {e.mutant.file for e in edits.values()}:
            (folder / file).write_text((originals / file).read_text(encoding="utf-8"))
        owners = write(kept, originals, folder)
        done = _cargo(folder, "check", "--lib")
        wrong = set(_refused(done, owners))
        if not wrong and done.returncode != 0:
            raise SystemExit(done.stdout[-4000:] + done.stderr[-4000:])
        if not wrong:
            return refused | (set(kept) - {n for found in owners.values() for n in found})
        refused |= wrong


def _refused(
    done: subprocess.CompletedProcess[str], owners: dict[tuple[str, int], list[int]]
) -> Iterator[int]:
    for line in done.stdout.splitlines():
        message = json.loads(line).get("message") or {}
        if message.get("level") == "error":
            # Of two arms of different types, the primary place is the wrong one.
            places = sorted(message["spans"], key=lambda span: not span["is_primary"])
            found = (owners.get((span["file_name"], span["line_start"])) for span in places)
            yield from next(filter(None, found), [])


def _cargo(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Cargo with messages as JSON, without debug information and with a little optimisation."""
    quick = {
        "CARGO_TARGET_DIR": str(folder.parent / "target"),
        "CARGO_PROFILE_DEV_OPT_LEVEL": "1",
        "CARGO_PROFILE_DEV_DEBUG": "0",
        "CARGO_PROFILE_TEST_DEBUG": "0",
    }
    return subprocess.run(
        ["cargo", *words, "--message-format=json"],
        cwd=folder, env={**os.environ, **quick}, capture_output=True, check=False, text=True,
    )  # fmt: skip


def programs(folder: Path) -> dict[str, str]:
    """Paths of the test programs by their names."""
    names = {name for suites in (QUICK, *TESTS.values()) for name, _ in suites} - {"stribeck"}
    done = _cargo(folder, "test", "--no-run", "--lib", *(f"--test={name}" for name in names))
    if done.returncode != 0:
        raise SystemExit(done.stdout[-4000:] + done.stderr[-4000:])
    messages = map(json.loads, done.stdout.splitlines())
    return {m["target"]["name"]: m["executable"] for m in messages if m.get("executable")}


def test(sample: Sample, areas: Sequence[str]) -> dict[Mutant, str]:
    """What the tests make of each change that compiles: "caught" or "survived"."""
    originals, folder = copy_of_the_sources("crate"), copy_of_the_sources("crate-mutated")
    edits = drawn(sample, areas, originals)
    print(f"{len(edits)} changes of the crate; building them all at once", flush=True)
    refused = build(edits, originals, folder)
    print(f"{len(refused)} do not compile", flush=True)
    built = programs(folder)
    results: dict[Mutant, str] = {}
    for area in areas:
        suites = [[built[name], *filter(None, [only])] for name, only in (*QUICK, *TESTS[area])]
        # Without a change everything must pass; otherwise the figures mean nothing.
        for suite in suites:
            done = limited.run(suite, folder, LONGEST, {VARIABLE: "0"})
            if done.returncode != 0:
                raise SystemExit(f"fails without a change: {suite[0]}\n{done.stdout[-3000:]}")
        of_area = [n for n, e in edits.items() if e.mutant.area == area]
        compiled = [n for n in of_area if n not in refused]
        for number in compiled[: round(len(of_area) / SPARE)]:
            passed = (limited.run(s, folder, LONGEST, {VARIABLE: str(number)}) for s in suites)
            survived = all(done.returncode == 0 for done in passed)
            mutant = edits[number].mutant
            results[mutant] = "survived" if survived else "caught"
            print(f"{results[mutant]:<9} {area:<10} {mutant}", flush=True)
    return results
