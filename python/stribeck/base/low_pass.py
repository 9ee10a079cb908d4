"""Low-pass filters, by the core: one without phase, and one of first order.

`scipy.signal` has the same filters, but takes longer to import than most commands take to run.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck import _core

__all__ = ["first_order", "zero_phase"]

Array = NDArray[np.float64]

#: Samples by which each end is continued, as many as SciPy takes for this filter.
PADDING = 15


def zero_phase(values: Array, cutoff: float, rate: float, padding: int = PADDING) -> Array:
    """Filter the last axis of `values` [..., n] forwards and backwards, array [..., n].

    Parameters
    ----------
    cutoff, rate
        Cut-off of the Butterworth filter of fourth order, and sampling rate, both in Hz.
    padding
        Samples by which each end is continued, turned about its last value; at most n - 1.

    Raises
    ------
    stribeck._core.ModelError
        Unless the cut-off is above zero and below half the sampling rate.

    Examples
    --------
    >>> time = np.arange(400) / 200.0
    >>> slow, fast = np.sin(2 * np.pi * 1.0 * time), np.sin(2 * np.pi * 60.0 * time)
    >>> middle = zero_phase(slow + fast, cutoff=10.0, rate=200.0)[100:300]
    >>> bool(np.abs(middle - slow[100:300]).max() < 1e-3)
    True
    """
    rows = np.atleast_2d(values).reshape(-1, values.shape[-1])
    return _core.low_pass(rows, cutoff / rate, padding).reshape(values.shape)


def first_order(values: Array, steps: Array, lag: float) -> Array:
    """`values` [n] behind a first-order lag, array [n].

    Parameters
    ----------
    steps : array [n]
        Time since the sample before, s; where it is not above zero, the lag begins at rest.
    lag : float
        Time constant, s.

    Raises
    ------
    stribeck._core.ModelError
        Unless the lag is above zero.

    Examples
    --------
    >>> first_order(np.array([0.0, 1.0, 1.0]), np.array([0.0, 0.1, 0.1]), lag=0.2).round(3)
    array([0.   , 0.393, 0.632])
    """
    return _core.first_order(steps, values, lag)
