"""The pages of docs/api/ describe every public name, each once."""

from __future__ import annotations

import re
from pathlib import Path

import stribeck as sb

API = Path(__file__).resolve().parents[3] / "docs/api"


def test_every_public_name_is_described_once():
    pages = "\n".join(path.read_text(encoding="utf-8") for path in sorted(API.glob("*.md")))
    described = re.findall(r"^::: stribeck\.(\w+)$", pages, re.M)
    assert sorted(described) == sorted(set(sb.__all__) - {"__version__"})


def test_every_public_name_has_a_docstring():
    assert [name for name in sb.__all__ if not getattr(sb, name).__doc__] == []
