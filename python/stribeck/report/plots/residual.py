"""Residuals: over one channel, as the joint warms up, and by frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base.errors import SpecError
from stribeck.report.channels import channel
from stribeck.report.plots.friction import load_torque
from stribeck.report.plots.page import LABEL, TICKS, Page, centred
from stribeck.report.style import (
    GREY,
    MEASURED,
    MOST_POINTS,
    binned_quartiles,
    dots,
    thin,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Windows of time in which errors are counted.
_WINDOWS = 24
#: Fewest samples of a window, and of a spectrum.
_FEWEST, _SPECTRUM = 20, 256
#: Longest stretch of a spectrum, samples.
_STRETCH = 4096


def over_velocity(page: Page) -> Figure:
    """Residual over velocity."""
    return _over(page, "velocity", both_ways=False)


def over_position(page: Page) -> Figure:
    """Residual over position, forward and backward apart."""
    return _over(page, "position", both_ways=True)


def over_temperature(page: Page) -> Figure:
    """Residual over temperature, forward and backward apart."""
    return _over(page, "temperature", both_ways=True)


def _over(page: Page, name: str, *, both_ways: bool) -> Figure:
    r = page.fits[0].recording
    made = channel(page.fits[0], name)
    if made is None:
        raise SpecError(f"{r.path} has no {name} that varies: draw another figure")
    ways: list[tuple[str, NDArray[np.intp]]] = [("", np.flatnonzero(r.moving))]
    if both_ways:
        ways = [
            (word, np.flatnonzero(r.moving & (np.sign(r.velocity) == way)))
            for word, way in (("forward", 1.0), ("backward", -1.0))
        ]
        ways = [(word, rows) for word, rows in ways if rows.size]
    panels = page.panels(len(ways))
    for axes, (word, rows) in zip(panels, ways, strict=True):
        zero_line(axes)
        _residuals(page, axes, made.values, rows)
        axes.set_xlabel(f"{made.label}{f', moving {word}' if word else ''}")
        axes.set_ylabel(_residual_label(r))
    return page.finished(panels, measured=None)


def _residuals(page: Page, axes: Axes, x: Array, rows: NDArray[np.intp]) -> None:
    """Faint samples, and the median and middle half in bins, of each model."""
    some = thin(rows, MOST_POINTS // len(page.fits))
    for k, fit in enumerate(page.fits):
        colour = page.colour(k)
        dots(axes, x[some], fit.residual[some], colour)
        at, low, median, high = binned_quartiles(x[rows], fit.residual[rows])
        axes.fill_between(at, low, high, color=colour, alpha=0.18, linewidth=0)
        axes.plot(at, median, **page.line(k))  # type: ignore[arg-type]
    centred(axes, np.concatenate([fit.residual[rows] for fit in page.fits]))


def warm_up(page: Page) -> Figure:
    """RMS and mean of the residual in windows of time, and the temperature."""
    r = page.fits[0].recording
    if r.averaged:
        raise SpecError(f"{r.path} has steady-state points, which have no order in time")
    edges = np.linspace(0.0, float(r.elapsed[-1]), _WINDOWS + 1)
    window = np.clip(np.searchsorted(edges, r.elapsed, side="right") - 1, 0, _WINDOWS - 1)
    inside = [np.flatnonzero(r.moving & (window == k)) for k in range(_WINDOWS)]
    inside = [rows for rows in inside if rows.size >= _FEWEST]
    if not inside:
        raise SpecError(f"{r.path} is too short for errors in {_WINDOWS} windows of time")
    scale, unit = _unit_of_time(edges[-1])
    at = np.array([r.elapsed[rows].mean() for rows in inside]) / scale
    panels = page.panels(2, stacked=True)
    zero_line(panels[1])
    for k, fit in enumerate(page.fits):
        parts = [fit.residual[rows] for rows in inside]
        drawn = page.line(k)
        panels[0].plot(at, [np.sqrt(np.mean(part**2)) for part in parts], **drawn)  # type: ignore[arg-type]
        panels[1].plot(at, [part.mean() for part in parts], **drawn)  # type: ignore[arg-type]
    panels[0].set_ylim(bottom=0.0)
    panels[0].set_ylabel(f"RMS error [{r.torque_unit}]")
    panels[1].set_ylabel(f"mean error [{r.torque_unit}]")
    panels[1].set_xlabel(f"time [{unit}]")
    if r.temperature is not None:
        _temperature(panels[0], at, [float(r.temperature[rows].mean()) for rows in inside])
    return page.finished(panels, measured=None)


def _temperature(axes: Axes, at: Array, degrees: list[float]) -> None:
    beside = axes.twinx()
    beside.plot(at, degrees, color=GREY, linewidth=1.0, linestyle=(0, (1, 1)))
    beside.set_ylabel("temperature [°C]", fontsize=LABEL, color="#666666")
    beside.tick_params(labelsize=TICKS, length=2.5, pad=2, colors="#666666")
    for side in ("top", "left"):
        beside.spines[side].set_visible(False)


def _unit_of_time(seconds: float) -> tuple[float, str]:
    if seconds > 3 * 3600.0:
        return 3600.0, "h"
    return (60.0, "min") if seconds > 300.0 else (1.0, "s")


def spectrum(page: Page) -> Figure:
    """Amplitude spectral density of the residuals, and of the measured friction."""
    r = page.fits[0].recording
    rows = _longest_stretch(r)
    (axes,) = page.panels(1)
    friction = r.torque - load_torque(page.fits)
    axes.loglog(*_density(friction, rows, r), color=MEASURED, linewidth=0.8, alpha=0.6)
    for k, fit in enumerate(page.fits):
        axes.loglog(*_density(fit.residual, rows, r), **page.line(k))
    axes.grid(True, which="minor", color="#f2f2f2", linewidth=0.4)
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"spectral density in motion [{r.torque_unit}/√Hz]")
    return page.finished([axes], measured="measured friction", as_line=True)


def _longest_stretch(r: Recording) -> NDArray[np.intp]:
    """The longest segment without a gap."""
    if r.averaged:
        raise SpecError(f"{r.path} has steady-state points, which have no spectrum")
    longest = int(np.argmax(np.bincount(r.segment)))
    rows = np.flatnonzero(r.segment == longest)
    if rows.size < _SPECTRUM:
        raise SpecError(
            f"{r.path} has at most {rows.size} samples without a gap, a spectrum needs {_SPECTRUM}"
        )
    return rows


def _density(values: Array, rows: NDArray[np.intp], r: Recording) -> tuple[Array, Array]:
    """Frequencies above 0 and the amplitude spectral density of the scored samples among `rows`.

    Samples at rest count as zero, and the density is that of the time in motion.
    """
    moving = r.moving[rows]
    if not moving.any():
        raise SpecError(f"{r.path} has no motion in its longest stretch without a gap")
    scored = values[rows]
    masked = np.where(moving, scored - scored[moving].mean(), 0.0)
    length = min(_STRETCH, masked.size // 2)
    frequency, power = scipy.signal.welch(masked, fs=r.rate_hz, nperseg=length, detrend=False)
    return frequency[1:], np.sqrt(power[1:] / np.mean(moving))


def _residual_label(r: Recording) -> str:
    return f"residual [{r.torque_unit}]"
