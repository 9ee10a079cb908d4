"""The measured channels of a recording over time, before any model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from bokeh.models import BoxSelectTool, ColumnDataSource
from numpy.typing import NDArray

from stribeck.report.channels import clock, torque_name
from stribeck.report.interactive.base import (
    COLOURS,
    HAIRLINE,
    MEASURED,
    hover,
    new_plot,
    range_over,
)
from stribeck.report.interactive.decimate import MOST_DRAWN, drawn_rows
from stribeck.report.interactive.dots import selected_dots
from stribeck.report.interactive.samples import gaps

if TYPE_CHECKING:
    from bokeh.plotting import figure

    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RecordingSamples:
    """The channels of a recording, and those of their samples that are drawn.

    Attributes
    ----------
    columns : mapping of arrays [n]
        ``time`` and the channels; NaN at gaps.
    labels : mapping of str
        Axis label with unit of each.
    breaks : array of int
        Samples at which lines break.
    """

    columns: Mapping[str, Array]
    labels: Mapping[str, str]
    breaks: NDArray[np.intp]

    @classmethod
    def of(cls, r: Recording) -> RecordingSamples:
        """The channels that are measured."""
        gap = np.zeros_like(r.torque)
        breaks = gaps(r)
        gap[breaks] = np.nan
        made, labels = clock(r), {}
        columns: dict[str, Array] = {"time": made.values}
        labels["time"] = made.label
        unit = r.position_unit
        rows = [
            ("torque", r.torque, f"{torque_name(r.torque_unit)} [{r.torque_unit}]"),
            ("velocity", r.velocity, f"velocity [{unit}/s]"),
            ("position", r.position, f"position [{unit}]"),
            ("load", r.load_torque, f"load [{r.torque_unit}]"),
            ("temperature", r.temperature, "temperature [°C]"),
        ]
        for name, values, label in rows:
            if values is not None:
                columns[name] = values + gap
                labels[name] = label
        return cls(columns, labels, breaks)

    def within(self, start: float, end: float) -> tuple[int, int]:
        """First sample in a window of time, and the one after its last."""
        time = self.columns["time"]
        first, last = np.searchsorted(time, [start, end])
        return max(int(first) - 1, 0), min(int(last) + 1, time.size)

    def data(self, start: int, stop: int, most: int = MOST_DRAWN) -> dict[str, NDArray[np.generic]]:
        """The columns of the samples that are drawn from `start` to `stop`, and ``row``."""
        extremes = [values for name, values in self.columns.items() if name != "time"]
        rows = drawn_rows(extremes, start, stop, most, self.breaks)
        made: dict[str, NDArray[np.generic]] = {
            name: values[rows] if name == "time" else values[rows].astype(np.float32)
            for name, values in self.columns.items()
        }
        return {**made, "row": rows.astype(np.int32)}


def channels_time(samples: RecordingSamples) -> dict[str, figure]:
    """One figure a channel, with one range of time; the torque's is ``"time"``.

    A drag selects a stretch of time, which all of them mark.

    Parameters
    ----------
    samples : RecordingSamples
        Of one recording.
    """
    source = ColumnDataSource(samples.data(0, samples.columns["time"].size))
    window = range_over(samples.columns["time"])
    made: dict[str, figure] = {}
    for name, label in samples.labels.items():
        if name == "time":
            continue
        plot = new_plot(
            samples.labels["time"],
            label,
            tools="xpan,xbox_zoom,reset,save",
            active=None,
            height=230,
            x_range=window,
        )
        select = BoxSelectTool(dimensions="width")
        plot.add_tools(select)
        plot.toolbar.active_drag = select
        line = plot.line("time", name, source=source, color=MEASURED, line_width=HAIRLINE)
        line.nonselection_glyph = None
        selected_dots(plot, source, "time", name, COLOURS[0])
        hover(plot, [line], [("time", "@time{0.000} s"), (name, f"@{name}{{0.0000}}")])
        made["time" if name == "torque" else name] = plot
    return made
