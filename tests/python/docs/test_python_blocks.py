"""Every Python block of README.md and docs/ runs, except those of a list with reasons."""

from __future__ import annotations

import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import pytest
import stribeck as sb
from stribeck.motion.generate.hidden import generate

sys.path.insert(0, str(Path(__file__).parent))
from command_lines import ROOT
from python_blocks import NOT_RUN, Block, blocks

RUN = [block for block in blocks() if block.page not in NOT_RUN]
#: Recordings of the names that the blocks read.
RECORDINGS = ("LOG.csv", "run1.csv", "run2.csv", "logs/r1/a.parquet", "logs/r2/a.parquet")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made: Path = tmp_path_factory.mktemp("blocks")
    for seed, name in enumerate(RECORDINGS):
        frame = generate(["load"], seed=seed, seconds=30.0, rate=50.0)[0]
        (made / name).parent.mkdir(parents=True, exist_ok=True)
        (frame.write_csv if name.endswith(".csv") else frame.write_parquet)(made / name)
    sb.fit("coulomb+load", sb.read(made / "LOG.csv")).model.save(made / "joint.toml")
    return made


class Known(dict[str, Any]):
    """The names that pages take as known, each made when a block first asks for it."""

    def __missing__(self, name: str) -> Any:
        if name not in MADE:
            raise KeyError(name)
        self[name] = MADE[name](self)
        return self[name]


#: How each is made.
MADE = {
    "sb": lambda of: sb,
    "recording": lambda of: sb.read("LOG.csv"),
    "rec": lambda of: of["recording"],
    "fit": lambda of: sb.fit("coulomb", of["recording"]),
    "found": lambda of: sb.improve("coulomb", of["recording"], most_steps=1),
    "velocity": lambda of: of["recording"].velocity,
    "load": lambda of: of["recording"].load_torque,
    "frame": lambda of: of["recording"].to_frame().rename({"torque": "i_3"}),
    "t": lambda of: of["recording"].time,
    "v": lambda of: 57.29577951308232 * of["recording"].velocity,
    "tau": lambda of: of["recording"].torque,
    "temperature": lambda of: of["recording"].temperature,
    "pool": lambda of: ProcessPoolExecutor(1, multiprocessing.get_context("forkserver")),
}


@pytest.mark.slow
@pytest.mark.parametrize("block", RUN, ids=lambda block: f"{block.page}:{block.line}")
def test_the_block_runs(block: Block, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    shown: list[object] = []
    # What opens a browser is kept instead.
    monkeypatch.setattr("bokeh.io.show", shown.append)
    known = Known()
    # Errors name the line of the page.
    source = "\n" * (block.line - 1) + block.text
    exec(compile(source, str(ROOT / block.page), "exec"), {}, known)
    assert ("show(" in block.text) == bool(shown)
    if "pool" in known:
        known["pool"].shutdown()


def test_every_exception_is_of_a_block() -> None:
    assert set(NOT_RUN) <= {block.page for block in blocks()}
    assert len(RUN) > 8
