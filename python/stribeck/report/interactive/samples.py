"""The samples of a recording with what models say of them, as one source for linked figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import ColumnDataSource
from numpy.typing import NDArray

from stribeck.report.channels import Channel, channel, clock, torque_name
from stribeck.report.interactive.base import model_name, shown_range
from stribeck.report.interactive.decimate import MOST_DRAWN, drawn_rows

if TYPE_CHECKING:
    from stribeck.fitting.result import Fit
    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Channels that a residual is drawn against, with their short names.
CHANNELS = {
    "time": "time",
    "velocity": "velocity",
    "position": "position",
    "load": "load",
    "temperature": "temperature",
    "acceleration": "acceleration",
    "reversal": "since reversal",
}


@dataclass(frozen=True)
class Samples:
    """Samples of one recording, measured and modelled, that several figures share.

    Attributes
    ----------
    fits : tuple of Fit
        Models on the same recording; model `k` has the columns ``modelled_k``, ``friction_k`` and
        ``residual_k``.
    columns : mapping of arrays [n]
        All samples, by column. ``time``, ``velocity``, ``torque``, ``friction`` and the channels
        of `labels`; NaN where nothing is drawn: at gaps, and at rest where models are not scored.
    labels : mapping of str
        Axis label with unit of each channel of `CHANNELS` that the recording has.
    source : ColumnDataSource
        The samples that are drawn, in the unit of the recording, and ``row``, their numbers.
    """

    fits: tuple[Fit, ...]
    columns: Mapping[str, Array]
    labels: Mapping[str, str]
    source: ColumnDataSource

    @property
    def rows(self) -> int:
        """Number of samples of the recording."""
        return int(self.columns["time"].size)

    @property
    def names(self) -> list[str]:
        """What each model is called; equal names are numbered."""
        names = [model_name(fit.model) for fit in self.fits]
        return [
            f"{name} [{k}]" if names.count(name) > 1 else name for k, name in enumerate(names, 1)
        ]

    @property
    def unit(self) -> str:
        """Unit of torque."""
        return self.fits[0].model.torque_unit

    @property
    def velocity_unit(self) -> str:
        """Unit of velocity."""
        return f"{self.fits[0].recording.position_unit}/s"

    def limits(self, *columns: str) -> tuple[float, float] | None:
        """The range in which nearly all samples lie that were fitted to; None without samples.

        An abrupt stop that was excluded from the fit is outside of it: it would flatten the rest.
        """
        rows = self.fits[-1].rows
        return shown_range([self.columns[name][rows] for name in columns])

    def with_columns(self, more: Mapping[str, Array]) -> Samples:
        """The same with further columns, arrays [n], and a source of its own."""
        made = replace(self, columns={**self.columns, **more})
        return replace(made, source=ColumnDataSource(made.data(0, made.rows)))

    def within(self, start: float, end: float) -> tuple[int, int]:
        """First sample in a window of time, and the one after its last."""
        time = self.columns["time"]
        if self.fits[0].recording.averaged:
            return 0, time.size
        first, last = np.searchsorted(time, [start, end])
        return max(int(first) - 1, 0), min(int(last) + 1, time.size)

    def data(self, start: int, stop: int, most: int = MOST_DRAWN) -> dict[str, NDArray[np.generic]]:
        """The columns of the samples that are drawn from `start` to `stop`.

        With at most `most` samples there all of them are drawn: a figure that is zoomed in becomes
        exact when these replace the data of `source`.
        """
        extremes = [self.columns["torque"], self.columns[f"residual_{len(self.fits) - 1}"]]
        rows = drawn_rows(extremes, start, stop, most, gaps(self.fits[0].recording))
        # Single precision is finer than a pixel, and half as long; not so for hours of time.
        made: dict[str, NDArray[np.generic]] = {
            name: values[rows] if name == "time" else values[rows].astype(np.float32)
            for name, values in self.columns.items()
        }
        return {**made, "row": rows.astype(np.int32)}


def samples_of(fits: Sequence[Fit], most: int = MOST_DRAWN) -> Samples:
    """The samples of the recording that `fits` share.

    Parameters
    ----------
    fits : sequence of Fit
        One or several models on the same recording.
    most : int
        Largest number of samples that are drawn.
    """
    last, r = fits[-1], fits[-1].recording
    found = _channels(last)
    load = last.load_torque
    rest = np.zeros_like(r.torque) if load is None else load
    scored = np.where(r.moving, 0.0, np.nan)
    # A line breaks at NaN: at each gap, and for models at rest.
    gap = np.zeros_like(r.torque)
    if not r.averaged:
        gap[gaps(r)] = np.nan
    columns: dict[str, Array] = {
        **{name: made.values for name, made in found.items()},
        "time": clock(r).values,
        "velocity": r.velocity,
        "torque": r.torque + gap,
        "friction": r.torque - rest + scored,
    }
    for k, fit in enumerate(fits):
        own = fit.load_torque
        modelled = fit.prediction + scored
        columns[f"modelled_{k}"] = modelled + gap
        columns[f"friction_{k}"] = modelled - (rest if own is None else own)
        columns[f"residual_{k}"] = fit.residual + scored
    made = Samples(
        tuple(fits),
        columns,
        {name: c.label for name, c in found.items()},
        ColumnDataSource(),
    )
    made.source.data = made.data(0, made.rows, most)
    return made


def _channels(fit: Fit) -> dict[str, Channel]:
    """The channels of a recording that a residual can be drawn against."""
    return {name: found for name in CHANNELS if (found := channel(fit, name)) is not None}


def gaps(r: Recording) -> NDArray[np.intp]:
    """The first sample after each gap, at which a line over time breaks."""
    return np.flatnonzero(np.diff(r.segment)) + 1


def friction_label(samples: Samples) -> str:
    """The label of measured friction: torque without the load, where there is one."""
    what = torque_name(samples.unit)
    if samples.fits[-1].load_torque is None:
        return f"{what} [{samples.unit}]"
    return f"friction {what} [{samples.unit}]"
