"""What a recording says of its slow speeds where they show no lag of friction."""

from __future__ import annotations

import numpy as np
import stribeck as sb


def test_a_quantile_of_samples_is_not_said_of_passes() -> None:
    """A joint that creeps for most of the time, and passes its slow speeds in 0.1 s in between."""
    t = np.arange(20000) / 200.0
    v = 0.04 * np.sin(2.0 * np.pi * t / 40.0)
    fast = (t % 25.0) < 2.0
    v[fast] = np.sin(np.pi * (t[fast] % 25.0))
    rng = np.random.default_rng(0)
    torque = 2.0 * np.sign(v) + 0.5 * v + 0.02 * rng.standard_normal(t.size)
    r = sb.Recording.from_columns(time=t, velocity=v, torque=torque, load_torque=0.0 * t)
    rows = sb.diagnose(sb.fit("coulomb+stribeck", r, starts=2)).untestable
    (why,) = [row.why for row in rows if row.effect == "frictional_lag"]
    assert why.startswith("in nine of ten slow samples the joint")
    assert why.endswith(
        "too little to pass its slow speeds in 2 s, so that no lag of friction shows"
    )
