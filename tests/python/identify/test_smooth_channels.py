"""What a delay shifts: at rest, friction of the motion that begins or ends."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb


@pytest.mark.parametrize("delay", [-0.018, 0.018])
@pytest.mark.parametrize("noise", [0.0, 1e-3, 2e-3])
def test_a_delay_is_found_where_the_joint_rests_between_moves(delay: float, noise: float) -> None:
    """A law knows no friction at rest, where the noise of the velocity decides its direction."""
    rng = np.random.default_rng(0)
    t = np.arange(0.0, 60.0, 0.005)
    # Moves of 1 s to and fro, with rests of 1 s; the torque rises before a move and stays after it.
    way = np.where(t % 4.0 < 2.0, 1.0, -1.0)
    v = way * np.where(t % 2.0 < 1.0, np.sin(np.pi * (t % 1.0)) ** 2, 0.0)
    later = np.where((t + 0.5) % 4.0 < 2.0, 1.0, -1.0)
    torque = 2.0 * np.where(v == 0.0, later, way) + 3.0 * v
    torque = np.interp(t - delay, t, torque) + 0.02 * rng.standard_normal(t.size)
    seen = v + noise * rng.standard_normal(t.size)
    r = sb.Recording.from_columns(time=t, velocity=seen, friction_torque=torque)
    fit = sb.fit("coulomb+delay", r, starts=4)
    assert fit.model.value("delay") == pytest.approx(delay, abs=1e-3)
    assert fit.model.value("coulomb_friction") == pytest.approx(2.0, abs=0.02)
    assert fit.rmse_held_out == pytest.approx(0.02, rel=0.2)
