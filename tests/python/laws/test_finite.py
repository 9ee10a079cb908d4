"""No overflow, NaN or infinity inside the bounds of the catalog."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
import stribeck as sb
from stribeck.models.catalog import law_ids

from laws.points import LARGEST, SCALES, SPEEDS, draw_constants, generator

#: Parameter sets per law, each parameter on its lower or upper bound.
CORNERS = 40
TEMPERATURES = (5.0, 30.0, LARGEST["T"])
TORQUES = (0.0, 1.0, -3.0, LARGEST["tl"], -LARGEST["tl"])
STEPS = (0.0, 1e-6, 1e-3, 1.0, 1e6)


def corner(law: str, rng: np.random.Generator) -> sb.Model:
    """The law with every parameter on a bound."""
    empty = sb.model(law, constants=draw_constants(rng, law))
    return empty.with_values(
        [SCALES[p.scale] * float(rng.choice([p.lower, p.upper])) for p in empty.parameters]
    )


def extremes(largest_speed: float) -> dict[str, np.ndarray]:
    """Every combination of extreme inputs, as columns."""
    speeds = [s * v for v in SPEEDS if v <= largest_speed for s in (1.0, -1.0)]
    rows = np.array(list(product(speeds, TEMPERATURES, TORQUES, STEPS)))
    v, temperature, torque, dt = rows.T
    return {
        "velocity": v,
        "temperature": temperature,
        "load_torque": torque,
        "motor_torque": np.roll(torque, 7),
        "external_torque": -torque,
        "acceleration": np.clip(v, -LARGEST["a"], LARGEST["a"]),
        "position": np.zeros_like(v),
        "dt": dt,
    }


@pytest.mark.parametrize("law", law_ids())
def test_torque_and_gradient_are_finite(law: str) -> None:
    rng = generator(law, "corner")
    columns = extremes(LARGEST["v"])
    shuffled = rng.permutation(columns["velocity"].size)
    columns = {name: column[shuffled] for name, column in columns.items()}
    for _ in range(CORNERS):
        model = corner(law, rng)
        for what, numbers in {
            "torque": model.torque(**columns),
            "gradient": model.gradient(**columns),
        }.items():
            bad = np.argwhere(~np.isfinite(numbers))
            assert not bad.size, f"{what} of {describe(model)} at {row(columns, bad[0][0])}"


@pytest.mark.parametrize("law", law_ids())
def test_torque_is_finite_in_single_precision(law: str) -> None:
    """Up to 1e6 rad/s, whose cube a single-precision number still holds."""
    rng = generator(law, "corner")
    columns = extremes(1e6)
    for _ in range(CORNERS):
        model = corner(law, rng)
        bad = np.flatnonzero(~np.isfinite(model.torque(**columns, precision="single")))
        assert not bad.size, f"torque of {describe(model)} at {row(columns, bad[0])}"


@pytest.mark.parametrize("law", ["li", "madsen"])
def test_temperatures_around_a_pole_are_refused(law: str) -> None:
    """T^-3 of li and (T - T0)^-3 of madsen are singular there."""
    model = corner(law, generator(law, "pole"))
    pole = model.constants.get("base_temperature", 0.0)
    for temperatures in ([pole - 1, pole + 1], [pole]):
        with pytest.raises(sb.SpecError, match="singular"):
            model.torque([1.0] * len(temperatures), temperature=temperatures, load_torque=0.0)


def describe(model: sb.Model) -> str:
    """The model's values by symbol."""
    values = {p.symbol: x for p, x in zip(model.parameters, model.values.tolist(), strict=True)}
    return f"{model.spec}({values}, {dict(model.constants)})"


def row(columns: dict[str, np.ndarray], index: int) -> dict[str, float]:
    """One row of the columns."""
    return {name: float(column[index]) for name, column in columns.items()}
