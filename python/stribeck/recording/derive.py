"""Velocity, acceleration and smooth versions by zero-phase filters chosen from the data."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from stribeck.base import linear
from stribeck.base.low_pass import zero_phase
from stribeck.recording.arrays import Bools, Floats, Ints
from stribeck.recording.rows import segment_slices

__all__ = [
    "HIGHEST",
    "Smoother",
    "choose_cutoff",
    "curvature",
    "jumps",
    "motion_band",
    "slow_rate",
]

#: Highest cut-off, as a share of the sampling rate: above it, a filter removes next to nothing.
HIGHEST = 0.4
#: Cut-off over the frequency where motion meets noise.
_MARGIN = 1.5
#: Motion is seen where the spectrum is this many times the noise.
_ABOVE = 4.0
#: A jump is this many times the 99 % quantile of the change from step to step.
_JUMP = 20.0
#: Means of a slow channel over each run, between which its rate is taken.
_MEANS = 50
#: Steps within 1 % of their mean count as uniform.
_UNIFORM = 0.01


def _grid(t: Floats) -> tuple[Floats, bool]:
    """Return a uniform time grid over a segment and whether its samples already lie on it."""
    n = len(t)
    mean = (t[-1] - t[0]) / (n - 1)
    uniform = bool(np.all(np.abs(np.diff(t) - mean) <= _UNIFORM * mean))
    if uniform:
        return t, True
    step = float(np.median(np.diff(t)))
    count = max(n, round((t[-1] - t[0]) / step) + 1)
    return np.linspace(t[0], t[-1], count), False


def choose_cutoff(time: Floats, value: Floats, segment: Ints, differences: int) -> float | None:
    """Find the frequency above which a signal is only noise.

    The spectrum of the differenced signal (differencing keeps the strong slow motion from leaking
    over the weak fast one) is divided by the response of the difference. Its high-frequency plateau
    is the noise; motion ends at the highest frequency where the spectrum is clearly above it. The
    cut-off does not depend on the derivative that is wanted: motion and noise grow alike with it.

    Parameters
    ----------
    differences
        2 for a position, 1 for a velocity.

    Returns
    -------
    float or None
        Cut-off [Hz], or None when there is no noise to remove or too little data to see it.
    """
    slices = [s for s in segment_slices(segment) if s.stop - s.start >= 32]
    if not slices:
        return None
    step = float(np.median(np.concatenate([np.diff(time[s]) for s in slices])))
    spectrum = _difference_spectrum(time, value, slices, step, differences)
    if spectrum is None:
        return None
    frequency = np.fft.rfftfreq(2 * (len(spectrum) - 1), step)
    response = np.abs(2.0 * np.sin(np.pi * frequency * step)) ** (2 * differences)
    density, frequency = spectrum[1:] / response[1:], frequency[1:]
    rate = 1.0 / step
    nyquist = 0.5 * rate
    plateau = density[(frequency > 0.6 * nyquist) & (frequency < 0.95 * nyquist)]
    noise = float(np.median(plateau))
    if noise <= 0.0:
        return None
    above = _smooth(density) > _ABOVE * noise
    if not above.any():
        return None
    meeting = float(frequency[np.flatnonzero(above)[-1]])
    # A spectrum that still falls at its end has no plateau: there is no noise to remove.
    if meeting > 0.55 * nyquist:
        return None
    cutoff = _MARGIN * meeting
    return cutoff if cutoff < HIGHEST * rate else None


def _difference_spectrum(
    time: Floats, value: Floats, slices: list[slice], step: float, differences: int
) -> Floats | None:
    """Spectral density of the differences of a signal, by Welch's method; None without data."""
    rate = 1.0 / step
    longest = max(s.stop - s.start for s in slices)
    # Windows of about 4 s resolve the motions of a robot joint; at least 64 samples to see a
    # plateau.
    length = int(2 ** np.round(np.log2(np.clip(4.0 * rate, 64, 4096))))
    while length > 32 and length > longest - differences:
        length //= 2
    window = np.hanning(length + 1)[:-1]
    scale = 1.0 / (rate * float((window**2).sum()))
    spectrum = np.zeros(length // 2 + 1)
    windows = 0
    for part in slices:
        t, x = time[part], value[part]
        grid, uniform = _grid(t)
        if not uniform:
            x = np.interp(grid, t, x)
        d = np.diff(x, n=differences)
        if len(d) < length:
            continue
        frames = np.lib.stride_tricks.sliding_window_view(d, length)[:: length // 2]
        frames = frames - frames.mean(axis=1, keepdims=True)
        spectrum += (np.abs(np.fft.rfft(frames * window, axis=1)) ** 2).sum(axis=0) * scale
        windows += len(frames)
    return spectrum / windows if windows and spectrum.any() else None


def motion_band(time: Floats, velocity: Floats, segment: Ints) -> float | None:
    """Find the frequency [Hz] below which 99 % of a velocity's power lies; None if too short."""
    total = 0.0
    shares = []
    for part in segment_slices(segment):
        if part.stop - part.start < 64:
            continue
        grid, uniform = _grid(time[part])
        x = velocity[part] if uniform else np.interp(grid, time[part], velocity[part])
        spectrum = np.abs(np.fft.rfft(x - x.mean())) ** 2
        frequency = np.fft.rfftfreq(len(x), float(grid[1] - grid[0]))
        shares.append((frequency, spectrum))
        total += float(spectrum.sum())
    if total <= 0.0:
        return None
    frequency = np.concatenate([f for f, _ in shares])
    spectrum = np.concatenate([s for _, s in shares])
    order = np.argsort(frequency, kind="stable")
    power = np.cumsum(spectrum[order])
    return float(frequency[order][int(np.searchsorted(power, 0.99 * total))]) or None


def curvature(time: Floats, segment: Ints, value: Floats, denoised: Floats) -> Floats:
    """Second derivative of a load by central differences of it without its noise, [n].

    A jump is a change of payload; the stretches before and after it are differentiated separately.
    """
    stretch = segment + np.cumsum(np.concatenate([[False], jumps(value)]))
    return Smoother(time, stretch, None).smooth(denoised, 2)


def slow_rate(time: Floats, value: Floats, run: Ints) -> Floats:
    """Derivative of a slow channel, by differences of its means over fiftieths of each run, [n].

    A thermometer shows small steps, which the means smooth. Gaps within a run do not matter: each
    mean counts at the mean of its times.
    """
    rate = np.zeros_like(value)
    for part in segment_slices(run):
        t, x = time[part], value[part]
        duration = float(t[-1] - t[0])
        if duration <= 0.0:
            continue
        place = np.minimum((_MEANS * (t - t[0]) / duration).astype(np.int64), _MEANS - 1)
        count = np.bincount(place, minlength=_MEANS)
        filled = count > 0
        times, means = (
            np.bincount(place, weights=of, minlength=_MEANS)[filled] / count[filled]
            for of in (t, x)
        )
        if means.size > 1:
            rate[part] = np.interp(t, times, np.gradient(means, times))
    return rate


def jumps(value: Floats) -> Bools:
    """Steps between samples that no motion makes, bool [n - 1].

    A jump differs from the steps around it by many times the usual change from step to step.
    """
    step = np.diff(value)
    if len(step) < 2:
        return np.zeros(len(step), dtype=bool)
    usual = float(np.quantile(np.abs(np.diff(step)), 0.99))
    return np.asarray(
        np.abs(step - scipy.ndimage.median_filter(step, 5, mode="nearest")) > _JUMP * usual
    )


def _smooth(density: Floats) -> Floats:
    """Running median over three bins, or a tenth of the frequency where that is wider."""
    n = len(density)
    out = np.empty(n)
    for i in range(n):
        half = max(1, int(0.1 * i))
        out[i] = np.median(density[max(0, i - half) : i + half + 1])
    return out


def _slope(x: Floats, step: float) -> Floats:
    """First derivative on a uniform grid, sixth order inside, second order at the edges."""
    n = len(x)
    d = np.gradient(x, step) if n > 1 else np.zeros(n)
    if n >= 7:
        d[3:-3] = (45.0 * (x[4:-2] - x[2:-4]) - 9.0 * (x[5:-1] - x[1:-5]) + (x[6:] - x[:-6])) / (
            60.0 * step
        )
    return d


def _mend_ends(raw: Floats, y: Floats, rate: float, cutoff: float, derivative: int) -> Floats:
    """Replace the filtered signal at the ends of a segment by a cubic fitted to the raw samples.

    A filter extrapolates beyond the ends, which bends velocity and acceleration there. The cubic
    spans as many samples as a cubic Savitzky-Golay filter of the same cut-off, and fades into the
    filtered signal over half of them.
    """
    half = int(np.ceil((4.0 * 0.5 * rate / cutoff + 4.6) / 3.2))
    span = 2 * half + 1
    if span > len(y) or half < 3:
        return y
    u = np.linspace(-1.0, 1.0, span)
    scale = (2.0 * rate / (span - 1)) ** derivative  # d/dt from d/du
    fade = np.linspace(1.0, 0.0, half)
    y = y.copy()
    for first in (True, False):
        part = slice(0, span) if first else slice(len(y) - span, len(y))
        powers = u[:, None] ** np.arange(4)
        fit = np.polynomial.Polynomial(linear.least_norm(powers, raw[part]))
        cubic = fit.deriv(derivative)(u) * scale if derivative else fit(u)
        if first:
            y[:half] = fade * cubic[:half] + (1.0 - fade) * y[:half]
        else:
            y[-half:] = fade[::-1] * cubic[-half:] + (1.0 - fade[::-1]) * y[-half:]
    return y


@dataclass(frozen=True)
class Smoother:
    """A zero-phase low-pass over the segments of a recording.

    Attributes
    ----------
    cutoff
        Cut-off [Hz]; None leaves signals as they are.
    """

    time: Floats
    segment: Ints
    cutoff: float | None

    def smooth(self, value: Floats, derivative: int = 0) -> Floats:
        """Low-pass a signal and take its derivative, segment by segment.

        Segments too short for the filter are differentiated without it.
        """
        out = np.empty_like(value)
        for part in segment_slices(self.segment):
            t, x = self.time[part], value[part]
            n = len(t)
            if n < 2:
                out[part] = 0.0 if derivative else x
                continue
            grid, uniform = _grid(t)
            rate = (len(grid) - 1) / (grid[-1] - grid[0])
            short = (
                self.cutoff is None
                or n < max(16, int(rate / self.cutoff))
                or (self.cutoff >= HIGHEST * rate)
            )
            if short and not derivative:
                out[part] = x
                continue
            if short and n < 8:
                for _ in range(derivative):
                    x = np.gradient(x, t)
                out[part] = x
                continue
            y = x if uniform else np.interp(grid, t, x)
            raw = y
            if not short:
                assert self.cutoff is not None
                pad = min(len(y) - 1, int(3.0 * rate / self.cutoff))
                y = zero_phase(y, self.cutoff, rate, pad)
            for _ in range(derivative):
                y = _slope(y, 1.0 / rate)
            if not short:
                assert self.cutoff is not None
                y = _mend_ends(raw, y, rate, self.cutoff, derivative)
            out[part] = y if uniform else np.interp(t, grid, y)
        return out
