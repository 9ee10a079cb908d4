"""Whether the time stamps are in the unit that they are read in."""

from __future__ import annotations

import numpy as np

from stribeck.base.errors import option
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View
from stribeck.recording.recording import Recording

__all__ = ["check_clock"]

#: Time stamps since 1970 are between the years 2001 and 2096: in s, and in fractions of it.
_EPOCH = (1e9, 4e9)
_FRACTIONS = {"ms": 1e3, "us": 1e6, "ns": 1e9}
#: A clock of whole numbers that ticks no faster than this is in a fraction of a second, Hz.
_SLOW = 1.0
#: Steps that vary by more than this share (RMS) are told; a longer step has lost rows.
_UNEVEN, _LOST = 0.05, 1.9


def check_clock(view: View) -> Check | None:
    """Look for time stamps in milli-, micro- or nanoseconds that are read as seconds.

    Returns
    -------
    Check or None
        None for steady-state points, which have no clock.
    """
    recording = view.recording
    if recording.averaged or "time" not in view.prepared.choices:
        return None
    column, rate = view.column("time"), recording.rate_hz
    assumed = view.source("time").stated_by in ("name", "map")
    first = abs(float(recording.time[0]))
    for unit, per_second in _FRACTIONS.items():
        if assumed and _EPOCH[0] * per_second <= first < _EPOCH[1] * per_second:
            return Check(
                "time",
                False,
                f"'{column}' begins at {first:.4g} s: these are {unit} since 1970",
                f"give {option('unit', f'{column}={unit}')}",
            )
    motion = view.velocity
    confirmed = motion is not None and motion.agrees and abs(abs(motion.ratio) - 1.0) < 0.1
    told = motion is not None and motion.agrees
    if assumed and view.whole_clock and 0.0 < rate <= _SLOW and not told:
        steps = np.diff(recording.time)
        unit = "ms" if np.median(steps) < 1e3 else "us" if np.median(steps) < 1e6 else "ns"
        return Check(
            "time",
            False,
            f"'{column}' counts whole numbers, read as one sample each {1.0 / rate:.4g} s: it is "
            "in a fraction of a second",
            f"the likeliest unit is given by {option('unit', f'{column}={unit}')}",
        )
    said = f"{rate:.4g} Hz over {float(recording.dt.sum()):.4g} s"
    if not confirmed:
        said += ", the unit of time is not checked by the motion"
    uneven = _unevenness(recording)
    if uneven > _UNEVEN:
        said += (
            f"; steps vary by {100.0 * uneven:.2g} % (RMS): if time stamps jitter, which makes "
            "velocity and acceleration uncertain, log the clock of the controller"
        )
    return Check("time", True, said)


def _unevenness(recording: Recording) -> float:
    """RMS deviation of the steps within segments from their median, as a share of it."""
    steps = recording.dt[recording.dt > 0.0]
    if not steps.size:
        return 0.0
    middle = float(np.median(steps))
    # A step of several periods is a lost row, not an uneven clock.
    single = steps[steps < _LOST * middle]
    return float(np.sqrt(np.mean((single / middle - 1.0) ** 2)))
