"""Whether the temperature is one that a joint may have."""

from __future__ import annotations

import numpy as np

from stribeck.base.errors import option
from stribeck.base.units import ABSOLUTE_ZERO
from stribeck.recording.arrays import Floats
from stribeck.recording.check import Check
from stribeck.recording.consistency.view import View, quoted

__all__ = ["check_temperature"]

#: Joints and their motors are between these, degC: cold stores, and the limit of windings.
_COLDEST, _HOTTEST = -60.0, 200.0
#: Units that a temperature may be in instead: gain and offset to degC.
_OTHER = {"K": (1.0, ABSOLUTE_ZERO), "degF": (5.0 / 9.0, -160.0 / 9.0)}
#: Scales of integers in logs.
_SCALES = (10.0, 100.0, 1000.0)


def check_temperature(view: View) -> Check | None:
    """Compare the temperature with what a joint may have.

    Returns
    -------
    Check or None
        None where no temperature was recorded.
    """
    values = view.recorded("temperature")
    if values is None:
        return None
    low, high = float(values.min()), float(values.max())
    if low == high and _plausible(low, high):
        return Check(
            "temperature",
            True,
            f"cannot check the temperature ('{view.column('temperature')}'): it is {low:.3g} degC "
            f"in every sample, so nothing can depend on it",
        )
    if _plausible(low, high):
        return Check("temperature", True, f"{low:.3g} to {high:.3g} degC is plausible")
    missing = _mark(values)
    if missing is not None:
        return _missing(view, missing, int((values == missing).sum()))
    possible = low >= ABSOLUTE_ZERO
    what = "which no joint has" if possible else "below absolute zero"
    said = f"'{view.column('temperature')}' is {low:.4g} to {high:.4g} degC, {what}"
    return Check("temperature", False, said, _remedy(view, low, high), trustable=possible)


def _mark(values: Floats) -> float | None:
    """The one value that stands for a missing one: all others are plausible."""
    wrong = values[(values < _COLDEST) | (values > _HOTTEST)]
    return float(wrong[0]) if wrong.size < values.size and np.ptp(wrong) == 0.0 else None


def _missing(view: View, value: float, count: int) -> Check:
    """The check of a temperature with a value that marks missing ones."""
    column = view.column("temperature")
    unit = view.prepared.choices["temperature"].unit
    stored = value if unit is None else (value - unit.offset) / unit.factor
    kept = f"{quoted(column)}!={stored:.10g}"
    where = view.prepared.settings.where
    do = (
        f"if it marks missing values, leave these samples out with "
        f"{option('where', kept if where is None else f'({where}) and {kept}')}"
    )
    samples = "1 sample" if count == 1 else f"{count} samples"
    said = f"'{column}' is {value:.4g} degC in {samples}, which no joint has"
    return Check("temperature", False, said, do, trustable=value >= ABSOLUTE_ZERO)


def _remedy(view: View, low: float, high: float) -> str:
    """The option with which the temperature is plausible; else the one that leaves it out."""
    for unit, (gain, offset) in _OTHER.items():
        if _plausible(gain * low + offset, gain * high + offset):
            column = view.column("temperature")
            return f"give {option('unit', f'{column}={unit}')}"
    # A scale moves no value across absolute zero.
    for scale in _SCALES if low >= ABSOLUTE_ZERO else ():
        if _plausible(low / scale, high / scale):
            return f"give {view.derived('temperature', f'{{}}/{scale:g}')}"
    return f"leave it out with {option('map', 'temperature=none')}"


def _plausible(low: float, high: float) -> bool:
    return low >= _COLDEST and high <= _HOTTEST
