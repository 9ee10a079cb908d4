"""The `Recording` type: one joint's measurements, checked and in SI units."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from types import ModuleType
from typing import Any

import numpy as np
import polars as pl

from stribeck.base.errors import RecordingError, option
from stribeck.base.shown import Plotted
from stribeck.recording.acceleration_filter import AccelerationFilter
from stribeck.recording.arrays import Bools, Floats, Ints, Numbers
from stribeck.recording.check import Check
from stribeck.recording.derive import curvature, slow_rate
from stribeck.recording.rows import SIGMAS, noise_level, segment_slices
from stribeck.recording.stated.origin import Origin

__all__ = ["Column", "Recording"]


@dataclass(frozen=True)
class Column:
    """A channel of a recording and where it comes from.

    Attributes
    ----------
    name, unit
        Channel, e.g. ``velocity``, and its SI unit.
    source, derived
        Column of the file, or what it was computed from; whether it was computed and not read.
    minimum, maximum
        Range in that unit.
    """

    name: str
    source: str
    unit: str
    derived: bool
    minimum: float = float("nan")
    maximum: float = float("nan")

    @classmethod
    def of(cls, name: str, source: str, unit: str, derived: bool, values: Floats) -> Column:
        """A channel with the range of its values."""
        return cls(name, source, unit, derived, float(values.min()), float(values.max()))


def _of_room(module: str) -> ModuleType:
    """A module that makes recordings, loaded when it is needed, since it needs this one."""
    return importlib.import_module(f"{__package__}.{module}")


@dataclass(frozen=True, eq=False, repr=False)
class Recording(Plotted):
    """One joint's measurements, checked, in SI units; arrays are read-only.

    Attributes
    ----------
    time
        s.
    position, velocity, acceleration
        In `position_unit`, per s, per s2; position is None where it was not recorded.
    torque
        As recorded, in `torque_unit`. Where friction was measured directly, it is the friction.
        With a `drive` it is what drives the motor, in its own unit.
    load_torque
        None: not known, to be identified. With a `drive`, in N m or N.
    external_torque
        Torque that the environment exerts on the joint; None: not known.
    temperature
        degC.
    position_smooth, velocity_smooth, acceleration_smooth, load_torque_smooth
        The same channels after a zero-phase low-pass at `cutoff_hz`.
    acceleration_filter
        Of a derived acceleration; None: it was recorded.
    segment, run, run_names
        Segment (stretch between gaps) and run of each sample, and the names of the runs.
    dt
        Step to the previous sample, s; 0 where a segment starts.
    moving
        The scored samples: those faster than `velocity_threshold`, or all.
    block, block_count, counted
        Held-out block of each sample; the samples whose held-out error is taken (None: all).
    averaged
        Whether each sample is a steady-state point.
    motor
        Constants of motor and transmission that are known.
    drive, enabled
        ``"voltage"`` or None; the samples where the drive is on.
    reference_position, reference_velocity, reference_acceleration
        The reference trajectory of the controller, free of noise; None where none was recorded, the
        position also where none was measured.
    reference_load_torque
        Load torque of the given rigid-body terms along the reference; None: not known.
    elapsed_before, excerpt_of
        Time before the first sample of an excerpt, s; the recording that it is an excerpt of.
    weight, unweighted
        Weight of each sample's squared error in a fit (None: all weights are equal); the recording
        without the weights that a fit was given.
    checks, trusted
        Whether the channels agree with each other, and whether contradictions are accepted.
    torque_at
        Where the torque was measured: ``"motor"``, ``"command"`` or ``"link"``; None: not known.
    motor_position, motor_velocity
        Of a second encoder on the motor's shaft, divided by the gear ratio; None: not recorded.
    origin
        What it was made from, so that it can be joined with others; None: it cannot.

    Examples
    --------
    >>> import numpy as np, stribeck as sb
    >>> t = np.arange(500) / 100.0
    >>> r = sb.read({"t": t, "qd_rpm": np.sin(t), "tau": np.sign(np.sin(t))})
    >>> r.rows, r.torque_unit, r.to_frame().columns[:4]
    (500, 'N m', ['time', 'velocity', 'acceleration', 'torque'])
    """

    path: str
    sha256: str
    joint: str | None
    joint_kind: str
    torque_unit: str
    position_unit: str
    time: Floats
    segment: Ints
    run: Ints
    run_names: tuple[str, ...]
    dt: Floats
    position: Floats | None
    velocity: Floats
    acceleration: Floats
    torque: Floats
    load_torque: Floats | None
    temperature: Floats | None
    position_smooth: Floats | None
    velocity_smooth: Floats
    acceleration_smooth: Floats
    load_torque_smooth: Floats | None
    columns: dict[str, Column]
    notes: tuple[str, ...]
    velocity_noise: float
    velocity_threshold: float
    moving: Bools
    block: Ints
    block_count: int
    rate_hz: float
    gaps: int
    rows_dropped: int
    averaged: bool
    cutoff_hz: float | None
    acceleration_filter: AccelerationFilter | None = None
    motor: dict[str, float] = field(default_factory=dict)
    external_torque: Floats | None = None
    drive: str | None = None
    enabled: Bools | None = None
    counted: Bools | None = None
    reference_position: Floats | None = None
    reference_velocity: Floats | None = None
    reference_acceleration: Floats | None = None
    reference_load_torque: Floats | None = None
    elapsed_before: float = 0.0
    excerpt_of: Recording | None = None
    weight: Floats | None = None
    unweighted: Recording | None = None
    checks: tuple[Check, ...] = ()
    trusted: bool = False
    torque_at: str | None = None
    motor_position: Floats | None = None
    motor_velocity: Floats | None = None
    origin: Origin | None = None

    def __len__(self) -> int:
        return len(self.time)

    @property
    def rows(self) -> int:
        """Number of samples."""
        return len(self.time)

    @property
    def runs(self) -> int:
        """Number of runs."""
        return len(self.run_names)

    @classmethod
    def from_columns(cls, *, units: Mapping[str, str] | None = None, **columns: Any) -> Recording:
        """A recording of arrays, each given as the channel that it is.

        Parameters
        ----------
        units
            Unit of each array that is not in SI units.
        **columns
            Arrays [n]: `time`, `position`, `velocity`, `acceleration`, `torque`, `load_torque`,
            `temperature` and the other channels of a file, with `run` and `joint`; and options of
            `stribeck.read`.

        Raises
        ------
        RecordingError
            As of `stribeck.read`, or arrays of different lengths.

        Examples
        --------
        >>> import numpy as np, stribeck as sb
        >>> t = np.arange(500) / 100.0
        >>> v = 10.0 * np.sin(t)
        >>> sb.Recording.from_columns(
        ...     time=t, velocity=v, torque=np.sign(v), units={"velocity": "deg/s"}, gear_ratio=101
        ... )
        <Recording the given table: 500 rows, 1 run, 100 Hz, revolute, N m>
        """
        made: Recording = _of_room("assembly.given_columns").from_columns(units, columns)
        return made

    def where(self, condition: str) -> Recording:
        """The samples for which a condition on the channels holds; the others become gaps.

        Channels are in SI units, as in `to_frame`. Filters, noise and scored samples are found
        again.

        Raises
        ------
        RecordingError
            The condition cannot be used or keeps no sample; the recording holds medians of runs.

        Examples
        --------
        >>> import numpy as np, stribeck as sb
        >>> t = np.arange(500) / 100.0
        >>> whole = sb.Recording.from_columns(time=t, velocity=np.sin(t), torque=np.sign(np.sin(t)))
        >>> whole.where("velocity > 0 and time < 4").rows
        314
        """
        made: Recording = _of_room("several.cut").where(self, condition)
        return made

    def require_consistent(self) -> None:
        """Refuse channels that contradict each other, unless the recording was read with trust.

        Raises `RecordingError` with the first contradiction and its likeliest remedy. A temperature
        below absolute zero is refused with trust too.
        """
        wrong = [c for c in self.checks if not (c.ok or (self.trusted and c.trustable))]
        if not wrong:
            return
        first, count = wrong[0], len(wrong) - 1
        more = f" ({count} more: `stribeck inspect` lists them)" if count else ""
        trust = f"go on with {option('trust')}" if first.trustable else None
        remedies = "; or ".join(filter(None, (first.do, trust)))
        raise RecordingError(f"{self.path}: {first.said}{more}: {remedies}")

    @property
    def torque_holds_load(self) -> bool:
        """Whether `torque` is friction and the recorded load together (bool)."""
        direct = "friction_torque" in self.columns
        return self.load_torque is not None and not direct and self.drive is None

    @property
    def known_torque(self) -> Floats:
        """The known part of `torque`, [n]: the load where `torque` includes it, zeros elsewhere."""
        if self.torque_holds_load and self.load_torque is not None:
            return self.load_torque
        return np.zeros_like(self.torque)

    def is_measured_as(self, other: Recording) -> bool:
        """Whether `other` is this recording, but for weights that a fit was given."""
        if other is self or (self.unweighted is not None and other is self.unweighted):
            return True
        joined = self.origin is not None and len(self.origin.files) > 1
        return joined and self.origin == other.origin and self._has_samples_of(other)

    def _has_samples_of(self, other: Recording) -> bool:
        """Whether every array is that of a recording which was joined of the same parts."""
        pairs = [(getattr(self, f.name), getattr(other, f.name)) for f in fields(self)]
        arrays = [(a, b) for a, b in pairs if isinstance(a, np.ndarray)]
        return all(isinstance(b, np.ndarray) and np.array_equal(a, b) for a, b in arrays)

    @property
    def hashes(self) -> tuple[str, ...]:
        """SHA-256 of the recording, and of each of its files where there are several."""
        files = () if self.origin is None else self.origin.files
        return (self.sha256, *(sha256 for _, sha256 in files if len(files) > 1))

    def scored(self, rows: Bools | None = None) -> dict[str, float]:
        """The ``scored`` object of the JSON output: of the samples `rows` [n], or all that move."""
        count = int((self.moving if rows is None else rows).sum())
        return {
            "rows": count,
            "share": count / len(self.moving),
            "velocity_threshold": self.velocity_threshold,
        }

    def denoised(self, channel: str) -> Floats:
        """A channel with its noise removed where that does not distort the signal, [n].

        The smooth channel where it differs from the measured one by noise alone, the measured one
        elsewhere. A channel without a smooth form is returned as measured. Computed once.
        """
        if channel not in self._denoised:
            measured: Floats = getattr(self, channel)
            smooth: Floats | None = getattr(self, f"{channel}_smooth", None)
            if smooth is None or smooth is measured:
                self._denoised[channel] = measured
            else:
                sigma = noise_level(self.time, measured, self.segment)
                near = np.abs(smooth - measured) <= SIGMAS * sigma
                self._denoised[channel] = np.where(near, smooth, measured)
        return self._denoised[channel]

    @cached_property
    def remembered(self) -> dict[str, dict[str, float]]:
        """Numbers computed from this recording at some cost and kept, by name."""
        return {}

    @cached_property
    def kept(self) -> dict[str, Numbers]:
        """Arrays computed from this recording at some cost and kept, by name."""
        return {}

    @cached_property
    def _denoised(self) -> dict[str, Floats]:
        return {}

    @cached_property
    def elapsed(self) -> Floats:
        """Time since the first sample, s, [n]; runs whose clock starts again follow each other."""
        step = np.diff(self.time, prepend=self.time[:1])
        if np.any(step < 0.0):
            step = np.where(step >= 0.0, step, self.scales()["sample_period"])
        return self.elapsed_before + np.cumsum(step)

    @cached_property
    def load_torque_curvature(self) -> Floats | None:
        """Second derivative of the load torque, N m/s2 or N/s2, [n]; None without a load."""
        if self.load_torque is None:
            return None
        return curvature(self.time, self.segment, self.load_torque, self.denoised("load_torque"))

    @cached_property
    def temperature_rate(self) -> Floats | None:
        """Derivative of the temperature by time, K/s, [n]; None without a temperature."""
        shown = self.temperature
        return None if shown is None else slow_rate(self.elapsed, shown, self.run)

    @cached_property
    def motion_band(self) -> float | None:
        """Frequency [Hz] below which 99 % of the velocity's power lies; None if too short."""
        v = self.velocity
        if self.averaged or v.size < 64 or self.rate_hz <= 0:
            return None
        power = np.abs(np.fft.rfft(v - v.mean())) ** 2
        total = np.cumsum(power)
        if total[-1] <= 0:
            return None
        frequency = np.fft.rfftfreq(v.size, 1.0 / self.rate_hz)
        band = float(frequency[int(np.searchsorted(total, 0.99 * total[-1]))])
        return max(band, self.rate_hz / v.size)

    def scales(self) -> dict[str, float]:
        """Typical sizes for scaling parameters, each in the channel's unit.

        speed (99.9th percentile over moving samples), torque (rms over moving samples; with a
        drive, of the load), effort (rms of `torque` over moving samples, in its own unit), position
        (excursion), acceleration (99th percentile of the smooth one), sample_period (median step),
        temperature (span), duration (of the longest run). A missing channel has scale 0.
        """
        return self._scales

    @cached_property
    def _scales(self) -> dict[str, float]:
        moving = self.moving if self.moving.any() else np.ones(len(self.moving), dtype=bool)
        steps = self.dt[self.dt > 0.0]
        seen = self.torque if self.drive is None or self.load_torque is None else self.load_torque
        durations = (float(np.ptp(self.time[part])) for part in segment_slices(self.run))
        return {
            "speed": float(np.percentile(np.abs(self.velocity[moving]), 99.9)),
            "torque": float(np.sqrt(np.mean(seen[moving] ** 2))),
            "effort": float(np.sqrt(np.mean(self.torque[moving] ** 2))),
            "position": float(np.ptp(self.position)) if self.position is not None else 0.0,
            "acceleration": float(np.percentile(np.abs(self.acceleration_smooth), 99.0)),
            "sample_period": float(np.median(steps)) if steps.size else 0.0,
            "temperature": float(np.ptp(self.temperature)) if self.temperature is not None else 0.0,
            "duration": max(durations),
        }

    def to_frame(self) -> pl.DataFrame:
        """The channels as a polars frame, one row per sample."""
        names = ("position", "velocity", "acceleration", "torque", "load_torque", "temperature")
        given = {name: getattr(self, name) for name in ("time", *names)}
        channels = {name: values for name, values in given.items() if values is not None}
        runs = pl.Series("run", [self.run_names[i] for i in self.run])
        return pl.DataFrame(channels).with_columns(runs, pl.Series("moving", self.moving))
