"""Thirty commands and more answer as they did: the same numbers, the same keys, the same files.

`commands.toml` is the list, `expected/` what the commands answered when it was recorded
(`record.py`), `same_answers.py` what is compared and what is not. Only the command line is used, so
modules may move. To see whether another tree answers the same, put it first on the path:

    PYTHONPATH=/path/of/the/tree/python python -m pytest tests/python/same

On the kind of machine that recorded the references every digit counts; on another, numbers have to
agree to a relative 1e-6. Stories whose fits depend on the processor more than that have a reference
of two kinds of processors, and the answers must agree with one of them. Additional keys of an
answer are no difference.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from same_answers import EXPECTED, Json, Story, differences, machine, references, stories, tell

STORIES = stories()


@pytest.mark.parametrize(
    "story",
    [
        pytest.param(story, id=story.name, marks=[pytest.mark.slow] if story.slow else [])
        for story in STORIES
    ],
)
def test_the_answers_are_the_same(story: Story, tmp_path: Path) -> None:
    """Every command of a story, run as a user runs it."""
    for path in story.shared:
        if not path.is_file():
            pytest.skip(f"{path} is not there")
    answers = json.loads(json.dumps(tell(story, tmp_path)))
    found = min((changed(kept, answers) for kept in references(story)), key=len)
    assert not found, "\n" + "\n".join(found)


def changed(kept: dict[str, Any], answers: list[dict[str, Json]]) -> list[str]:
    """The commands that answer otherwise than a reference says, and what differs."""
    exact = kept["machine"] == machine()
    assert [a["command"] for a in answers] == [a["command"] for a in kept["answers"]]
    found = []
    for expected, now in zip(kept["answers"], answers, strict=True):
        lines = list(differences(expected, now, exact))
        found += [f"stribeck {now['command']}\n    " + "\n    ".join(lines[:12])] if lines else []
    return found


def test_the_list_is_long_enough() -> None:
    """At least thirty commands, each story with a reference and none without a story."""
    assert sum(len(story.commands) for story in STORIES) >= 30
    kept = {path.stem.removesuffix("-avx512") for path in EXPECTED.glob("*.json")}
    assert kept == {story.name for story in STORIES}


def test_a_difference_is_what_is_missing_or_changed() -> None:
    """A key may be added, at any depth; none may go, and no value may change."""
    expected = {"rmse": 1.0, "parameters": {"a": {"value": 2.0}}}
    added = {"rmse": 1.0, "aic": 3.0, "parameters": {"a": {"value": 2.0, "open": []}}}
    assert list(differences(expected, added, True)) == []
    assert list(differences(added, expected, True)) == [
        ".aic is missing",
        ".parameters.a.open is missing",
    ]
    changed = {"rmse": 1.0, "parameters": {"a": {"value": 2.5}}}
    assert list(differences(expected, changed, True)) == [".parameters.a.value: 2.0, now 2.5"]
    assert list(differences({"files": {}}, {"files": {"m.toml": {}}}, True)) == [
        ".files.m.toml is new"
    ]
