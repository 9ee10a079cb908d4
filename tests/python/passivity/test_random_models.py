"""Random models that are known to be passive, and known not to be: `check` is right on all.

The proofs are made beforehand and share nothing with the check: signs and published conditions on
one side, on the other a point or a closed cycle inside the box, integrated by hand.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple

import numpy as np
import pytest
import stribeck as sb
from bristle_cycles import Bristle, Cycles
from hypothesis import given, settings
from hypothesis import strategies as st

Case = tuple[sb.Model, dict[str, tuple[float, float]]]
Random = np.random.Generator

FEW, ALL = 12, 200


#: A box of different speeds each way.
SPEEDS = st.tuples(st.floats(0.05, 3.0), st.floats(0.05, 3.0)).map(
    lambda ends: {"velocity": (-ends[0], ends[1])}
)


def speeds(rng: Random, low: float = 0.05, high: float = 3.0) -> dict[str, tuple[float, float]]:
    """A box of different speeds each way."""
    return {"velocity": (-rng.uniform(low, high), rng.uniform(low, high))}


def lugre(bristle: Bristle) -> sb.Model:
    """The law of the catalog with the numbers of a bristle."""
    names = ("a1", "a2", "a3", "a4", "a5", "a6", "a7")
    return sb.model("lugre", **dict(zip(names, astuple(bristle), strict=True)))


def around_a_curve(bristle: Bristle) -> sb.Model:
    """The same bristle, put around a law with a Stribeck curve."""
    return sb.model(
        "coulomb+stribeck+presliding",
        viscous_friction=bristle.viscous,
        coulomb_friction=bristle.coulomb,
        stribeck_height=bristle.static - bristle.coulomb,
        stribeck_velocity=bristle.speed,
        stribeck_exponent=bristle.exponent,
        presliding_stiffness=bristle.stiffness,
        presliding_damping=bristle.damping,
    )


# Passive by construction.


@st.composite
def damped_as_published(draw: st.DrawFn) -> Case:
    """Barabanov and Ortega 2000: ``s2 > s1 (Fs - Fc)/Fc`` suffices at any speed."""
    coulomb, height = draw(st.floats(0.5, 3.0)), draw(st.floats(0.0, 2.0))
    damping = draw(st.floats(0.1, 100.0))
    viscous = 1.02 * damping * height / coulomb + 0.01
    vs, alpha = draw(st.floats(0.01, 0.3)), draw(st.floats(0.8, 2.5))
    bristle = Bristle(1e4, damping, viscous, coulomb, coulomb + height, vs, alpha)
    return lugre(bristle), draw(SPEEDS)


@st.composite
def constant_strength(draw: st.DrawFn) -> Case:
    """With constant D the deflection stays in range, and the model is passive at any damping."""
    model = sb.model(
        "coulomb+presliding",
        viscous_friction=draw(st.floats(0.0, 1.0)),
        coulomb_friction=draw(st.floats(0.3, 5.0)),
        presliding_stiffness=10 ** draw(st.floats(2.0, 6.0)),
        presliding_damping=10 ** draw(st.floats(-1.0, 4.0)),
    )
    return model, draw(SPEEDS)


@st.composite
def spring_and_slider(draw: st.DrawFn) -> Case:
    """Dahl's bristle without damping, with a slope of constant sign."""
    a1, a2, a3 = draw(st.floats(2.0, 5.0)), draw(st.floats(0.2, 5.0)), draw(st.floats(0.5, 2.0))
    return sb.model("dahl", a1=10**a1, a2=a2, a3=a3), draw(SPEEDS)


@st.composite
def sums_of_friction(draw: st.DrawFn) -> Case:
    """Each term alone opposes the motion."""
    ranges = ((0.1, 3.0), (0.1, 3.0), (0.01, 1.0), (0.5, 3.0), (0.0, 2.0), (0.3, 2.0))
    values = {f"a{k}": draw(st.floats(*ends)) for k, ends in enumerate(ranges, 1)}
    return sb.model("wolf", **values), draw(SPEEDS)


@st.composite
def heavier_with_load(draw: st.DrawFn) -> Case:
    """Dry friction that grows with the load and falls with temperature, but not to zero."""
    coldest, warmest, reference = 20.0, 45.0, 30.0
    model = sb.model(
        "coulomb+load+temperature_dry",
        constants={"reference_load": 10.0, "reference_temperature": reference},
        viscous_friction=draw(st.floats(0.0, 1.0)),
        coulomb_friction=draw(st.floats(0.5, 3.0)),
        load_coulomb=draw(st.floats(0.0, 0.3)),
        load_exponent=1.0,
        temperature_dry_slope=-draw(st.floats(0.0, 0.9)) / (warmest - reference),
        temperature_dry_curvature=0.0,
        temperature_dry_load=0.0,
    )
    box = {"temperature": (coldest, warmest), "load_torque": (-30.0, 20.0)}
    return model, draw(SPEEDS) | box


PASSIVE = st.one_of(
    damped_as_published(),
    constant_strength(),
    spring_and_slider(),
    sums_of_friction(),
    heavier_with_load(),
)


# Not passive, with a motion that shows it.


def giving_bristle(rng: Random) -> tuple[Bristle, float]:
    """A bristle, and a speed up to which a closed cycle generates energy.

    More than a millionth of what its spring holds on the way: far above rounding.
    """
    while True:
        coulomb = rng.uniform(0.5, 3.0)
        bristle = Bristle(
            10 ** rng.uniform(4.0, 5.5),
            rng.uniform(10.0, 500.0),
            rng.uniform(0.0, 0.05),
            coulomb,
            coulomb + rng.uniform(0.3, 2.0),
            rng.uniform(1e-3, 0.05),
            rng.uniform(1.0, 2.5),
        )
        limit = rng.uniform(0.1, 1.0)
        cycles = Cycles.inside(bristle, limit, 4000, rng)
        if np.any(cycles.work < -1e-6 * cycles.energy):
            return bristle, limit


def broken_by_a_cycle(rng: Random) -> Case:
    """A law of the catalog with its own bristle."""
    bristle, limit = giving_bristle(rng)
    return lugre(bristle), {"velocity": (-limit, limit)}


def broken_as_composed(rng: Random) -> Case:
    """A law with two effects, one of them the bristle."""
    bristle, limit = giving_bristle(rng)
    return around_a_curve(bristle), {"velocity": (-limit, limit)}


def broken_at_a_point(rng: Random) -> Case:
    """A cubic that is below zero at one speed of the box."""
    while True:
        a = rng.uniform((0.2, 0.0, -4.0, 0.3), (2.0, 1.0, -0.5, 2.0))
        limit = rng.uniform(0.5, 3.0)
        v = np.linspace(0.0, limit, 2000)
        if np.min(a[0] + a[1] * v + a[2] * v**2 + a[3] * v**3) < -1e-6:
            model = sb.model("hao_a", **{f"a{k + 1}": value for k, value in enumerate(a)})
            return model, {"velocity": (-limit, 0.5 * limit)}


def pushed_by_load(rng: Random) -> Case:
    """Dry friction that a load in the box turns into a push."""
    coulomb, slope = rng.uniform(0.5, 3.0), rng.uniform(0.05, 0.5)
    model = sb.model(
        "coulomb+load",
        constants={"reference_load": 10.0},
        viscous_friction=rng.uniform(0.0, 0.2),
        coulomb_friction=coulomb,
        load_coulomb=-slope,
        load_exponent=1.0,
    )
    reach = 1.2 * coulomb / slope * 10.0
    at = model.torque([1e-3], load_torque=[reach])
    assert at[0] < 0.0
    return model, speeds(rng) | {"load_torque": (-reach, reach)}


ACTIVE = (broken_by_a_cycle, broken_as_composed, broken_at_a_point, pushed_by_load)


def case(kinds: tuple[Callable[[Random], Case], ...], number: int) -> Case:
    """One of the random models; the same number is the same model."""
    return kinds[number % len(kinds)](np.random.default_rng([number, len(kinds)]))


def bristle_of(model: sb.Model) -> Bristle:
    """The numbers of `lugre` or `around_a_curve`."""
    if model.law == "lugre":
        return Bristle(*model.values)
    viscous, coulomb, height, speed, exponent, stiffness, damping = model.values
    return Bristle(stiffness, damping, viscous, coulomb, coulomb + height, speed, exponent)


def sampled_work(model: sb.Model, example: sb.passivity.Counterexample) -> tuple[float, float]:
    """Work over a counterexample from the sampled torque, and the deflection at its end.

    The trapezoidal rule on `Model.torque` at the ends of short steps.
    """
    work, state = 0.0, example.deflection or 0.0
    for step in example.steps:
        held = {name: value for name, value in step.items() if name != "duration"}
        count = 20_000
        dt = step["duration"] / count
        # Between two stretches the torque jumps, the deflection does not.
        start = model.torque(**held, dt=0.0, state=state)
        columns = {name: np.full(count, value) for name, value in held.items()}
        torque = np.append(start, model.torque(**columns, dt=dt, state=state))
        work += float(np.sum(0.5 * (torque[1:] + torque[:-1]))) * held["velocity"] * dt
        if example.deflection is not None:
            state = bristle_of(model).deflection(held["velocity"], float(torque[-1]))
    return work, state


def generates_energy(number: int) -> None:
    """By the check, by the exact step and by the sampled torque."""
    model, box = case(ACTIVE, number)
    certificate = sb.check(model, box)
    assert certificate.passive is False, (number, model, box)
    example = certificate.counterexample
    assert example is not None
    for step in example.steps:
        for name, (low, high) in box.items():
            assert low <= step[name] <= high
    work, end = example.replay()
    assert work == example.net_work < 0.0
    sampled, left = sampled_work(model, example)
    assert sampled < 0.0
    assert sampled == pytest.approx(work, rel=1e-2)
    if example.deflection is not None:
        assert end == pytest.approx(example.deflection, rel=1e-9)
        assert left == pytest.approx(example.deflection, rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("number", range(FEW))
def test_known_to_generate_energy(number: int) -> None:
    generates_energy(number)


@settings(max_examples=ALL, deadline=None)
@given(PASSIVE)
def test_all_known_to_be_passive(case: Case) -> None:
    certificate = sb.check(*case)
    assert certificate.passive is True
    assert certificate.margin is not None
    assert certificate.margin >= 0.0


@pytest.mark.slow
def test_all_known_to_generate_energy() -> None:
    for number in range(ALL):
        generates_energy(number)
