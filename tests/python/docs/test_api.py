"""The pages of docs/api/ describe every public name, each once."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import stribeck as sb
from stribeck import robot

API = Path(__file__).resolve().parents[3] / "docs/api"


def test_every_public_name_is_described_once():
    pages = "\n".join(path.read_text(encoding="utf-8") for path in sorted(API.glob("*.md")))
    described = re.findall(r"^::: stribeck\.(\w+)$", pages, re.M)
    assert sorted(described) == sorted(set(sb.__all__) - {"__version__"})


@pytest.mark.parametrize("package", [sb, robot])
def test_every_public_name_has_an_example(package):
    """`pytest --doctest-modules` runs them."""
    named = [name for name in package.__all__ if name != "__version__"]
    public = [getattr(package, name) for name in named]
    lacking = [one.__name__ for one in public if callable(one) and ">>>" not in (one.__doc__ or "")]
    assert len(public) > 20 and lacking == []
