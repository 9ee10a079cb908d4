"""Corrupted copies of recordings are refused or mended, with the remedy that restores them."""

from __future__ import annotations

from pathlib import Path

import pytest

from .corrupt import DATA, TABLE, UNDETECTABLE, Corruption, applies, judged, sources

#: The share of the corrupted copies that must be refused or mended rightly.
LEAST = 0.95
QUICK = ("demo", "simulated prismatic")


def _pairs(names: list[str]) -> list[tuple[str, Corruption]]:
    made = sources(names)
    return [(name, c) for name in names for c in TABLE if applies(c, *made[name])]


def _share(names: list[str], folder: Path) -> tuple[float, int, list[str]]:
    made, wrong, count = sources(names), [], 0
    for name, corruption in _pairs(names):
        outcome = judged(corruption, *made[name], folder)
        count += 1
        if not outcome.right:
            wrong.append(f"{name}, {corruption.name}: {outcome.verdict}: {outcome.said}")
    return 1.0 - len(wrong) / count, count, wrong


@pytest.mark.slow
def test_the_demo_and_a_simulated_joint(tmp_path: Path) -> None:
    share, count, wrong = _share(list(QUICK), tmp_path)
    assert count >= 50 and share >= LEAST, wrong


@pytest.mark.slow
@pytest.mark.skipif(not DATA.is_dir(), reason="the public data sets are not at ../shared/data")
def test_every_source(tmp_path: Path) -> None:
    share, count, wrong = _share(list(sources()), tmp_path)
    assert count >= 180 and share >= LEAST, wrong


@pytest.mark.parametrize("corruption", UNDETECTABLE, ids=lambda c: c.name)
def test_what_no_channel_contradicts_is_not_refused(corruption: Corruption, tmp_path: Path) -> None:
    """These leave every relation between the channels as it is: nothing can be said of them."""
    frame, options = sources(["demo"])["demo"]
    frame = frame.drop([c[3:] for c in corruption.needs if c.startswith("no ")], strict=False)
    outcome = judged(corruption, frame, options, tmp_path)
    assert outcome.verdict == "unseen"
