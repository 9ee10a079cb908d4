"""What every generator hands over: a recording, the truth about it, and its own best model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import polars as pl
from numpy.typing import NDArray

Array = NDArray[np.float64]


#: What is hidden in a recording, as it is stored.
Truth: TypeAlias = dict[str, Any]


@dataclass(frozen=True)
class Oracle:
    """The generator's own formula about its true parameters, evaluated at the recorded channels.

    Attributes
    ----------
    prediction : array [n]
        Torque of every row at the true parameters.
    tangents : dict of arrays [n]
        Change of the torque for each parameter by name, per its true value. Amplitudes enter
        linearly or nearly so, and start at the truth: one step of least squares refits them.
    """

    prediction: Array
    tangents: Mapping[str, Array]


@dataclass(frozen=True)
class Sample:
    """One recording with hidden effects.

    Attributes
    ----------
    frame : polars.DataFrame
        The recording: time, position, velocity, acceleration, torque, load_torque, temperature.
    truth : dict
        ``hidden`` (or ``["none"]``), ``implied`` (simpler effects that a hidden one contains),
        ``cannot_show``, ``sizes`` over the noise, ``noise_rms`` and what was drawn.
    oracle : Oracle
        The best model there is of this recording.
    """

    frame: pl.DataFrame
    truth: Truth
    oracle: Oracle


def tangents(
    predict: Callable[[Mapping[str, float]], Array],
    values: Mapping[str, float],
    prediction: Array,
    step: float = 1e-3,
) -> dict[str, Array]:
    """Relative change of a prediction with each of its parameters, by a forward difference."""
    return {
        name: (predict({**values, name: value * (1 + step)}) - prediction) / step
        for name, value in values.items()
    }
