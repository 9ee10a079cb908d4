"""Every effect of the catalog has its file, and the file agrees with the catalog."""

from __future__ import annotations

import importlib
import sys
import types

import numpy as np
import pytest
import stribeck as sb
from stribeck.effect import registry
from stribeck.effect.base import GeneratedRecording
from stribeck.effect.constants import effect_constants
from stribeck.effect.describe import NOT_FRICTION
from stribeck.models.catalog import catalog, effect_ids
from stribeck.motion.generate.motion import JOINTS

EFFECTS = registry.effects()


def test_effects_stand_in_catalog_order() -> None:
    assert tuple(EFFECTS) == effect_ids()
    assert all(effect.id == name for name, effect in EFFECTS.items())


def test_a_missing_file_is_named() -> None:
    with pytest.raises(ImportError, match=r"stribeck/effect/creep\.py must define EFFECT"):
        registry.of_catalog("creep")


def test_a_file_with_another_id_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    wrong = types.ModuleType("stribeck.effect.creep")
    vars(wrong)["EFFECT"] = EFFECTS["load"]
    monkeypatch.setitem(sys.modules, "stribeck.effect.creep", wrong)
    with pytest.raises(ImportError, match="id='creep'"):
        registry.of_catalog("creep")


def test_an_import_that_fails_within_a_file_keeps_its_own_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(name: str) -> types.ModuleType:
        raise ModuleNotFoundError("no module named 'elsewhere'", name="elsewhere")

    monkeypatch.setattr(importlib, "import_module", fail)
    with pytest.raises(ModuleNotFoundError, match="elsewhere"):
        registry.of_catalog("creep")


def test_an_effect_by_formula_has_no_file() -> None:
    assert registry.find("creep = c*abs(load)*sgn(v)") is None


@pytest.mark.parametrize("effect", effect_ids())
def test_every_effect_gets_the_constants_it_names(effect: str, plain: sb.Recording) -> None:
    named = set(catalog()["effects"][effect]["constants"])
    given = effect_constants(effect, plain)
    assert set(given) == named
    assert all(np.isfinite(x) for x in given.values())
    made = GeneratedRecording(JOINTS["revolute"], 60.0, 34.0)
    assert set(EFFECTS[effect].generated_constants(made)) == named


@pytest.mark.parametrize("effect", effect_ids())
def test_plausible_sizes_are_those_of_its_parameters(effect: str) -> None:
    named = {p["name"] for p in catalog()["effects"][effect]["parameters"]}
    sizes = EFFECTS[effect].plausible(JOINTS["revolute"], np.random.default_rng(0))
    assert set(sizes) <= named


def test_other_ids_that_an_effect_names_are_in_the_catalog() -> None:
    assert all(e.part_of is None or e.part_of in EFFECTS for e in EFFECTS.values())
    groups = {row["group"] for row in catalog()["effects"].values()}
    assert groups == {"friction", *NOT_FRICTION}
