"""A motor apart from its load: elasticity and backlash."""

from __future__ import annotations

import json

import numpy as np
import pytest
import stribeck as sb
from click.testing import CliRunner
from scipy.integrate import solve_ivp
from stribeck.base.errors import SpecError
from stribeck.cli.main import cli
from stribeck.motion.simulate.drive import Controller, Follow, Torque
from stribeck.motion.simulate.joint import Joint, Transmission
from stribeck.motion.simulate.trajectory import Quintic

#: Friction that a stiff solver can follow, too.
SMOOTH = {"a1": 0.4, "a2": 1.0, "a3": 30.0}


def test_motor_and_load_agree_with_a_stiff_solver():
    stiffness, damping, gap = 900.0, 1.5, 0.04
    joint = Joint.revolute(0.6, gravity_cos=1.0)
    apart = Joint(
        joint.inertia, gravity_cos=1.0, transmission=Transmission(0.2, stiffness, damping, gap)
    )

    def torque(t):
        return 4.0 * np.sin(3.0 * t)

    def rates(t, y):
        q, v, load, speed = y
        twist = q - load
        stretch = np.sign(twist) * max(abs(twist) - 0.5 * gap, 0.0)
        pull = stiffness * stretch + damping * (v - speed) * (stretch != 0.0)
        friction = SMOOTH["a1"] * v + 2.0 * SMOOTH["a2"] / np.pi * np.arctan(SMOOTH["a3"] * v)
        return [v, (torque(t) - friction - pull) / 0.2, speed, (pull - np.cos(load)) / 0.6]

    seconds, step = 1.0, 1e-4
    exact = solve_ivp(
        rates, (0.0, seconds), np.zeros(4), "Radau", rtol=1e-9, atol=1e-11, max_step=1e-3
    )
    middles = (np.arange(round(seconds / step)) + 0.5) * step
    moved = sb.simulate(sb.model("shao", **SMOOTH), apart, Torque(torque(middles)), step=step)
    assert moved.position_end == pytest.approx(exact.y[0, -1], abs=2e-3)
    assert moved.instant_load_position[-1] == pytest.approx(exact.y[2, -1], abs=2e-3)
    assert "load_position" in moved.to_frame().columns
    assert abs(moved.energy["imbalance"]) < 1e-10


def test_play_shows_as_lost_motion():
    friction = sb.model("coulomb", a1=0.4, a2=1.0)
    follow = Follow(Quintic(0.0, 1.0, 1.0), Controller(400.0, 25.0))
    lost = {}
    for gap in (0.0, 0.03):
        joint = Joint(0.6, transmission=Transmission(0.2, 5e4, 50.0, gap))
        moved = sb.simulate(friction, joint, follow)
        lost[gap] = np.ptp(moved.instant_position - moved.instant_load_position)
    assert lost[0.0] < 1e-3
    assert lost[0.03] == pytest.approx(0.03, rel=0.1)


def test_the_command_takes_a_transmission():
    words = [
        "simulate",
        "coulomb",
        "--value",
        "a1=0.4",
        "--value",
        "a2=1",
        "--inertia",
        "0.6",
        "--motor-inertia",
        "0.2",
        "--transmission",
        "5e4",
        "--transmission-damping",
        "50",
        "--backlash",
        "0.01",
        "--json",
    ]
    done = CliRunner().invoke(cli, words, standalone_mode=False)
    assert done.exception is None
    assert json.loads(done.stdout)["tracking_error"]["largest"] < 0.1
    done = CliRunner().invoke(cli, words[:8], standalone_mode=False)
    assert done.exception is None
    done = CliRunner().invoke(cli, [*words[:8], "--backlash", "1"], standalone_mode=False)
    assert isinstance(done.exception, SpecError)
    assert "need --transmission" in str(done.exception)


def test_a_transmission_without_stiffness_is_refused():
    with pytest.raises(SpecError, match="give one above 0"):
        Transmission(0.2, 0.0)
