"""Property 1 of Tadese et al. 2021 on their own model: reproduced, and where it asks too much.

Passive if (i) ``0 <= s1(v) <= 4 D/|v|`` and (ii) ``zeta v >= 0`` for what is beside the bristle.
With ``s1(v) = s1 exp(-|v|/vd)``, whose product with |v| peaks at ``v = vd``, (i) is
``s1 <= 4 e min(D)/vd``. In (ii) the printed condition lost signs: a1, a3 > 0 and a2, a4 < 0.
"""

from __future__ import annotations

import math

import pytest
import stribeck as sb
from stribeck.passivity.certificate import Margin

STRENGTH, SPEED = 2.0, 0.01
#: The largest s1 of (i).
LIMIT = 4.0 * math.e * STRENGTH / SPEED
BOX = {"velocity": (-1.0, 1.0), "temperature": (20.0, 40.0), "load_torque": (-30.0, 30.0)}
QUADRANTS = (
    "forward_motoring",
    "backward_generating",
    "backward_motoring",
    "forward_generating",
)


def tadese(
    damping: float, load: tuple[float, float, float, float], backward: float = STRENGTH
) -> sb.Model:
    """`tadese_full` with this s1, load coefficients by quadrant and dry friction backward."""
    values = dict.fromkeys(sb.model("tadese_full").names, 0.0) | {
        "bristle_stiffness": 1e4,
        "bristle_damping": damping,
        "damping_velocity": SPEED,
        "coulomb_friction_forward": STRENGTH,
        "coulomb_friction_backward": backward,
        "viscous_level_forward": 3.0,
        "viscous_speed_forward": 1.0,
        "viscous_level_backward": 3.0,
        "viscous_speed_backward": 1.0,
    }
    for quadrant, slope in zip(QUADRANTS, load, strict=True):
        values[f"load_rise_rate_{quadrant}"] = 3.0
        values[f"load_friction_{quadrant}"] = slope
    return sb.model("tadese_full", **values)


#: a1, a3 > 0 and a2, a4 < 0.
OPPOSING = (0.1, -0.05, 0.1, -0.05)


def damping_margin(certificate: sb.Certificate) -> Margin:
    """That of (i)."""
    return next(margin for margin in certificate.margins if margin.condition == "damping")


def test_conditions_as_meant_prove_the_model() -> None:
    certificate = sb.check(tadese(0.9 * LIMIT, OPPOSING), BOX)
    assert certificate.passive is True
    assert certificate.condition in ("damping", "resistance")


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_the_limit_of_the_damping_is_theirs(share: float) -> None:
    margin = damping_margin(sb.check(tadese(share * LIMIT, OPPOSING), BOX))
    if share < 1.0:
        assert margin.lower is not None
        assert margin.lower >= 0.0
    else:
        assert margin.upper is not None
        assert margin.upper < 0.0


def test_signs_as_printed_give_off_energy() -> None:
    """All four positive: in quadrants 2 and 4 the load pushes the joint on."""
    certificate = sb.check(tadese(0.9 * LIMIT, (0.1, 0.1, 0.1, 0.1)), BOX)
    assert certificate.passive is False
    example = certificate.counterexample
    assert example is not None
    assert example.replay()[0] < 0.0
    assert any(step["velocity"] * step["load_torque"] < 0.0 for step in example.steps)


@pytest.mark.parametrize("backward", [STRENGTH, 1.5 * STRENGTH])
def test_constant_dry_friction_needs_no_limit_at_all(backward: float) -> None:
    """The bristle never arrives in a direction with more than it holds there."""
    certificate = sb.check(tadese(100.0 * LIMIT, OPPOSING, backward), BOX)
    broken = damping_margin(certificate).upper
    assert broken is not None
    assert broken < -100.0
    assert (certificate.passive, certificate.condition) == (True, "storage")


@pytest.mark.parametrize(("speed", "passive"), [(0.03, True), (0.05, False)])
def test_falling_dry_friction_needs_a_wider_limit(speed: float, passive: bool) -> None:
    """LuGre's example of 1995 misses (i) on both sides of the speed at which energy comes out."""
    example = sb.model("lugre", a1=1e5, a2=1e5**0.5, a3=0.4, a4=1.0, a5=1.5, a6=1e-3, a7=2.0)
    certificate = sb.check(example, {"velocity": (-speed, speed)})
    broken = damping_margin(certificate).upper
    assert broken is not None
    assert broken < -1.0
    assert (certificate.passive, certificate.condition) == (passive, "cycle")
