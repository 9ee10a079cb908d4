"""Steady-state friction points: a recording with each pass reduced to a mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import polars as pl
import tomlkit
from numpy.typing import NDArray

from stribeck.base.errors import ModelFileError
from stribeck.base.files import write_table
from stribeck.base.shown import Shown
from stribeck.identify.errors.covariance import correlation_length
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SteadyPoint:
    """Mean friction at one constant speed.

    Attributes
    ----------
    start, stop : float
        Time span of its samples, in s.
    rows : int
        Number of these samples.
    velocity, velocity_stderr : float
        In rad/s or m/s.
    friction_torque, friction_stderr : float
        In the recording's unit of torque.
    load_torque, temperature : float or None
        Means over the same samples, in the unit of torque and in degC; None where not known.
    """

    start: float
    stop: float
    rows: int
    velocity: float
    velocity_stderr: float
    friction_torque: float
    friction_stderr: float
    load_torque: float | None = None
    temperature: float | None = None


@dataclass(frozen=True, repr=False)
class SteadyPoints(Shown):
    """Steady-state friction points of one joint, and how they were made.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.fitting.methods.segments import segment_points
    >>> points = segment_points(sb.read("log.csv", joint_kind="prismatic"))  # doctest: +SKIP
    >>> points.write("points.csv")  # doctest: +SKIP
    >>> sb.fit("gantry_map", sb.read("points.csv"))  # doctest: +SKIP
    """

    points: tuple[SteadyPoint, ...]
    recording: Recording
    method: str
    notes: tuple[str, ...] = field(default=())

    def __len__(self) -> int:
        return len(self.points)

    def _column(self, name: str) -> Array:
        return np.array([getattr(point, name) for point in self.points], dtype=np.float64)

    @property
    def velocity(self) -> Array:
        """Velocity of each point in rad/s or m/s, array [n]."""
        return self._column("velocity")

    @property
    def friction_torque(self) -> Array:
        """Friction of each point in the unit of torque, array [n], with the sign of velocity."""
        return self._column("friction_torque")

    def to_frame(self) -> pl.DataFrame:
        """One row per point, as a recording for `stribeck.read` with ``average="run"``.

        Where the load is known, ``torque`` is the sum of friction and load.
        """
        frame = pl.DataFrame([{"run": k, **vars(p)} for k, p in enumerate(self.points, 1)])
        frame = frame.select(c for c in frame if c.null_count() == 0)
        if "load_torque" in frame.columns:
            frame = frame.with_columns(torque=pl.col("friction_torque") + pl.col("load_torque"))
        return frame

    def to_dict(self) -> dict[str, object]:
        """The JSON of the command ``stribeck points``."""
        return {
            "method": self.method,
            "points": [vars(point) for point in self.points],
            "torque_unit": self.recording.torque_unit,
            "position_unit": self.recording.position_unit,
            "notes": [*self.recording.notes, *self.notes],
        }

    def write(self, path: str | Path) -> None:
        """Write the points (CSV) and a sidecar that states how to read them.

        Raises
        ------
        ModelFileError
            The file cannot be written.
        """
        if Path(path).suffix.lower() != ".csv":
            raise ModelFileError(f"cannot write {path}: its name must end in .csv")
        write_table(path, self.to_frame().write_csv().encode(), self._sidecar(), ModelFileError)

    def _sidecar(self) -> str:
        sidecar = {
            "kind": "recording",
            "joint_kind": self.recording.joint_kind,
            "average": "run",
            "note": f"steady-state points by {self.method} from {Path(self.recording.path).name}",
        }
        if self.recording.torque_unit not in ("N", "N m"):
            sidecar["effort_unit"] = self.recording.torque_unit
        return tomlkit.dumps(sidecar)


def mean_of(values: Array) -> tuple[float, float]:
    """Mean and its standard error, valid for noise that is correlated in time.

    Parameters
    ----------
    values : array [n]
        In order of time.

    Returns
    -------
    mean, standard error : float
        In the unit of `values`.
    """
    scatter = float(values.std(ddof=1)) if values.size > 1 else 0.0
    independent = max(values.size / correlation_length(values), 1.0)
    return float(values.mean()), scatter / np.sqrt(independent)


def checked_points(
    points: Sequence[SteadyPoint], recording: Recording, method: str, notes: Sequence[str] = ()
) -> SteadyPoints:
    """The points in order of time."""
    ordered = sorted(points, key=lambda point: point.start)
    return SteadyPoints(tuple(ordered), recording, method, tuple(notes))
