"""What the figure behind a finding shows: residuals without and with an effect, in bins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.residual.regimes import REVERSAL_WINDOW, regime_rows
from stribeck.report.channels import channel, clock, view_of
from stribeck.report.style import binned_quartiles

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit

Array = NDArray[np.float64]

#: What the residual is multiplied by, as its label says.
ALONG = {None: "", "motion": " · sgn v", "load": " · sgn load"}
#: Which samples are drawn, where it is not all of them.
REGIMES = {
    "low_speed": "slowest quarter of the samples",
    "high_speed": "fastest quarter of the samples",
    "sliding": f"samples more than {REVERSAL_WINDOW} s from a reversal",
}


@dataclass(frozen=True)
class Curve:
    """One residual: its samples, and its quartiles in bins; too few samples have no bins."""

    samples: Array
    at: Array
    lower: Array
    median: Array
    upper: Array


@dataclass(frozen=True)
class FindingView:
    """Residuals against the channel in which an effect shows.

    Attributes
    ----------
    rows : array [n] of int
        The samples that are shown: those that were fitted to.
    x : array [n]
        The channel at these samples.
    log : bool
        Whether the channel is drawn on a logarithmic axis.
    without, with_it : Curve
        The residual of the model without and with the effect.
    """

    rows: NDArray[np.intp]
    x: Array
    x_label: str
    y_label: str
    log: bool
    without: Curve
    with_it: Curve


def finding_view(effect: str, before: Fit, after: Fit) -> FindingView:
    """The residuals of two models against the channel in which an effect shows."""
    view = view_of(effect)
    made, along = channel(after, view.channel), view.along
    if made is None:
        made, along = channel(after, "velocity") or clock(after.recording), None
    rows = _rows(before, view.regime)
    sign = _sign(after, along)
    x = made.values[rows]
    curves = []
    for fit in (before, after):
        y = (fit.residual * sign)[rows]
        curves.append(Curve(y, *binned_quartiles(x, y, log=view.log)))
    return FindingView(
        rows,
        x,
        made.label,
        f"residual{ALONG[along]} [{before.model.torque_unit}]",
        view.log and bool(np.all(x[x != 0] > 0)),
        *curves,
    )


def how_to_read(effect: str) -> list[str]:
    """What lines, bands and signs mean, in one or two sentences without a full stop."""
    view = view_of(effect)
    notes = ["above 0: the model has too little friction"] if view.along == "motion" else []
    if view.regime is not None:
        notes.append(REGIMES[view.regime])
    return ["line: median, band: middle half", *(["; ".join(notes)] if notes else [])]


def _sign(fit: Fit, along: str | None) -> Array:
    """What the residual is multiplied by, [n]."""
    if along is None:
        return np.ones_like(fit.residual)
    load = fit.load_torque if along == "load" else None
    return np.sign(fit.recording.velocity if load is None else load)


def _rows(fit: Fit, regime: str | None) -> NDArray[np.intp]:
    """The samples that were fitted to, or those of them in a regime."""
    if regime is None:
        return fit.rows
    regimes = regime_rows(fit)
    inside = ~regimes["reversal"] if regime == "sliding" else regimes[regime]
    return np.flatnonzero(inside & fit.recording.moving & ~fit.transient)
