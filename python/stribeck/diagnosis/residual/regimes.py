"""Regimes of a recording: slow and fast motion, both directions, cold and warm, and others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.fitting.result import Fit
from stribeck.recording.recording import Recording

#: A sample belongs to a reversal within this time of a change of direction, s.
REVERSAL_WINDOW = 0.2


def regime_rows(fit: Fit) -> dict[str, NDArray[np.bool_]]:
    """Samples of each regime, bool [n]; all but ``"standstill"`` among the scored samples."""
    r = fit.recording
    scored = fit.scored
    v = r.velocity
    rows = {"reversal": _near_reversal(r) & scored}
    speed = np.abs(v)
    low, high = np.quantile(speed[scored], [0.25, 0.75])
    rows["low_speed"] = scored & (speed <= low)
    rows["high_speed"] = scored & (speed >= high)
    rows["forward"] = scored & (v > 0)
    rows["backward"] = scored & (v < 0)
    power = v * r.torque
    rows["motoring"] = scored & (power > 0)
    rows["generating"] = scored & (power < 0)
    if r.temperature is not None and np.ptp(r.temperature[scored]) > 0:
        low, high = np.quantile(r.temperature[scored], [0.25, 0.75])
        rows["cold"] = scored & (r.temperature <= low)
        rows["hot"] = scored & (r.temperature >= high)
    low, high = np.quantile(r.time[scored], [0.25, 0.75])
    rows["start"] = scored & (r.time <= low)
    rows["end"] = scored & (r.time >= high)
    if r.enabled is not None and not r.enabled.all():
        rows["drive_on"] = scored & r.enabled
        rows["drive_off"] = scored & ~r.enabled
    rows["standstill"] = ~r.moving
    return rows


def _near_reversal(r: Recording) -> NDArray[np.bool_]:
    """Samples within `REVERSAL_WINDOW` of a change of direction in the same segment."""
    near = np.zeros(r.time.size, dtype=bool)
    moving = np.flatnonzero(r.moving)
    if moving.size < 2 or r.averaged:
        return near
    left, right = moving[:-1], moving[1:]
    turned = np.sign(r.velocity[right]) != np.sign(r.velocity[left])
    turned &= r.segment[right] == r.segment[left]
    for segment in np.unique(r.segment[left[turned]]):
        here = np.flatnonzero(r.segment == segment)
        mine = turned & (r.segment[left] == segment)
        # A change of direction lasts from the last sample before rest to the first after it.
        ends = np.sort(np.concatenate([r.time[left[mine]], r.time[right[mine]]]))
        at = np.searchsorted(ends, r.time[here])
        before = r.time[here] - ends[np.maximum(at - 1, 0)]
        after = ends[np.minimum(at, ends.size - 1)] - r.time[here]
        near[here] = np.minimum(np.abs(before), np.abs(after)) <= REVERSAL_WINDOW
    return near
