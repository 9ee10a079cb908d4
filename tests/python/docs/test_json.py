"""The page on JSON has every key that the commands print."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
import stribeck as sb

pytestmark = pytest.mark.slow

PAGE = (Path(__file__).resolve().parents[3] / "docs/json.md").read_text(encoding="utf-8")
COMMANDS = {
    "inspect": ["inspect", "run.parquet"],
    "fit": ["fit", "run.parquet", "--model", "coulomb", "--starts", "1", "-o", "model.toml"],
    "compare": ["compare", "run.parquet", "coulomb"],
    "diagnose": ["diagnose", "run.parquet", "coulomb"],
    "add": ["add", "run.parquet", "coulomb", "load"],
    "improve": ["improve", "run.parquet"],
    "check": ["check", "model.toml"],
}


def described(heading: str) -> set[str]:
    """The keys in the table below a heading."""
    section = re.split(rf"^##+ {re.escape(heading)}$", PAGE, flags=re.M)[1]
    section = re.split(r"^##", section, flags=re.M)[0]
    cells = [line.split("|")[1] for line in section.splitlines() if line.startswith("| `")]
    return {key for cell in cells for key in re.findall(r"`(\w+)`", cell)}


def run(folder: Path, *words: str) -> dict:
    command = [sys.executable, "-m", "stribeck", *words, "--json"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict]:
    folder = tmp_path_factory.mktemp("json")
    made = "generate --effect load --seconds 30 --rate 50 --seed 1 -o run.parquet"
    run(folder, *made.split())
    return {name: run(folder, *words) for name, words in COMMANDS.items()}


@pytest.mark.parametrize("command", COMMANDS)
def test_every_key_of_a_command_is_described(printed: dict[str, dict], command: str) -> None:
    assert set(printed[command]) == described(command)


def test_the_keys_of_its_parts_are_described(printed: dict[str, dict]) -> None:
    assert set(printed["fit"]["parameters"]["coulomb_friction"]) == described("A parameter")
    assert set(printed["compare"]["models"][0]) == described("A model that is compared")
    finding = described("A finding")
    assert set(printed["diagnose"]["findings"][0]) == finding
    own = {"rmse_before", "rmse_after", "parameters"}
    assert set(printed["improve"]["steps"][0]) == finding | own
    assert set(printed["inspect"]["scored"]) == described("Scored")


def test_the_model_file_of_the_page_can_be_used(tmp_path: Path) -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.S)
    path = tmp_path / "written.toml"
    path.write_text(text)
    assert sb.load(path).spec == "coulomb+load"
