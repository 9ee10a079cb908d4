"""Run the command lines of the pages in the current folder, in one process.

python run_commands.py [PAGE...]

Prints one JSON object a line of a page: the line, the exit code, the last words of stderr. The
files that the lines name are made first.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from command_lines import Line, lines
from stribeck.cli.main import main
from stribeck.motion.generate.hidden import generate

#: A line may end with one of these: `check` answers 1 where a model is not proved passive.
PASSED = {"check": (0, 1)}


RECORDINGS = (
    *("LOG.csv", "OTHER.csv", "run1.csv", "run2.csv", "monday.csv", "tuesday.csv", "monday/a.csv"),
    *("logs/a.parquet", "logs/b.parquet", "logs/r1/a.parquet", "logs/r2/a.parquet"),
    *(f"data/r{k}/elbow/log_2026-03-02.csv" for k in (1, 2)),
)
#: Pages on which inertia and gravity are identified with the friction of LOG.csv.
WITHOUT_LOAD = ("docs/simulation.md", "docs/people/control_engineer.md")
#: What a page expects to have been done.
BEFORE = {"docs/reports.md": "project new joint.project.toml LOG.csv --base coulomb"}


def make_files(folder: Path, *, load: bool) -> None:
    """Recordings and models of the names that the pages use, in `folder`.

    Parameters
    ----------
    load : bool
        Whether the recordings have the load torque.
    """
    for seed, name in enumerate(RECORDINGS):
        frame = generate(["stribeck", "load"], seed=seed, seconds=30.0, rate=50.0)[0]
        frame = frame if load else frame.drop("load_torque")
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.suffix == ".csv":
            frame.write_csv(target)
        else:
            frame.write_parquet(target)
    for model, name in (("coulomb+stribeck", "joint"), ("lugre", "lugre"), ("coulomb", "model")):
        run(["fit", str(folder / "LOG.csv"), "--model", model, "-o", str(folder / f"{name}.toml")])
    shutil.copy(folder / "model.toml", folder / "joint_3.toml")


def write_matlab(folder: Path) -> None:
    """tuesday.mat, with the columns of tuesday.csv."""
    import polars as pl
    import scipy

    frame = pl.read_csv(folder / "tuesday.csv")
    scipy.io.savemat(folder / "tuesday.mat", {n: frame[n].to_numpy() for n in frame.columns})


def run(words: list[str]) -> tuple[int, str]:
    """Exit code of a command, and what it says on stderr."""
    said = io.StringIO()
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said):
        try:
            main(words)
        except SystemExit as done:
            return int(done.code or 0), said.getvalue()
    return 0, said.getvalue()


def run_line(line: Line) -> tuple[int, str]:
    """The same for a line of a page."""
    if line.words[0] == "stribeck":
        code, said = run(line.words[1:])
        return (0 if code in PASSED.get(line.words[1], (0,)) else code), said
    done = subprocess.run(line.words, capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def main_of_pages() -> None:
    """Run all lines, each page with new files."""
    start = Path.cwd()
    for name, load in (("with", True), ("without", False)):
        make_files(start / name, load=load)
        write_matlab(start / name)
    page = ""
    named = sys.argv[1:]
    for line in lines():
        if line.reason is not None or (named and line.page not in named):
            continue
        if line.page != page:
            page = line.page
            folder = start / page.replace("/", "_").replace(".md", "")
            shutil.copytree(start / ("without" if page in WITHOUT_LOAD else "with"), folder)
            os.chdir(folder)
            if page in BEFORE:
                run(BEFORE[page].split())
        began = time.process_time()
        code, said = run_line(line)
        seconds = time.process_time() - began
        row = {"page": page, "line": line.text, "code": code, "said": said[-300:], "cpu": seconds}
        print(json.dumps(row), flush=True)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parent))
    main_of_pages()
