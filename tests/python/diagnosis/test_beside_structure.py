"""Structure that remains leaves it open whether friction or another kind of cause is missing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.residual.noise_floor import NoiseFloor, noise_floor
from stribeck.diagnosis.trials.beside_structure import is_undecided, structure_share
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def fits(tmp_path_factory: pytest.TempPathFactory) -> dict[str, sb.Fit]:
    """A constant torque, and what effects of both kinds leave of it."""
    recording = record(tmp_path_factory.mktemp("structure"), joint(0.5))
    specs = (
        "coulomb",
        "coulomb+offset",
        "coulomb+direction",
        "coulomb+position",
        "coulomb+gravity",
    )
    return {spec.partition("+")[2]: sb.fit(spec, recording, starts=1) for spec in specs}


@pytest.mark.parametrize(
    ("best", "other", "left", "undecided"),
    [
        ("offset", "direction", 0.9, True),
        ("direction", "offset", 0.9, True),
        # Nothing remains: the standard error tells.
        ("offset", "direction", 0.0, False),
        # It explains far less.
        ("offset", "position", 0.9, False),
        # Both are no friction.
        ("offset", "gravity", 0.9, False),
    ],
)
def test_effects_of_two_kinds_that_explain_nearly_the_same(
    fits: dict[str, sb.Fit], best: str, other: str, left: float, undecided: bool
) -> None:
    pair = (fits[best], fits[other])
    assert is_undecided((best, other), pair, fits[""], left) == undecided


def test_a_difference_beyond_a_share_of_what_remains_decides(fits: dict[str, sb.Fit]) -> None:
    best, other = fits["offset"], fits["direction"]
    worse = replace(other, held_out=other.held_out + 0.03 * np.sign(motion()[2]))
    assert is_undecided(("offset", "direction"), (best, other), fits[""], 0.9)
    assert not is_undecided(("offset", "direction"), (best, worse), fits[""], 0.9)


def test_structure_is_what_exceeds_the_noise_floor(fits: dict[str, sb.Fit]) -> None:
    floor = noise_floor(fits["offset"])
    assert structure_share(fits["offset"], floor) == 0.0
    assert structure_share(fits[""], floor) > 0.9
    assert structure_share(fits[""], NoiseFloor(None, "too few samples")) == 0.0
