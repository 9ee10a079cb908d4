"""Effects whose form physics fixes are claimed for that form alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from synthetic import joint, motion, record


def first_named(folder: Path, extra: np.ndarray, seed: int) -> list[str]:
    fit = sb.fit("coulomb", record(folder, joint(extra, rows=8000, seed=seed)))
    return [finding.effect for finding in sb.diagnose(fit).findings]


@pytest.mark.parametrize("seed", [1, 2])
def test_friction_that_knows_the_sign_of_acceleration_is_no_inertia(
    tmp_path: Path, seed: int
) -> None:
    _, _, _, a = motion(8000)
    assert first_named(tmp_path, 0.4 * np.sign(a), seed) == []


@pytest.mark.parametrize("seed", [1, 2])
def test_an_error_of_inertia_is_one(tmp_path: Path, seed: int) -> None:
    _, _, _, a = motion(8000)
    assert first_named(tmp_path, 0.05 * a, seed)[0] == "inertia"


def test_a_spring_that_hardens_at_one_end_is_no_gravity(tmp_path: Path) -> None:
    _, q, _, _ = motion(8000)
    named = first_named(tmp_path, 0.5 * np.maximum(q - 0.2, 0.0) ** 2, 1)
    assert named and named[0] == "spring"
