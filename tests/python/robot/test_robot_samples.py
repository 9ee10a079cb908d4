"""What a robot refuses."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from stribeck.robot.tables import from_tables


@pytest.mark.parametrize(
    ("shapes", "message"),
    [
        ([(4, 1), (4, 1), (3, 1)], r"`acceleration` has shape \[3, 1\]"),
        ([(4,), (4,), (4,)], r"`position` has shape \[4\]: give one row a sample and one column"),
        ([(4, 2), (4, 1), (4, 1)], r"`position` has shape \[4, 2\]"),
    ],
)
def test_samples_of_another_shape_are_refused(shapes: list[tuple[int, ...]], message: str) -> None:
    arm = from_tables("arm", [{}]).with_bodies(np.ones((1, 11)))
    for method in (arm.torque, arm.regressor, arm.torque_derivatives):
        with pytest.raises(sb.SpecError, match=message):
            method(*map(np.zeros, shapes))
    with pytest.raises(sb.SpecError, match=r"shape \[1, 10\]: give ten inertial parameters and"):
        arm.with_bodies(np.ones((1, 10)))
