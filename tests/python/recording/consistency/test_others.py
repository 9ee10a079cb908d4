"""A joint read from a file in which other joints move."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest
import stribeck as sb


@pytest.mark.parametrize(("swing", "moves"), [(1.0, True), (0.01, False)])
def test_other_joints_that_move_are_told(swing: float, moves: bool) -> None:
    t = np.arange(1000) / 100.0
    table = pl.DataFrame(
        {
            "t": t,
            "q_1": np.sin(t),
            "dq_1": np.cos(t),
            "tau_1": np.sign(np.cos(t)),
            "q_2": swing * np.sin(2.0 * t),
            "dq_2": 2.0 * swing * np.cos(2.0 * t),
            "tau_2": np.sign(np.cos(2.0 * t)),
        }
    )
    names = ["time=t", "position=q_1", "velocity=dq_1", "torque=tau_1"]
    found = [c for c in sb.read(table, map=names).checks if c.check == "others"]
    assert [c.said.split(" as well")[0] for c in found] == (["joint 2 moves"] if moves else [])


def test_columns_of_one_matrix_are_no_joints() -> None:
    """A velocity and a torque beside the position in the columns of a matrix without names."""
    t = np.arange(1000) / 100.0
    torque = 2.0 * np.sign(np.cos(t)) - 0.5 * np.sin(t)
    table = pl.DataFrame({"x_1": t, "x_2": np.sin(t), "x_3": np.cos(t), "x_4": torque})
    names = ["time=x_1", "position=x_2", "velocity=x_3", "torque=x_4"]
    found = {check.check: check for check in sb.read(table, map=names).checks}
    assert "others" not in found and found["torque"].ok


def test_the_torque_of_a_joint_that_moves_along_is_not_proposed() -> None:
    """Its torque goes with this motion too, since both joints move as one."""
    rng = np.random.default_rng(0)
    t = np.arange(4000) / 100.0
    q = np.sin(t) + 0.3 * np.sin(3.3 * t)
    v = np.cos(t) + 0.99 * np.cos(3.3 * t)
    torque = np.sign(v) + 0.2 * v
    table = pl.DataFrame(
        {"t": t, "q_1": q, "dq_1": v, "tau_1": torque}
        | {"q_2": 0.9 * q, "dq_2": 0.9 * v, "tau_2": torque + 0.8 * rng.standard_normal(t.size)}
    )
    names = ["time=t", "position=q_2", "velocity=dq_2", "torque=tau_2"]

    def read(**instead: pl.Expr) -> sb.Recording:
        return sb.read(table.with_columns(**instead), map=names)

    read().require_consistent()
    # A joint that moves in another way has no such torque.
    other = np.cos(2.7 * t)
    with pytest.raises(sb.RecordingError, match="torque=tau_1"):
        read(q_1=pl.Series(np.sin(2.7 * t) / 2.7), dq_1=pl.Series(other)).require_consistent()
