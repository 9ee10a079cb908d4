"""`stribeck project`: each command writes the file, answers in JSON, refuses in one line."""

from __future__ import annotations

import contextlib
import io
import json
import sys
from pathlib import Path
from typing import Any, NamedTuple
from unittest import mock

import pytest
import stribeck as sb
from stribeck.cli.main import main


class Done(NamedTuple):
    """How a command ended."""

    returncode: int
    stdout: str
    stderr: str


def run(*words: object) -> Done:
    """Run the command as a user does, in this process: starting one takes longer than most."""
    out, err, code = io.StringIO(), io.StringIO(), 0
    with (
        mock.patch.object(sys, "argv", ["stribeck", "project", *map(str, words)]),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
    ):
        try:
            main()
        except SystemExit as done:
            code = int(done.code or 0)
    return Done(code, out.getvalue(), err.getvalue())


def answer(*words: object) -> dict[str, Any]:
    """The one JSON object that a command prints, and nothing else."""
    done = run(*words, "--json")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1
    return dict(json.loads(done.stdout))


def refused(*words: object) -> str:
    """The one line with which a command refuses."""
    done = run(*words)
    lines = [line for line in done.stderr.splitlines() if not line.startswith("note: ")]
    assert done.returncode == 2 and done.stdout == "" and len(lines) == 1, done.stderr
    return lines[0]


@pytest.fixture(scope="module")
def path(folder: Path) -> Path:
    """A project that the command made."""
    target = folder / "walked.toml"
    made = answer(
        "new", target, folder / "data" / "joint.csv", "--joint-kind", "revolute", "--starts", "2"
    )
    assert made["model"] == "coulomb" and made["nodes"][0]["change"] == "base"
    assert made["data"]["reading"] == {"joint_kind": "revolute"}
    return target


def test_the_loop_by_hand(path: Path) -> None:
    page, figures = path.parent / "page.html", path.parent / "figures"
    found = answer("diagnose", path, "--report", page, "--figures", figures)
    assert "</html>" in page.read_text()
    assert {p.stem for p in figures.iterdir()} == {row["effect"] for row in found["findings"]}
    assert found["node"] == 0 and found["findings"][0]["effect"] == "load"
    assert answer("name", path, "main")["nodes"][0]["name"] == "main"
    added = answer("add", path, "load", "--starts", "2")
    assert added["current"] == 1
    assert added["nodes"][1]["rmse_held_out_after"] < added["nodes"][1]["rmse_held_out_before"]
    assert added["nodes"][1]["confidence"] == found["findings"][0]["confidence"]
    assert set(added["nodes"][1]["parameters"]) >= {"load_coulomb", "coulomb_friction"}
    assert answer("reject", path, "inertia", "--because", "CAD")["nodes"][1]["rejected"] == {
        "inertia": "CAD"
    }
    assert answer("reject", path, "inertia", "--undo")["nodes"][1]["rejected"] == {}
    assert answer("drop", path, "load", "--starts", "2")["model"] == "coulomb"
    assert answer("back", path, "main")["current"] == 0
    improved = answer("improve", path)
    assert improved["current"] == 1 and len(improved["nodes"]) == 3
    assert answer("show", path) == improved
    assert answer("compare", path, "main", 1)["better"] == 1
    target = path.parent / "model.toml"
    assert answer("save", path, "-o", target)["model"] == "coulomb+load"
    assert sb.load(target).spec == "coulomb+load"
    assert "▸ 1  + load" in run("show", path).stdout


def test_bad_input_is_refused_in_one_line(path: Path, folder: Path) -> None:
    data = folder / "data" / "joint.csv"
    assert "there already" in refused("new", path, data)
    assert "did you mean 'gravity'" in refused("add", path, "gravty")
    assert "there is no node '9'" in refused("back", path, 9)
    assert "cannot read the project" in refused("show", folder / "absent.toml")
    other = folder / "changed.csv"
    other.write_text(data.read_text())
    assert run("new", folder / "changed.toml", other, "--starts", 1).returncode == 0
    other.write_text(data.read_text().replace("\n", "\n\n", 1))
    for words in (["show"], ["diagnose"], ["add", "load"], ["improve"], ["back"]):
        command, *rest = words
        assert "has changed since" in refused(command, folder / "changed.toml", *rest)
