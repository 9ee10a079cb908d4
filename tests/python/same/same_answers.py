"""Run the listed commands, and bring what they answer into a form that can be compared.

`commands.toml` lists stories: commands that run one after the other in a folder of their own. What
a command leaves behind is its exit code, the JSON on stdout and every file it writes or changes.

Left out of the comparison: times, versions, modification times, pictures and pages, comments in
code, and words. Words are every text with a space in it and a word of three letters or more; so
names of laws, units and files are compared, and a sentence may be said in another way. Numbers
count to the last digit. Long lists are kept as a few figures and hashes, so that references stay
small and a difference can be located.
"""

from __future__ import annotations

import csv
import hashlib
import importlib.metadata
import json
import math
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import polars as pl
from same_recordings import MADE, write

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SHARED = ROOT.parent / "shared"
EXPECTED = HERE / "expected"

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"

#: Keys and columns that say when, how long or on which version.
TIMES = {"version", "program", "modified", "rows_per_second", "sidecar_sha256"}
#: `seconds` beside one of these is the time a computation took, elsewhere that of a motion.
COMPUTED = {"evaluations", "rows_scored", "verdict", "truth"}
#: The order of a long sum, and so its last digit, depends on how many threads share it.
ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}
#: Texts of these keys are never words.
KEPT = {"unit", "units", "formula", "symbol", "torque_unit", "position_unit"}
#: Relative tolerance of numbers on another machine than that of the references.
TOLERANCE = 1e-6
#: Lists longer than this are summarised.
LONG = 24
WORD = re.compile(r"(?:^|[\s(])[A-Za-z]{3,}(?=[\s.,;:)]|$)")
#: What the last digits of a number change altogether.
INEXACT = {"sha256", "elements", "evaluations"}


@dataclass(frozen=True)
class Story:
    """Commands in one folder."""

    name: str
    commands: list[str]
    data: list[str]
    folders: list[str]
    slow: bool

    @property
    def shared(self) -> list[Path]:
        """Recordings that are not part of the project."""
        return [SHARED / word.partition("=")[0] for word in self.data if "/" in word]


def stories() -> list[Story]:
    """All that are listed."""
    listed = tomllib.loads((HERE / "commands.toml").read_text())["story"]
    return [
        Story(
            story["name"],
            [line for line in story["commands"].splitlines() if line.strip()],
            story.get("data", []),
            story.get("folders", []),
            story.get("slow", False),
        )
        for story in listed
    ]


def machine() -> dict[str, Json]:
    """What the last digits may depend on: the processor's vectors, the system, the libraries."""
    flags: set[str] = set()
    vendor = platform.machine()
    cpu = Path("/proc/cpuinfo")
    if cpu.exists():
        lines = dict(re.findall(r"^(\w+)\s*:\s*(.*)$", cpu.read_text(), flags=re.MULTILINE))
        vendor = lines.get("vendor_id", vendor)
        flags = {flag for flag in lines.get("flags", "").split() if re.match("avx|fma", flag)}
    libraries = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "polars")}
    locked = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
    libraries |= {row["name"]: row["version"] for row in locked if row["name"] == "faer"}
    return {
        "processor": vendor,
        "vectors": " ".join(sorted(flags)),
        "system": "-".join([platform.system(), *platform.libc_ver()]),
        **libraries,
    }


def prepare(story: Story, folder: Path) -> None:
    """Put the recordings of a story into its folder."""
    for name in story.folders:
        (folder / name).mkdir(parents=True)
    for word in story.data:
        sidecar = None
        if word == "demo":
            (path,) = (ROOT / "python" / "stribeck").rglob("demo.parquet")
            shutil.copy(path, folder)
            sidecar = 'kind = "recording"\njoint_kind = "revolute"\n'
            name = path.name
        elif word in MADE:
            name = f"{word}.csv"
            write(folder / name, MADE[word]())
            if word in ("no_load", "loaded"):
                sidecar = 'kind = "recording"\njoint_kind = "revolute"\naverage = "run"\n'
        else:
            file, _, by = word.partition("=")
            name = Path(file).name
            shutil.copy(SHARED / file, folder)
            if by:
                sidecar = (HERE / "sidecars" / f"{by}.sidecar.toml").read_text()
        if sidecar is not None:
            (folder / f"{name}.sidecar.toml").write_text(sidecar)


def tell(story: Story, folder: Path) -> list[dict[str, Json]]:
    """Run a story's commands in a folder, and say what each leaves behind."""
    prepare(story, folder)
    made, before = [], _stamps(folder)
    for command in story.commands:
        words = [sys.executable, "-m", "stribeck", *shlex.split(command), "--json"]
        done = subprocess.run(
            words,
            cwd=folder,
            env={**os.environ, **ONE_THREAD},
            capture_output=True,
            text=True,
            check=False,
            timeout=800,
        )
        now = _stamps(folder)
        changed = sorted({whole(p) for p, stamp in now.items() if before.get(p) != stamp})
        said: Json = None
        if done.stdout:
            said = Canonical(folder).of(json.loads(done.stdout))
        if "Traceback" in done.stderr or "this is a defect" in done.stderr:
            raise RuntimeError(f"stribeck {command}\n{done.stderr}")
        made.append(
            {
                "command": command,
                "exit": done.returncode,
                "says": said,
                "files": {path: read(folder, path) for path in changed},
            }
        )
        before = now
    return made


def _stamps(folder: Path) -> dict[str, tuple[int, int]]:
    """Files of a folder, and by what a change shows."""
    found = (path for path in folder.rglob("*") if path.is_file())
    return {
        str(path.relative_to(folder)): (path.stat().st_mtime_ns, path.stat().st_ino)
        for path in found
    }


def whole(path: str) -> str:
    """The table that a part belongs to: how many parts there are depends on the time it took."""
    return re.sub(r"part-\d+", "part-*", path)


def read(folder: Path, name: str) -> Json:
    """A written file in the form that is compared; None where only its name is."""
    path, form = folder / name, Canonical(folder)
    kind = path.suffix
    if "*" in name:
        rows = pl.concat(pl.read_parquet(part) for part in sorted(folder.glob(name))).rows(
            named=True
        )
        rows.sort(key=lambda row: json.dumps([row["file"], row["joint"]]))
        return form.table({name: [row[name] for row in rows] for name in rows[0]})
    if kind == ".json":
        return form.of(json.loads(path.read_text()))
    if kind == ".toml":
        return form.of(tomllib.loads(path.read_text()))
    if kind == ".csv":
        with path.open(newline="") as lines:
            head, *rows = csv.reader(lines)
        return form.table({name: [row[k] for row in rows] for k, name in enumerate(head)})
    if kind == ".parquet":
        frame = pl.read_parquet(path)
        return form.table({name: frame[name].to_list() for name in frame.columns})
    if kind in (".c", ".h", ".rs"):
        return code(path.read_text())
    return None


def code(text: str) -> Json:
    """Code without its comments and sentences, one hash for sixteen lines."""
    tokens = re.compile(r'"(?:\\.|[^"\\])*"|\'"\'|//[^\n]*|/\*.*?\*/', re.DOTALL)

    def plain(match: re.Match[str]) -> str:
        token = match.group()
        if token.startswith("/"):
            return ""
        return '"…"' if " " in token else token

    text = tokens.sub(plain, text)
    # How a crate calls its own modules is no part of what the code does.
    text = re.sub(r"^\s*use [^;]*;", "", text, flags=re.MULTILINE)
    text = re.sub(r"\bstribeck::(\w+::)*", "", text)
    # The answers were recorded when the crate's method had this name.
    text = text.replace(".step_over(", ".over(")
    lines = [line.rstrip() for line in text.splitlines() if line.strip()]
    pieces = ["\n".join(lines[k : k + 16]) for k in range(0, len(lines), 16)]
    return {"lines": len(lines), "elements": [short(piece) for piece in pieces]}


def short(text: str) -> str:
    """A short hash."""
    return hashlib.sha256(text.encode()).hexdigest()[:8]


@dataclass(frozen=True)
class Canonical:
    """Answers without times, places and words."""

    folder: Path

    def of(self, value: object, key: str = "") -> Json:
        """Any value of a JSON or TOML document."""
        if isinstance(value, dict):
            kept = {name: part for name, part in value.items() if not self._is_time(name, value)}
            return {self.text(name): self.of(part, name) for name, part in kept.items()}
        if isinstance(value, list):
            return self.summary([self.of(part, key) for part in value])
        if isinstance(value, str):
            return value if key in KEPT else self.text(value)
        if value is None or isinstance(value, bool | int | float):
            return value
        return str(value)

    def table(self, columns: dict[str, list[object]]) -> Json:
        """A table by columns."""
        kept = {name: cells for name, cells in columns.items() if not self._is_time(name, columns)}
        return {name: self.of([_cell(x) for x in cells], name) for name, cells in kept.items()}

    def _is_time(self, name: str, others: dict[str, object]) -> bool:
        return name in TIMES or (name == "seconds" and not COMPUTED.isdisjoint(others))

    def text(self, text: str) -> Json:
        """A text without its words and its place on this machine."""
        if "\n" in text:
            try:
                return self.of(tomllib.loads(text))
            except tomllib.TOMLDecodeError:
                return "…"
        for place in (self.folder.resolve(), self.folder):
            text = text.replace(f"{place}{os.sep}", "").replace(str(place), ".")
        # A robot without a name is called after its folder; the demo says where its file lies.
        if text == self.folder.name:
            return "."
        if os.path.isabs(text):
            return Path(text).name
        return "…" if " " in text and WORD.search(text) else text

    def summary(self, values: list[Json]) -> Json:
        """A list, or what shows a change in a long one."""
        if len(values) <= LONG:
            return values
        made: dict[str, Json] = {"length": len(values), "first": values[0], "last": values[-1]}
        numbers = [x for x in values if isinstance(x, int | float) and not isinstance(x, bool)]
        if len(numbers) == len(values) and all(map(math.isfinite, numbers)):
            made |= {"least": min(numbers), "largest": max(numbers), "sum": math.fsum(numbers)}
        if all(isinstance(x, dict | list) for x in values):
            return made | {"elements": [short(json.dumps(x)) for x in values]}
        return made | {"sha256": short(json.dumps(values))}


def _cell(value: object) -> object:
    """A cell of a table: numbers and documents within texts as what they are."""
    if isinstance(value, str):
        try:
            return json.loads(value) if value not in ("NaN", "Infinity", "-Infinity") else value
        except json.JSONDecodeError:
            return value
    return value


def differences(expected: Json, now: Json, exact: bool, at: str = "") -> Iterator[str]:
    """Where two answers differ, one line each.

    An answer may have more keys or columns than before, and other notes: programs that read it do
    not depend on these. A command writes the same files.
    """
    if isinstance(expected, dict) and isinstance(now, dict):
        if at == ".files":
            yield from (f"{at}.{name} is new" for name in now if name not in expected)
        for key in expected:
            here = f"{at}.{key}"
            if key == "notes" or (not exact and key in INEXACT):
                continue
            if key not in now:
                yield f"{here} is missing"
            else:
                yield from differences(expected[key], now[key], exact, here)
    elif isinstance(expected, list) and isinstance(now, list):
        if len(expected) != len(now):
            yield f"{at}: {len(expected)} elements, now {len(now)}"
        for k, (one, other) in enumerate(zip(expected, now, strict=False)):
            yield from differences(one, other, exact, f"{at}[{k}]")
    elif not _equal(expected, now, exact):
        yield f"{at}: {_shown(expected)}, now {_shown(now)}"


def _shown(value: Json) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 160 else text[:160] + "…"


def _equal(expected: Json, now: Json, exact: bool) -> bool:
    if not exact and isinstance(expected, int | float) and isinstance(now, int | float):
        return math.isclose(expected, now, rel_tol=TOLERANCE, abs_tol=1e-9)
    return json.dumps(expected) == json.dumps(now)


def stored(story: Story) -> Path:
    """Where a story's reference is kept.

    Fits that the data hardly determine end elsewhere on processors with wider vectors: such a story
    has a second reference for these.
    """
    wide = EXPECTED / f"{story.name}-avx512.json"
    if "avx512f" in str(machine()["vectors"]).split() and wide.exists():
        return wide
    return EXPECTED / f"{story.name}.json"


def references(story: Story) -> list[dict[str, Any]]:
    """The references of which an answer has to agree with one.

    Those of this kind of machine, where there are any: there every digit counts.
    """
    both = (EXPECTED / f"{story.name}.json", EXPECTED / f"{story.name}-avx512.json")
    kept = [json.loads(path.read_text()) for path in both if path.exists()]
    return [one for one in kept if one["machine"] == machine()] or kept


def dumped(on: dict[str, Json], answers: list[dict[str, Json]]) -> str:
    """A reference as text: a line for each part of an answer."""
    lines = [f'{{"machine": {json.dumps(on)},', '"answers": [']
    for answer in answers:
        parts = [
            f"{json.dumps(key)}: {json.dumps(value, ensure_ascii=False, separators=(',', ':'))}"
            for key, value in answer.items()
        ]
        lines.append("{" + ",\n ".join(parts) + "},")
    lines[-1] = lines[-1].removesuffix(",")
    return "\n".join([*lines, "]}"]) + "\n"
