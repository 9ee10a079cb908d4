"""Simulated motions against a stiff solver, and what LuGre was made to show."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import stribeck as sb
from scipy.integrate import solve_ivp
from stribeck.motion.simulate.drive import Controller, Follow, Pull, Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.trajectory import Quintic

#: Canudas de Wit et al. 1995, table 1.
LUGRE_1995 = {"a1": 1e5, "a2": 1e5**0.5, "a3": 0.4, "a4": 1.0, "a5": 1.5, "a6": 1e-3, "a7": 2.0}


def lugre_1995() -> sb.Model:
    return sb.model("lugre", **LUGRE_1995)


def lugre_rates(v, z, values):
    """Friction and bristle rate, written down from the paper."""
    g = values["a4"] + (values["a5"] - values["a4"]) * np.exp(-((v / values["a6"]) ** 2))
    rate = v - values["a1"] * abs(v) / g * z
    return values["a1"] * z + values["a2"] * rate + values["a3"] * v, rate


def test_stick_slip_agrees_with_a_stiff_solver():
    def rates(t, y):
        x, v, z = y
        friction, rate = lugre_rates(v, z, LUGRE_1995)
        return [v, 2.0 * (0.1 * t - x) - friction, rate]

    seconds = 16.0
    times = np.linspace(0.0, seconds, 3201)
    exact = solve_ivp(
        rates, (0.0, seconds), [0.0, 0.0, 0.0], "Radau", times, rtol=1e-9, atol=1e-12, max_step=0.01
    )
    step = 1e-4
    pulled = sb.simulate(
        lugre_1995(), Joint.prismatic(1.0), Pull(2.0, 0.1), seconds=seconds, step=step
    )
    at = np.interp(times, pulled.instants, pulled.instant_position)
    assert np.abs(at - exact.y[0]).max() < 2e-4  # of 0.127 m a slip


def test_second_order_in_the_step():
    values = {"a1": 800.0, "a2": 3.0, "a3": 0.5, "a4": 1.0, "a5": 1.4, "a6": 0.2, "a7": 2.0}

    def rates(t, y):
        q, v, z = y
        friction, rate = lugre_rates(v, z, values)
        gravity = 2.0 * np.cos(q) + 0.5 * np.sin(q)
        return [v, (5.0 - gravity - friction) / 0.3, rate]

    exact = solve_ivp(rates, (0.0, 1.0), [0.0, 0.0, 0.0], "Radau", rtol=1e-11, atol=1e-13)
    joint = Joint.revolute(0.3, gravity_cos=2.0, gravity_sin=0.5)
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        pushed = sb.simulate(
            sb.model("lugre", **values), joint, Torque(5.0), seconds=1.0, step=step
        )
        errors.append(abs(pushed.position_end - exact.y[0, -1]))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 1.8), (errors, orders)


def break_away(rate: float) -> float:
    """Most friction that a mass meets until it slides, when the force grows at `rate` (N/s)."""
    seconds, step = 3.0 / rate, min(1e-3, 2e-3 / rate)
    force = rate * (np.arange(round(seconds / step)) + 0.5) * step
    pushed = sb.simulate(lugre_1995(), Joint.prismatic(1.0), Torque(force), step=step)
    sliding = np.argmax(pushed.velocity > 5e-3)
    return float(pushed.friction_torque[:sliding].max())


def test_the_break_away_force_falls_with_the_rate_of_the_force():
    forces = [break_away(rate) for rate in (0.1, 1.0, 5.0, 20.0, 50.0)]
    assert all(a > b for a, b in itertools.pairwise(forces)), forces
    assert 1.3 < forces[0] < 1.5  # at most the static friction
    assert 1.0 < forces[-1] < 1.25  # at least Coulomb friction


def test_sliding_friction_lags_the_speed():
    """With the speed around 1 mm/s, friction is higher while it rises, the more the faster."""
    friction = lugre_1995()
    widths = []
    for frequency in (1.0, 10.0, 25.0):
        step = 1e-4 / frequency
        time = np.arange(round(3.0 / frequency / step)) * step
        speed = 1.5e-3 * (1.0 + 0.6 * np.sin(2.0 * np.pi * frequency * time))
        torque = friction.torque(speed, dt=step)
        last = time > 2.0 / frequency
        rising = last & (np.gradient(speed) > 0.0)
        falling = last & ~rising
        middle = 1.5e-3
        order_up, order_down = (
            rows[np.argsort(speed[rows])] for rows in (rising.nonzero()[0], falling.nonzero()[0])
        )
        up = np.interp(middle, speed[order_up], torque[order_up])
        down = np.interp(middle, speed[order_down], torque[order_down])
        widths.append(up - down)
    assert 0.0 < widths[0] < widths[1] < widths[2]


def test_presliding_is_a_closed_loop_that_takes_energy():
    """A force below break-away, back and forth: the same loop each time, some micrometres wide."""
    step, period = 1e-3, 10.0
    time = (np.arange(round(4 * period / step)) + 0.5) * step
    force = 0.9 * np.sin(2.0 * np.pi * time / period)
    moved = sb.simulate(lugre_1995(), Joint.prismatic(1.0), Torque(force), step=step)
    cycle = round(period / step)
    third, fourth = (moved.instant_position[k * cycle : (k + 1) * cycle + 1] for k in (2, 3))
    assert np.abs(fourth - third).max() < 1e-2 * np.ptp(third)
    assert 1e-5 < np.ptp(third) < 1e-4
    assert moved.friction_work[-cycle:].sum() > 1e-6 * 0.9 * np.ptp(third)


def test_integral_control_hunts_about_its_goal():
    """With stiction above Coulomb friction an integrator never comes to rest (1995, section V)."""
    friction = sb.model("bittencourt_a", a1=1.0, a2=0.5, a3=1e-3, a4=2.0, a5=0.4)
    controller = Controller(proportional=3.0, derivative=6.0, integral=4.0)
    hold = Follow(Quintic(1.0, 0.0, 1e6, dwell=1e6), controller)
    moved = sb.simulate(friction, Joint.prismatic(1.0), hold, seconds=100.0, position=0.0)
    late = moved.position[50_000:]
    rest = np.diff(np.sign(np.round(late - 1.0, 6)))
    assert np.abs(late - 1.0).max() > 1e-3  # it stands off its goal ...
    assert np.count_nonzero(rest) >= 4  # ... on either side of it in turn
    assert np.mean(moved.velocity[50_000:] == 0.0) > 0.5  # and sticks in between


@pytest.mark.parametrize("law", ["coulomb", "lugre"])
def test_a_recording_of_a_simulation_gives_the_model_back(law, tmp_path):
    """Simulated, written, read, fitted: a joint stops within a step, and a bristle's torque at the
    end of a step is its mean to second order."""
    if law == "coulomb":
        true, exact = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5), 2e-3
    else:
        exact = 5e-3
        true = sb.model("lugre", a1=500.0, a2=2.0, a3=0.5, a4=2.0, a5=3.0, a6=0.1, a7=2.0)
    joint = Joint.revolute(0.3, gravity_cos=1.0)
    closed = Follow(Quintic(0.0, 1.0, 1.5, dwell=0.2), Controller(300.0, 19.0))
    moved = sb.simulate(true, joint, closed, seconds=20.0, step=2e-3)
    path = tmp_path / "moved.parquet"
    moved.to_frame().write_parquet(path)
    found = sb.fit(law, sb.read(str(path)), starts=4)
    for name, value in zip(true.names, true.values, strict=True):
        assert found.model.value(name) == pytest.approx(value, rel=exact), name
