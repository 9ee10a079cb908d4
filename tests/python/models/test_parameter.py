"""Units of the catalog as they are written for a joint."""

from __future__ import annotations

import pytest
from stribeck.models.parameter import joint_unit


@pytest.mark.parametrize(
    ("unit", "load", "position", "written"),
    [
        ("T", "N m", "rad", "N m"),
        ("T s/X", "N", "m", "N s/m"),
        ("1/T", "N m", "rad", "1/(N m)"),
        ("1/T", "N", "m", "1/N"),
        ("T2", "N m", "rad", "(N m)2"),
        ("X/s2", "N m", "rad", "rad/s2"),
        ("T s2/X", "N m", "rad", "kg m2"),
        ("T s2/X", "N", "m", "kg"),
        ("T s2/X", "%", "rad", "% s2/rad"),
        ("degC", "N m", "rad", "degC"),
    ],
)
def test_units_are_those_of_the_joint(unit: str, load: str, position: str, written: str) -> None:
    assert joint_unit(unit, load, position) == written
