"""Rigid bodies beside Pinocchio: recorded values in the fast test, the library in the slow one."""

from __future__ import annotations

import json
from pathlib import Path

import arms
import numpy as np
import pytest
from stribeck.robot.arm import Robot
from stribeck.robot.urdf import read_urdf

RECORDED = json.loads((Path(__file__).parent / "pinocchio.json").read_text())
#: Pinocchio's gravity.
GRAVITY = (0.0, 0.0, -9.81)
MOST = 1e-10


def robot(name: str, folder: Path) -> Robot:
    path = folder / f"{name}.urdf"
    path.write_text(arms.urdf(name))
    found = read_urdf(path)
    return Robot(found.name, found.joints, GRAVITY)


def apart(found: np.ndarray, expected: object) -> float:
    reference = np.asarray(expected)
    return float(np.max(np.abs(found - reference)) / np.max(np.abs(reference)))


@pytest.mark.parametrize("name", arms.KINDS)
def test_recorded_values(name: str, tmp_path: Path) -> None:
    made, recorded = robot(name, tmp_path), RECORDED[name]
    assert list(made.names) == recorded["joints"]
    position, velocity, acceleration = (
        np.array(recorded[key]) for key in ("position", "velocity", "acceleration")
    )
    assert apart(made.torque(position, velocity, acceleration), recorded["torque"]) < MOST
    assert apart(made.core.mass_matrix(position), recorded["mass_matrix"]) < MOST
    assert apart(made.core.gravity_torque(position), recorded["gravity"]) < MOST
    by_position, by_velocity, _ = made.torque_derivatives(position, velocity, acceleration)
    assert apart(by_position, recorded["by_position"]) < MOST
    assert apart(by_velocity, recorded["by_velocity"]) < MOST
    torque = np.array(recorded["torque"])
    found = made.core.forward_dynamics(position, velocity, torque)
    assert apart(found, recorded["forward"]) < MOST


@pytest.mark.slow
@pytest.mark.parametrize("name", arms.KINDS)
def test_thousand_states(name: str, tmp_path: Path) -> None:
    pin = pytest.importorskip("pinocchio")
    made = robot(name, tmp_path)
    model = pin.buildModelFromXML(arms.urdf(name))
    data = model.createData()
    order = [model.joints[model.getJointId(joint)].idx_v for joint in made.names]
    back = np.argsort(order)
    q, v, a = arms.states(name, 1000)
    rows = [state[:, back] for state in (q, v, a)]
    torque = np.array([pin.rnea(model, data, *state)[order] for state in zip(*rows, strict=True)])
    assert apart(made.torque(q, v, a), torque) < MOST
    regressor = np.array(
        [
            pin.computeJointTorqueRegressor(model, data, *state).copy()
            for state in zip(*rows, strict=True)
        ]
    )
    own = made.regressor(q, v, a).reshape(1000, len(order), len(order), 11)
    theirs = regressor.reshape(1000, len(order), len(order), 10)[:, order][:, :, order]
    assert apart(own[..., :10], theirs) < MOST
    mass = []
    for position in rows[0]:
        upper = np.triu(pin.crba(model, data, position))
        mass.append((upper + np.triu(upper, 1).T)[np.ix_(order, order)])
    assert apart(made.core.mass_matrix(q), mass) < MOST
    slopes = np.array(
        [
            [part[np.ix_(order, order)] for part in pin.computeRNEADerivatives(model, data, *state)]
            for state in zip(*rows, strict=True)
        ]
    )
    by_position, by_velocity, _ = made.torque_derivatives(q, v, a)
    assert apart(by_position, slopes[:, 0]) < MOST
    assert apart(by_velocity, slopes[:, 1]) < MOST
    back_torque = torque[:, back]
    forward = np.array(
        [
            pin.aba(model, data, *state)[order]
            for state in zip(rows[0], rows[1], back_torque, strict=True)
        ]
    )
    assert apart(made.core.forward_dynamics(q, v, torque), forward) < MOST
