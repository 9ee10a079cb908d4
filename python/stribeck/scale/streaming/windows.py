"""All samples of a data set, one window at a time, as recordings in SI units."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

import numpy as np
import polars as pl
from numpy.typing import NDArray

from stribeck.base.errors import RecordingError, option
from stribeck.models.model import Model
from stribeck.recording.acceleration_filter import AccelerationFilter
from stribeck.recording.derive import Smoother
from stribeck.recording.joint.channels import Channels, wanted_channels
from stribeck.recording.joint.drive import with_drive
from stribeck.recording.joint.loads import measured_torque, rigid_body_load
from stribeck.recording.joint.units import settle_units
from stribeck.recording.recording import Recording
from stribeck.recording.rows import predictable, segment_rows
from stribeck.recording.tables.cells import labels
from stribeck.recording.tables.computed import apply_formulas
from stribeck.recording.tables.prepared import Prepared
from stribeck.recording.tables.readers import Source
from stribeck.scale.streaming.dataset import DataSet
from stribeck.scale.streaming.margin import Margin, smoothed
from stribeck.scale.streaming.motion import MotionChannels
from stribeck.scale.streaming.runs import numbered
from stribeck.scale.streaming.sample import CLOCK_RUN, Sample

__all__ = ["WINDOW_ROWS", "Window", "Windows"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Number of samples of a window.
WINDOW_ROWS = 262_144


@dataclass(frozen=True)
class Window:
    """A window of the data set with margins.

    Attributes
    ----------
    recording
        The samples of the window and of the margins around it.
    rows
        Indices in `recording` of the moving samples of the window without margins, array [m].
    own
        Which samples of `recording` are the window without margins, bool array [n].
    row
        Index in the data set of each sample of `recording`, array [n].
    end
        Index of the first sample of the next window.
    count, dropped
        Number of samples of the window without margins, and of those dropped as not finite.
    """

    recording: Recording
    rows: Ints
    own: NDArray[np.bool_]
    row: Ints
    end: int
    count: int
    dropped: int


@dataclass(frozen=True)
class Anchor:
    """State at the last sample of a window.

    Attributes
    ----------
    row
        Its index in the data set; -1 before the first sample.
    time, elapsed
        Its time stamp, and the time since the first sample of the data set, s.
    """

    row: int = -1
    time: float = 0.0
    elapsed: float = 0.0

    @classmethod
    def of(cls, window: Window) -> Anchor:
        """The state at the last sample of a window, without margins."""
        last = int(np.searchsorted(window.row, window.end)) - 1
        r = window.recording
        return cls(int(window.row[last]), float(r.time[last]), float(r.elapsed[last]))

    def elapsed_before(self, recording: Recording, row: Ints) -> float:
        """Return the time before the first sample of the next window, s.

        Parameters
        ----------
        recording, row
            The next window with its margins, and the indices of its samples.
        """
        if self.row < 0:
            return 0.0
        at = int(np.searchsorted(row, self.row))
        if at < row.size and row[at] == self.row:
            return self.elapsed - float(recording.elapsed[at])
        return self.elapsed + max(float(recording.time[0]) - self.time, 0.0)


@dataclass
class Windows:
    """The windows of a data set, in order; each iteration reads all of it once.

    Parameters
    ----------
    model
        The model to fit, which decides which channels are read.
    least
        Least margin, for filters that the caller applies; gaps are then found for every model.
    """

    data: DataSet
    sample: Sample
    model: Model
    size: int = WINDOW_ROWS
    least: Margin | None = None
    margin: Margin = field(init=False)

    def __post_init__(self) -> None:
        self.margin = Margin.of(self.model, self.sample.recording)
        if self.least is not None:
            self.margin = self.margin.at_least(self.least)
        self._smoothed = smoothed(self.model, self.sample.recording)
        self._accelerated = self.sample.recording.acceleration_filter or AccelerationFilter(None)
        self._columns = self._read()

    def _read(self) -> list[str] | None:
        """Columns that are needed; None: all, since a formula may use any."""
        settings = self.sample.prepared.settings
        if settings.derive or settings.where is not None:
            return None
        chosen = [c.source for c in self.sample.prepared.choices.values() if c.source != CLOCK_RUN]
        return [name for name in self.data.schema if name in chosen]

    def __len__(self) -> int:
        return -(-self.data.rows // self.size)

    def __iter__(self) -> Iterator[Window]:
        """Iterate over the windows in order; the next one is read while one is processed."""
        anchor = Anchor()
        with ThreadPoolExecutor(1) as reader:
            coming = reader.submit(self._window, 0, anchor)
            for start in range(0, self.data.rows, self.size):
                window = coming.result()
                anchor = anchor if window is None else Anchor.of(window)
                if start + self.size < self.data.rows:
                    coming = reader.submit(self._window, start + self.size, anchor)
                if window is not None:
                    yield window

    def _reach(self, start: int) -> tuple[int, int]:
        """First and last row of the window that begins at `start`, with its margins."""
        stop = min(start + self.size, self.data.rows)
        return max(start - self.margin.before, 0), min(stop + self.margin.after, self.data.rows)

    def _window(self, start: int, anchor: Anchor) -> Window | None:
        """The window that begins at `start`; None if all its samples are dropped."""
        begin, end = self._reach(start)
        data = self._channels(self.data.frame(begin, end, self._columns), begin)
        finite = np.ones(data.rows.size, dtype=bool)
        for values in data.values.values():
            finite &= np.isfinite(values)
        row = data.prepared.row[data.rows]
        stop = min(start + self.size, self.data.rows)
        own = (row >= start) & (row < stop)
        dropped = int(np.count_nonzero(own & ~finite))
        row, own = row[finite], own[finite]
        if not own.any():
            return None
        data.keep(finite)
        settle_units(data)
        recording = self._recording(data, row, anchor)
        rows = np.flatnonzero(recording.moving & own)
        return Window(recording, rows, own, row, stop, int(np.count_nonzero(own)), dropped)

    def _channels(self, frame: pl.DataFrame, begin: int) -> Channels:
        """The channels of the rows of `frame`, the first of which is row `begin`."""
        known = self.sample.prepared
        source = Source(self.data.path, "", frame, 0)
        made = apply_formulas(source, known.settings, None, may_be_empty=True)
        table = made.table
        prepared = Prepared(
            source, known.settings, table, made.row + begin, dict(known.choices), ()
        )
        rows = np.arange(table.height)
        if self.sample.joint is not None and "joint" in known.choices:
            names = np.asarray(labels(table, known.choices["joint"].source), dtype=object)
            rows = np.flatnonzero(names == self.sample.joint)
        data = Channels(prepared, rows)
        columns = self.sample.recording.columns
        for channel in wanted_channels(prepared):
            # A channel that is empty in the part in memory is left out of all windows.
            if channel == "current" or channel in columns:
                data.load(channel)
        return data

    def _recording(self, data: Channels, row: Ints, anchor: Anchor) -> Recording:
        """The recording of a window with its margins, after checks."""
        sample = self.sample.recording
        velocity = sample.columns["velocity"]
        if velocity.derived and velocity.source == "position":
            # As in the sample, where a recorded one is late.
            data.values.pop("velocity", None)
            data.values.pop("acceleration", None)
        time = data.values["time"]
        run = numbered(row, self.sample.starts)
        self._check_time(time, run, row)
        segment, dt = run, np.zeros_like(time)
        if self._smoothed or self.least is not None:
            segment, dt, _ = segment_rows(time, run, row)
        if self._smoothed:
            motion = MotionChannels.filtered(
                data, Smoother(time, segment, sample.cutoff_hz), self._accelerated
            )
        else:
            motion = MotionChannels.recorded(data)
        torque, load = measured_torque(data)
        load_smooth = load
        if load is None:
            load = load_smooth = rigid_body_load(
                data, motion.position, motion.acceleration, sample.torque_unit, smooth=True
            )
        elif self._smoothed:
            load_smooth = Smoother(time, segment, sample.cutoff_hz).smooth(load)
        every = data.prepared.settings.rows == "all"
        moving = predictable(
            motion.velocity, motion.velocity_smooth, segment, sample.velocity_threshold
        )
        made = replace(
            sample,
            time=time,
            segment=segment,
            run=run,
            dt=dt,
            torque=torque,
            load_torque=load,
            load_torque_smooth=load_smooth,
            temperature=data.values.get("temperature"),
            moving=np.ones_like(moving) if every else moving,
            block=numbered(row, self.sample.edges[:-1]),
            block_count=self.sample.edges.size - 1,
            elapsed_before=0.0,
            **vars(motion),
        )
        made = replace(made, elapsed_before=anchor.elapsed_before(made, row))
        return with_drive(made, data.prepared, data.values)

    def _check_time(self, time: Array, run: Ints, row: Ints) -> None:
        wrong = np.flatnonzero((np.diff(time) <= 0.0) & (run[1:] == run[:-1]))
        if wrong.size:
            at = int(wrong[0]) + 1
            raise RecordingError(
                f"{self.data.path}: {self.data.place(int(row[at]))}: time goes from "
                f"{time[at - 1]:.9g} to {time[at]:.9g} s: sort the rows by time, or name "
                f"the column of runs with {option('map', 'run=COLUMN')}"
            )
