"""Commands that are killed or stopped at random moments: nothing is lost, and nothing is left half.

Each command runs once undisturbed, which gives its answer and its time. Then it is stopped by each
signal at a random share of that time, in a folder of its own: the files there are whole or absent,
no process is left, and the same command gives the undisturbed answer.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import polars as pl
import pytest
import stribeck as sb
from synthetic import joint

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name == "nt", reason="signals and process groups are POSIX"),
]

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
#: The interpreter starts within this share of a command's time; it cannot report an interrupt.
EARLIEST = 0.2
#: Seconds in which workers notice that their parent has died.
ORPHANS_END = 20.0


def all_rows(path: Path, count: int, folder: Path) -> str | None:
    """Rows of a fleet or study if all are there, without their seconds and the case's folder."""
    rows = pl.read_parquet(path).drop("seconds", "robot", strict=False)
    return rows.write_json().replace(str(folder), "") if rows.height == count else None


def text_of_a_model(path: Path) -> str:
    return "\n".join(line for line in path.read_text().splitlines() if "seconds" not in line)


@dataclass(frozen=True)
class Case:
    """A command, and the answer that it leaves in its folder.

    `answer` raises if a file is damaged, and returns None where there is none yet.
    """

    words: tuple[str, ...]
    answer: Callable[[Path], str | None]
    prepare: Callable[[Path], None] = lambda folder: None


def whole(name: str, read: Callable[[Path], str]) -> Callable[[Path], str | None]:
    return lambda folder: read(folder / name) if (folder / name).exists() else None


def with_a_project(folder: Path) -> None:
    shutil.copy(folder.parent / "project.toml", folder / "project.toml")
    shutil.copy(folder.parent / "joint.csv", folder / "joint.csv")


def nodes(folder: Path) -> str | None:
    """The tree of a project; before `add` has ended, it is the one before."""
    tree = sb.Project.open(folder / "project.toml").to_dict()["nodes"]
    return json.dumps(tree) if len(tree) > 1 else None


def answer_of_a_study(folder: Path) -> str | None:
    path = folder / "study" / "fits.parquet"
    return all_rows(path, 1 + 3 + 3, folder) if path.exists() else None


def answer_of_a_fleet(folder: Path) -> str | None:
    parts = sorted((folder / "fleet" / "results").glob("*.parquet"))
    kept = [all_rows(part, len(DAYS), folder) for part in parts]
    return kept[0] if len(kept) == 1 else None


def answer_of_an_export(folder: Path) -> str | None:
    names = ("model.c", "model.h", "model_test.c", "model_vectors.h")
    paths = [folder / "made" / name for name in names]
    return json.dumps([p.read_text() for p in paths]) if all(p.exists() for p in paths) else None


DAYS = ("monday", "tuesday", "wednesday", "thursday", "friday", "saturday")

CASES = {
    "fit": Case(
        ("fit", "../joint.csv", "--model", "lugre", "--starts", "8", "-o", "model.toml"),
        whole("model.toml", text_of_a_model),
    ),
    "improve": Case(
        ("improve", "../joint.csv", "--max-steps", "1", "-o", "model.toml"),
        whole("model.toml", text_of_a_model),
    ),
    "study": Case(
        ("study", "../joint.csv", "--law", "coulomb", "--law", "lugre", "--law", "dahl",
         "--starts", "3", "--workers", "2", "-o", "study"),
        answer_of_a_study,
    ),
    "fleet": Case(
        ("fleet", *(f"../{day}.csv" for day in DAYS), "--model", "lugre", "--starts", "3",
         "--workers", "2", "-o", "fleet"),
        answer_of_a_fleet,
    ),
    "project": Case(("project", "add", "project.toml", "stribeck"), nodes, with_a_project),
    "generate": Case(
        ("generate", "-o", "made.csv", "--effect", "load", "--seconds", "60", "--seed", "4"),
        whole("made.csv", Path.read_text),
    ),
    "export": Case(("export", "../model.toml", "made", "--to", "c"), answer_of_an_export),
}  # fmt: skip


def start(case: Case, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "stribeck", *case.words],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def left_in(session: int) -> list[str]:
    """Living processes of a session, apart from loky's tracker, which ends with the last one."""
    listed = subprocess.run(
        ["ps", "-ww", "-eo", "sid=,stat=,args="], capture_output=True, text=True, check=True
    )
    rows = [line.split(None, 2) for line in listed.stdout.splitlines()]
    return [words for of, state, words in rows if of == str(session) and state[0] != "Z"]


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the commands read."""
    folder = tmp_path_factory.mktemp("faults")
    joint(rows=1500).write_csv(folder / "joint.csv")
    for seed, day in enumerate(DAYS):
        joint(rows=600, seed=seed).write_csv(folder / f"{day}.csv")
    sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5).save(folder / "model.toml")
    sb.Project.new(folder / "project.toml", folder / "joint.csv").save()
    return folder


@pytest.fixture(scope="module")
def undisturbed(home: Path) -> Callable[[str], tuple[str, float]]:
    """The answer of a command and the seconds that it took."""
    known: dict[str, tuple[str, float]] = {}

    def run(name: str) -> tuple[str, float]:
        if name not in known:
            folder = home / f"{name}-undisturbed"
            folder.mkdir()
            CASES[name].prepare(folder)
            began = time.monotonic()
            process = start(CASES[name], folder)
            _, said = process.communicate(timeout=300)
            seconds = time.monotonic() - began
            answer = CASES[name].answer(folder)
            assert process.returncode == 0 and answer is not None, said
            known[name] = answer, seconds
        return known[name]

    return run


@pytest.mark.parametrize("by", SIGNALS, ids=lambda by: by.name)
@pytest.mark.parametrize("name", CASES)
def test_a_stopped_command_loses_nothing(
    name: str, by: signal.Signals, home: Path, undisturbed: Callable[[str], tuple[str, float]]
) -> None:
    expected, seconds = undisturbed(name)
    case, folder = CASES[name], home / f"{name}-{by.name}"
    folder.mkdir()
    case.prepare(folder)
    process = start(case, folder)
    time.sleep(seconds * random.Random(f"{name} {by}").uniform(EARLIEST, 0.95))
    process.send_signal(by)
    said = process.communicate(timeout=120)[1]
    assert "Traceback" not in said
    assert process.returncode in ((0, 130) if by is signal.SIGINT else (0, -by)), said

    # What is there is whole: a file that is damaged raises, another answer is not the command's.
    found = case.answer(folder)
    assert found in (None, expected)
    if by is not signal.SIGKILL:
        unfinished = [path for path in folder.rglob(".*") if path.name != ".lock"]
        assert by is signal.SIGTERM or unfinished == []
    deadline = time.monotonic() + ORPHANS_END
    while left := left_in(process.pid):
        assert time.monotonic() < deadline, left
        time.sleep(0.2)

    if found is None or name != "project":
        again = start(case, folder)
        _, said = again.communicate(timeout=300)
        assert again.returncode == 0, said
    assert case.answer(folder) == expected


def test_two_commands_that_change_a_project_lose_no_node(home: Path) -> None:
    """Several at once, again and again until each has succeeded."""
    folder = home / "two writers"
    folder.mkdir()
    with_a_project(folder)
    waiting = ["stribeck", "load", "offset"]
    while waiting:
        running = {e: start(Case(("project", "add", "project.toml", e), nodes), folder)
                   for e in waiting}  # fmt: skip
        for effect, process in running.items():
            said = process.communicate(timeout=300)[1]
            if process.returncode == 0:
                waiting.remove(effect)
            else:
                assert process.returncode == 2
                assert "another command is changing project.toml" in said.splitlines()[-1]
    tree = sb.Project.open(folder / "project.toml").to_dict()["nodes"]
    assert len(tree) == 4


@pytest.mark.parametrize("name", ["study", "fleet"])
def test_a_folder_has_one_run_at_a_time(
    name: str, home: Path, undisturbed: Callable[[str], tuple[str, float]]
) -> None:
    expected, _ = undisturbed(name)
    folder = home / f"{name} twice"
    folder.mkdir()
    running = [start(CASES[name], folder) for _ in range(2)]
    ends = [(p.communicate(timeout=300)[1], p.returncode) for p in running]
    for said, code in ends:
        assert code == 0 or (code == 2 and f"another run works in {name}" in said), said
    assert 0 in [code for _, code in ends]
    assert CASES[name].answer(folder) == expected
