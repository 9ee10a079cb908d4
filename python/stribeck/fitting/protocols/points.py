"""Protocols as points: breakaways as static friction, loops as a stiffness, all that is found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np

from stribeck.base.errors import FitError
from stribeck.base.shown import Shown
from stribeck.fitting.methods.segments import segment_points
from stribeck.fitting.methods.steady import SteadyPoint, SteadyPoints, checked_points
from stribeck.fitting.methods.stretches import Search
from stribeck.fitting.protocols.breakaway import Breakaway, breakaways
from stribeck.fitting.protocols.coast_down import coast_down_points
from stribeck.fitting.protocols.loops import Loop, presliding_loops
from stribeck.fitting.protocols.rests import still_speed
from stribeck.recording.recording import Recording
from stribeck.recording.weights import refuse_weights

__all__ = ["BristleStiffness", "breakaway_points", "bristle_stiffness", "protocol_points"]

#: The middle of a loop is less steep than a bristle at rest by a few per cent.
_CURVED = 0.05


def breakaway_points(recording: Recording) -> SteadyPoints:
    """Friction points from breakaways: static friction at the slowest speed that is seen.

    Static friction is the limit of sliding friction at zero speed, which has no direction: the
    points stand at the speed below which the joint counts as at rest.

    Raises
    ------
    FitError
        There is no breakaway.

    Examples
    --------
    >>> breakaway_points(sb.read("ramps.csv")).write("points.csv")  # doctest: +SKIP
    """
    refuse_weights("a reduction to points", recording)
    found = breakaways(recording)
    if not found:
        raise FitError(
            f"{recording.path}: has no breakaway, a rest in which the torque rises steadily until "
            f"the joint moves: ramp the torque slowly from rest"
        )
    notes = [
        f"{len(found)} breakaways: static friction, at the slowest speed that is seen",
    ]
    if recording.load_torque is None:
        notes.append("without a load torque, gravity is part of a breakaway: use both directions")
    points = [_breakaway_point(recording, b) for b in found]
    return checked_points(points, recording, "breakaway", notes)


def _breakaway_point(recording: Recording, b: Breakaway) -> SteadyPoint:
    temperature = recording.temperature
    slowest = still_speed(recording)
    return SteadyPoint(
        start=b.time - b.dwell,
        stop=b.time,
        rows=b.rows,
        velocity=float(np.sign(b.torque)) * slowest,
        velocity_stderr=slowest / np.sqrt(12.0),
        friction_torque=b.torque,
        friction_stderr=b.stderr,
        temperature=None if temperature is None else float(temperature[b.row]),
    )


def protocol_points(
    recording: Recording, *, bins: int = 1, search: Search | None = None
) -> SteadyPoints:
    """Friction points from every protocol of a recording: plateaux, breakaways and coast-downs.

    Parameters
    ----------
    bins : int
        Points per plateau; a coast-down gives ten times as many.

    Raises
    ------
    FitError
        No protocol is found; the sentence is that of plateaux.

    Examples
    --------
    >>> protocol_points(sb.read("bench.csv", inertia=0.12)).write("p.csv")  # doctest: +SKIP
    """
    made: list[SteadyPoints] = []
    refused: list[FitError] = []
    ways: tuple[Callable[[], SteadyPoints], ...] = (
        lambda: segment_points(recording, bins=bins, search=search),
        lambda: breakaway_points(recording),
        lambda: coast_down_points(recording, bins=10 * bins),
    )
    for points in ways:
        try:
            made.append(points())
        except FitError as error:
            refused.append(error)
    if not made:
        raise refused[0]
    notes = [note for each in made for note in each.notes]
    notes += [f"left out: {str(e).removeprefix(f'{recording.path}: ')}" for e in refused]
    points_found = [point for each in made for point in each.points]
    return checked_points(points_found, recording, "protocols", notes)


@dataclass(frozen=True, repr=False)
class BristleStiffness(Shown):
    """Stiffness of presliding, from the loops of a recording.

    Attributes
    ----------
    value, stderr
        Median over the loops and its standard error, N m/rad or N/m; 0 for a single loop.
    prior
        Of `bristle_stiffness` for a fit, as `--prior` takes it; at least 5 % wide.
    """

    loops: tuple[Loop, ...]
    recording: Recording
    value: float
    stderr: float

    @property
    def prior(self) -> str:
        """The prior of `bristle_stiffness` for a fit, as `--prior` takes it."""
        width = max(self.stderr, _CURVED * self.value)
        return f"bristle_stiffness={self.value:.5g}+-{width:.3g}"

    def to_dict(self) -> dict[str, object]:
        """The JSON of the command ``stribeck points --method presliding``."""
        return {
            "method": "presliding",
            "loops": [asdict(loop) for loop in self.loops],
            "stiffness": {"value": self.value, "stderr": self.stderr},
            "prior": self.prior,
            "torque_unit": self.recording.torque_unit,
            "position_unit": self.recording.position_unit,
            "notes": list(self.recording.notes),
        }


def bristle_stiffness(recording: Recording) -> BristleStiffness:
    """The stiffness of the bristles from presliding loops.

    The slope in the middle of a loop is the stiffness of a bristle law, such as `dahl` or `lugre`,
    while the torque stays well below the static friction; larger loops are softer.

    Raises
    ------
    FitError
        There is no presliding loop.

    Examples
    --------
    >>> bristle_stiffness(sb.read("small.csv")).prior  # doctest: +SKIP
    'bristle_stiffness=49930+-120'
    """
    loops = presliding_loops(recording)
    if not loops:
        raise FitError(
            f"{recording.path}: has no presliding loop, a small closed loop of torque over "
            f"position: apply a slow alternating torque below the static friction"
        )
    values = np.array([loop.stiffness for loop in loops])
    error = 1.2533 * float(values.std(ddof=1)) / np.sqrt(values.size) if values.size > 1 else 0.0
    return BristleStiffness(loops, recording, float(np.median(values)), error)
