"""docs/law_catalog.md and docs/effects.md say what the tables of laws and effects say."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest
from stribeck.models.catalog import effect_ids

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs/effects.md").read_text(encoding="utf-8")
ADVICE = "not up to date: run python3 develop.py gallery"


def module(name: str) -> ModuleType:
    """A file of the gallery."""
    path = ROOT / f"tests/studies/gallery/{name}.py"
    spec = importlib.util.spec_from_file_location(f"gallery_{name}", path)
    assert spec is not None and spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


@pytest.fixture(scope="module")
def catalog() -> ModuleType:
    """What the page says that follows from the tables alone."""
    return module("catalog")


def test_page_of_laws_is_that_of_the_tables():
    laws = module("laws")
    assert laws.PAGE.read_text(encoding="utf-8") == laws.page(), ADVICE


def test_every_effect_is_on_the_page_in_the_order_of_the_catalog():
    assert re.findall(r"^## (\w+)$", PAGE, re.M) == list(effect_ids()), ADVICE


def test_every_effect_has_its_picture_and_no_other_is_there():
    names = {f"{effect}.png" for effect in effect_ids()}
    assert {path.name for path in (ROOT / "docs/effects").iterdir()} == names, ADVICE
    assert set(re.findall(r"\(effects/(.+?)\)", PAGE)) == names, ADVICE


def test_introduction_is_that_of_the_tables(catalog):
    assert PAGE.startswith(catalog.introduction()), ADVICE


@pytest.mark.parametrize("effect", effect_ids())
def test_description_is_that_of_the_tables(catalog, effect):
    assert "\n".join(catalog.description(effect)) in PAGE, ADVICE
