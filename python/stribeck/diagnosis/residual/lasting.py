"""The part of a residual that lasts longer than the noise of any sensor.

Noise of a sensor, behind its filters, is forgotten within a tenth of a second. What is still there
a quarter of a second later is torque, whether or not the joint passes the same state again. A
vibration changes its sign several times meanwhile, and its mean over these times is zero; that of a
slow oscillation is not, though it may be negative. Where it is zero by chance, that over other
times is not.
"""

from __future__ import annotations

import numpy as np

from stribeck.fitting.result import Fit

#: Share of the squared error from which it counts as structure.
STRUCTURE = 0.1
#: The residual is compared with itself from so many seconds later, after the noise, up to twice as
#: many, within a move. An oscillation whose mean is zero over the former has one over the latter.
AFTER = (0.2, 0.3)
#: Fewest samples between those compared, and fewest pairs of samples.
FEWEST_STEPS, FEWEST_PAIRS = 5, 300
#: Number of times from the first to the last.
TIMES = 9


def lasting_square(fit: Fit) -> float:
    """Mean square of the residual that lasts, in squared units of torque; 0 where it is not known.

    It is the size of the mean autocovariance over times after which noise is forgotten.
    """
    if fit.recording.averaged:
        return 0.0
    return max(_mean_autocovariance(fit, seconds) for seconds in AFTER)


def _mean_autocovariance(fit: Fit, seconds: float) -> float:
    """Its size, from some `seconds` up to twice as many; 0 where it is not known."""
    r = fit.recording
    first = max(seconds * r.rate_hz, FEWEST_STEPS)
    steps = np.unique(np.linspace(first, 2.0 * first, TIMES).round().astype(np.int64))
    residual = np.full(r.rows, np.nan)
    residual[fit.rows] = fit.residual[fit.rows] - fit.residual[fit.rows].mean()
    products = [
        (residual[:-step] * residual[step:])[r.segment[:-step] == r.segment[step:]]
        for step in steps
        if step < r.rows
    ]
    means = [float(np.nanmean(p)) for p in products if np.isfinite(p).sum() >= FEWEST_PAIRS]
    return abs(float(np.mean(means))) if len(means) == steps.size else 0.0
