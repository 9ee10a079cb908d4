"""Parameters printed in the papers give the torques of their joints."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from mpmath import mpf
from stribeck.models.catalog import catalog
from stribeck.models.published.sets import every_set

from laws import published
from laws.points import Point
from laws.reference import STATIC, evaluate
from laws.test_static import assert_within, error_of_value

SPEEDS = (1e-6, 1e-3, 0.01, 0.1, 0.5, 1.0, 2.0, 3.0)
#: Not printed with table 7: the smoothing speed, and a room's temperature for T0. Bittencourt et
#: al. fix the exponent.
CONSTANTS = {"smoothing_velocity": 0.01, "base_temperature": 20.0, "stribeck_exponent": 1.3}


def at(law: str, parameters: dict[str, float], v: float, T: float = 30.0, tl: float = 0.0) -> Point:
    """One speed of a motoring joint."""
    inputs = {"v": v, "T": T, "tl": tl, "tm": 10.0 * v, "te": 0.0, "a": 0.0, "q": 0.0}
    known = catalog()["laws"][law]["constants"]
    constants = {name: x for name, x in CONSTANTS.items() if name in known}
    return Point(law, parameters, inputs, constants)


def assert_exact(point: Point) -> None:
    """The torque is the reference's."""
    assert_within([(error_of_value(point, "double"), point)], share=1)


def torque(point: Point) -> float:
    return float(point.model.torque(**point.channels)[0])


@pytest.mark.parametrize("law", list(published.VELOCITY_LAWS))
def test_velocity_laws_of_table_7_agree_on_joint_1(law: str) -> None:
    """The same joint, fitted 14 times: they must lie close together at working speeds.

    The bounds are the outermost laws' own torques to the digits printed.
    """
    parameters = published.VELOCITY_LAWS[law]
    assert 22.645 <= torque(at(law, parameters, 1.0)) <= 25.495
    assert 33.15 <= torque(at(law, parameters, 2.0)) <= 35.05


@pytest.mark.parametrize(
    ("law", "expected"), [("coulomb", 22.65), ("makkar", 24.33), ("gaz_b", 25.49)]
)
def test_torques_of_table_7_at_1_rad_per_s(law: str, expected: float) -> None:
    assert torque(at(law, published.TABLE_7[law], 1.0)) == pytest.approx(expected, abs=0.005)


@pytest.mark.parametrize("law", list(published.THERMAL_LAWS))
def test_thermal_laws_of_table_7_agree_on_joint_1(law: str) -> None:
    """At 30 degC and no load they repeat the velocity laws, less closely: a warmer joint."""
    parameters = published.THERMAL_LAWS[law]
    assert 19.0 <= torque(at(law, parameters, 1.0)) <= 26.5
    assert 27.4 <= torque(at(law, parameters, 2.0)) <= 37.7


def test_bittencourt_b_thins_with_temperature() -> None:
    """21.7 N m at 30 degC and 1 rad/s; with the print's exp(+T/a12) it would be 12 705."""
    point = at("bittencourt_b", published.TABLE_7["bittencourt_b"], 1.0)
    assert torque(point) == pytest.approx(21.66, abs=0.005)
    parameters, inputs = point.exact
    misprinted = evaluate(STATIC[point.law], {**parameters, "a12": mpf("-6.95")}, inputs).value
    assert float(misprinted) == pytest.approx(12705, abs=0.5)


def test_iskandar_of_table_7_bears_its_vanishing_stribeck_speed() -> None:
    """vs(T) crosses zero at 14.65 and 55.3 degC with the printed values."""
    parameters = published.TABLE_7["iskandar"]
    roots = np.roots([parameters["a7"], parameters["a6"], parameters["a5"]])
    np.testing.assert_allclose(sorted(roots), [14.65, 55.35], atol=0.05)
    for T in roots:
        for v in (1e-12, 0.1, -0.1):
            assert_exact(at("iskandar", parameters, v, T=float(T)))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("law", [*published.VELOCITY_LAWS, *published.THERMAL_LAWS])
def test_table_7_against_the_reference(law: str, sign: float) -> None:
    for v in SPEEDS:
        for T, tl in ((30.0, 0.0), (22.0, 25.0), (45.0, -40.0)):
            point = at(law, published.TABLE_7[law], sign * v, T, tl)
            assert_exact(point)


@pytest.mark.parametrize(
    ("law", "speed", "expected"),
    [
        ("lugre", np.pi, 1.905),
        ("indri_b", np.pi, 1.891),
        ("tadese_t", 2.1096, 2.0),
        ("dahl", 3.0774, 2.0),
    ],
)
def test_dynamic_laws_of_table_7_sit_at_eulers_limit(
    law: str, speed: float, expected: float
) -> None:
    """s0 |v| dt/D at the review's 500 Hz: forward Euler diverges above 2."""
    model = sb.model(law, **published.DYNAMIC_LAWS[law])
    dry = model.split(speed, temperature=30.0, acceleration=0.0)["dry"][0]
    if law == "indri_b":
        dry /= 2 / np.pi * np.arctan(model.values[4] * speed)
    assert model.values[0] * speed / dry / 500 == pytest.approx(expected, abs=5e-4)


def test_direct_drive_breaks_away_at_the_sum_of_its_levels() -> None:
    """Seed table 1: c0 + c1 just above rest: 8.4 and -7.4 N m for joint 1, +-3 for joint 2."""
    for joint, (forward, backward) in {1: (8.4, -7.4), 2: (3.0, -3.0)}.items():
        parameters = published.direct_drive(joint)
        assert torque(at("indri_static", parameters, 1e-9)) == pytest.approx(forward, abs=1e-6)
        assert torque(at("indri_static", parameters, -1e-9)) == pytest.approx(backward, abs=1e-6)
        for v in (*SPEEDS, *(-v for v in SPEEDS)):
            assert_exact(at("indri_static", parameters, v))


def test_ball_screw_map() -> None:
    """12 300 N at the edge of motion, 10 300 N plus viscous friction beyond the Stribeck speed."""
    p = published.GANTRY
    assert torque(at("gantry_map", p, 1e-9)) == pytest.approx(12300, rel=1e-6)
    assert torque(at("gantry_map", p, 0.1)) == pytest.approx(10300 + 321.89, rel=1e-9)
    assert torque(at("gantry_map", p, -0.1)) == pytest.approx(-10300 - 1527.7, rel=1e-9)


def test_speed_only_model_of_an_industrial_joint() -> None:
    """M0: Fs is the height above Coulomb friction, not the static level."""
    assert torque(at("m0", published.M0, 1e-9)) == pytest.approx(0.049 + 0.0844, rel=1e-6)
    for v in (1.0, 8.7, 50.0, 133.0, 280.0, -50.0):
        assert_exact(at("m0", published.M0, v))


def test_full_model_of_an_industrial_joint() -> None:
    """M* of tables I and II over the ranges of figures 6 and 7."""
    for v in (1.0, 8.7, 50.0, 133.0, 280.0, -50.0):
        for T, tl in ((34.0, 0.0), (34.0, -0.73), (38.0, -0.02), (80.0, -0.72), (25.0, 0.3)):
            point = at("m_star", published.M_STAR, v, T, tl)
            assert_exact(point)


def test_load_and_temperature_parts_of_the_full_model_are_independent() -> None:
    """Figure 8: what load adds is the same cold and warm, and equals m1's load terms."""
    p = published.M_STAR
    m1 = {
        "Fc0": 0.0,
        "Fc_load": p["Fc_load"],
        "Fs0": 0.0,
        "Fs_load": p["Fs_load"],
        "vs": p["vs_load"],
        "Fv": 0.0,
    }
    for v in (2.0, 9.07, 100.0):
        by_load = torque(at("m1", m1, v, tl=-0.7))
        for T in (38.0, 80.0):
            added = torque(at("m_star", p, v, T, -0.7)) - torque(at("m_star", p, v, T))
            assert added == pytest.approx(by_load, rel=1e-12)


#: Largest speeds of the sets that are not of a robot's joint, rad/s or m/s.
FASTEST = {"m0": 280.0, "m_star": 280.0, "gantry_map": 0.2}


@pytest.mark.parametrize(
    "id",
    [
        one.id
        for one in every_set().values()
        if one.model.spec in STATIC and not one.missing and "/table_7/" not in one.id
    ],
)
def test_every_static_set_as_printed_against_the_reference(id: str) -> None:
    """The numbers as printed, in the paper's formula at 50 digits and in the law."""
    one = every_set()[id]
    law = one.model.law
    top = FASTEST.get(law, 3.0)
    for share in (1e-6, 1e-3, 0.03, 0.4, 1.0):
        for way, temperature, load, motor in ((1, 40.0, -0.3, 0.9), (-1, 30.0, 0.4, -0.5)):
            v = way * share * top
            inputs = {"v": v, "T": temperature, "tl": load, "tm": motor, "te": -load}
            inputs |= {"a": 0.0, "q": 0.0}
            assert_exact(Point(law, published.printed(id), inputs, dict(one.model.constants)))


def test_lugre_of_1995_slides_along_its_stribeck_curve() -> None:
    """g + sigma_2 v of the paper's eqs 4 to 6, after a long slide at one speed."""
    lugre = sb.published("canudas_de_wit_1995/table_1/lugre")
    for v in (-0.01, -0.001, 0.0005, 0.002, 0.1):
        settled = lugre.torque(np.full(50, v), dt=1.0)[-1]
        curve = 1.0 + 0.5 * np.exp(-((v / 0.001) ** 2))
        assert settled == pytest.approx(np.sign(v) * curve + 0.4 * v, rel=1e-12)
