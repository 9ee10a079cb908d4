"""All laws with the parameters printed in table 7 of the UR5e review: each is decided."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from laws.published import TABLE_7

BOX = {
    "velocity": (-3.14, 3.14),
    "temperature": (25.0, 45.0),
    "load_torque": (-50.0, 50.0),
    "acceleration": (-5.0, 5.0),
    "motor_torque": (-80.0, 80.0),
}

#: Helped by an offset; below zero near rest; by the load squared (twice); slow to unwind.
ACTIVE = ("gaz_a", "wolf", "li", "nevmerzhitskiy", "indri_b")


@pytest.mark.parametrize("law", TABLE_7)
def test_published_parameters(law: str) -> None:
    model = sb.model(law, **TABLE_7[law])
    box = {name: side for name, side in BOX.items() if name in model.core.needs}
    certificate = sb.check(model, box)
    assert certificate.passive is (law not in ACTIVE)
    example = certificate.counterexample
    assert (example is None) is (law not in ACTIVE)
    if example is not None:
        assert example.replay()[0] == example.net_work < 0.0
    elif model.memoryless:
        rng = np.random.default_rng(3)
        point = {name: rng.uniform(*BOX[name], 50_000) for name in model.core.needs}
        power = model.torque(**point) * point["velocity"]
        assert power.min() >= 0.0
