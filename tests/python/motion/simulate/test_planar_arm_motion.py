"""A planar arm in motion, against a stiff solver and against its own identification."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from scipy.integrate import solve_ivp
from stribeck.base.errors import SpecError
from stribeck.fitting.methods.arm import arm_fit
from stribeck.motion.simulate.arm import PlanarArm, simulate_arm
from stribeck.motion.simulate.drive import Controller, Follow, Torque
from stribeck.motion.simulate.trajectory import Fourier

#: Nominal parameters of Indri et al., eq 15; the length of the first link is half of both.
ARM = PlanarArm(3.689, 0.97, 0.1, 0.275, 0.35)
LUGRE = (
    {"a1": 900.0, "a2": 5.0, "a3": 0.8, "a4": 4.0, "a5": 6.0, "a6": 0.2, "a7": 2.0},
    {"a1": 300.0, "a2": 1.0, "a3": 0.2, "a4": 1.0, "a5": 1.4, "a6": 0.2, "a7": 2.0},
)


def accelerations(q, v, torque):
    """Equation 4, written down from the kinetic energy of two links."""
    coupling = 0.35 * (0.97 * np.cos(q[1]) - 0.1 * np.sin(q[1]))
    slope = 0.35 * (-0.97 * np.sin(q[1]) - 0.1 * np.cos(q[1]))
    inertia = np.array(
        [[3.689 + 0.275 + 2.0 * coupling, 0.275 + coupling], [0.275 + coupling, 0.275]]
    )
    turning = slope * np.array([2.0 * v[0] * v[1] + v[1] ** 2, -(v[0] ** 2)])
    return np.linalg.solve(inertia, torque - turning)


def test_it_agrees_with_a_stiff_solver():
    def push(t):
        return np.array([9.0 * np.sin(2.0 * t), 2.5 * np.cos(5.0 * t)])

    def rates(t, y):
        q, v, z = y[:2], y[2:4], y[4:]
        friction, bristle = np.empty(2), np.empty(2)
        for joint, a in enumerate(LUGRE):
            g = a["a4"] + (a["a5"] - a["a4"]) * np.exp(-((v[joint] / a["a6"]) ** 2))
            bristle[joint] = v[joint] - a["a1"] * abs(v[joint]) / g * z[joint]
            friction[joint] = a["a1"] * z[joint] + a["a2"] * bristle[joint] + a["a3"] * v[joint]
        return np.concatenate([v, accelerations(q, v, push(t) - friction), bristle])

    seconds = 2.0
    exact = solve_ivp(rates, (0.0, seconds), np.zeros(6), "Radau", rtol=1e-9, atol=1e-11)
    models = [sb.model("lugre", **values) for values in LUGRE]
    errors = []
    for step in (2e-3, 1e-3):
        middles = (np.arange(round(seconds / step)) + 0.5) * step
        first, second = push(middles)
        moved = simulate_arm(models, ARM, [Torque(first), Torque(second)], step=step)
        errors.append(np.abs(moved.instant_position[-1] - exact.y[:2, -1]).max())
    assert errors[1] < 1e-4
    assert errors[1] < 0.35 * errors[0]  # second order


def test_its_recording_gives_the_arm_back(tmp_path):
    friction = [sb.model("coulomb", a1=0.8, a2=5.0), sb.model("coulomb", a1=0.2, a2=1.0)]
    drives = [
        Follow(Fourier.from_rest(1.0, 10.0, seed=joint), Controller(kp, kd))
        for joint, (kp, kd) in enumerate(((4000.0, 240.0), (300.0, 18.0)))
    ]
    moved = simulate_arm(friction, ARM, drives, seconds=20.0, step=2e-3)
    path = tmp_path / "arm.parquet"
    moved.to_frame().drop("load_torque").write_parquet(path)
    fit = arm_fit(*(sb.read(str(path), joint=name) for name in "12"), first_link_length=0.35)
    found = PlanarArm.identified(fit)
    assert found.inertia_1 == pytest.approx(3.689, rel=2e-2)
    assert found.moment_2x == pytest.approx(0.97, rel=2e-2)
    assert found.inertia_2 == pytest.approx(0.275, rel=2e-2)
    assert fit.friction(1).value("coulomb_friction") == pytest.approx(5.0, rel=5e-2)


def test_an_arm_that_cannot_be_is_refused():
    with pytest.raises(SpecError, match="must exceed"):
        PlanarArm(1.0, 2.0, 0.0, 0.1, 0.5)
    model = sb.model("coulomb", a1=0.8, a2=5.0)
    with pytest.raises(SpecError, match="two models"):
        simulate_arm([model], ARM, [Torque(1.0)], seconds=1.0)
    with pytest.raises(SpecError, match="duration is unknown"):
        simulate_arm([model] * 2, ARM, [Torque(1.0)] * 2)
