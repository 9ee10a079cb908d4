"""Record `pinocchio.json`: `python tests/python/robot/record_pinocchio.py`; needs Pinocchio."""

from __future__ import annotations

import json
from pathlib import Path

import arms
import numpy as np
import pinocchio as pin


def recorded(name: str) -> dict[str, object]:
    """Two states of a robot."""
    model = pin.buildModelFromXML(arms.urdf(name))
    data = model.createData()
    names = list(model.names)[1:]
    q, v, a = arms.states(name, 2)
    made: dict[str, list[object]] = {
        key: []
        for key in ("torque", "mass_matrix", "gravity", "forward", "by_position", "by_velocity")
    }
    for state in zip(q, v, a, strict=True):
        torque = pin.rnea(model, data, *state).copy()
        upper = np.triu(pin.crba(model, data, state[0]))
        made["torque"].append(torque.tolist())
        made["mass_matrix"].append((upper + np.triu(upper, 1).T).tolist())
        made["gravity"].append(pin.computeGeneralizedGravity(model, data, state[0]).tolist())
        made["forward"].append(pin.aba(model, data, state[0], state[1], torque).tolist())
        by_position, by_velocity, _ = pin.computeRNEADerivatives(model, data, *state)
        made["by_position"].append(by_position.tolist())
        made["by_velocity"].append(by_velocity.tolist())
    motion = {"position": q.tolist(), "velocity": v.tolist(), "acceleration": a.tolist()}
    return {"joints": names, **motion, **made}


if __name__ == "__main__":
    path = Path(__file__).parent / "pinocchio.json"
    path.write_text(json.dumps({name: recorded(name) for name in arms.KINDS}) + "\n")
