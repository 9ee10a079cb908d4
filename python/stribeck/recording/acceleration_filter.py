"""The low-pass behind which an acceleration is derived."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.derive import Smoother
from stribeck.recording.rows import segment_slices

__all__ = ["AccelerationFilter", "Derivable", "Motions", "filter_text"]

#: Periods of the cut-off that a motion must last to be filtered by itself.
_PERIODS = 2.0


@dataclass(frozen=True)
class Derivable:
    """What an acceleration is derived from, arrays [n].

    Attributes
    ----------
    source, derivative
        The position, 2, or the velocity, 1.
    smooth
        The velocity behind a low-pass.
    """

    time: Floats
    segment: Ints
    source: Floats
    derivative: int
    smooth: Floats

    def motions(self, still: float) -> Motions:
        """The stretches between reversals and rests, at which it is slower than `still`."""
        direction = np.where(np.abs(self.smooth) > still, np.sign(self.smooth), 0.0)
        ends = np.diff(direction, prepend=direction[:1]) != 0.0
        return Motions(self.time, self.segment + np.cumsum(ends))


@dataclass(frozen=True)
class Motions:
    """Stretches between reversals and rests: the number of that of each sample, int array [n]."""

    time: Floats
    number: Ints

    def parts(self) -> list[slice]:
        """One slice for each motion, in order."""
        return segment_slices(self.number)

    def to_end(self) -> Floats:
        """Time from each sample to the nearer end of its motion, s, [n]."""
        parts = self.parts()
        first, last = (
            np.repeat([self.time[p][at] for p in parts], [p.stop - p.start for p in parts])
            for at in (0, -1)
        )
        return np.minimum(self.time - first, last - self.time)


@dataclass(frozen=True)
class AccelerationFilter:
    """A zero-phase low-pass over each segment, or over each motion by itself.

    Where dry friction stops or reverses a joint, its acceleration jumps. A low-pass across that
    instant blurs the jump, and what friction does just there is wrong by as much.

    Attributes
    ----------
    cutoff
        Hz; None: no filter.
    at_ends
        Where each motion is filtered by itself: the cut-off beside its ends, Hz. None: it is not.
    still
        Speed below which the joint rests, which ends a motion as a reversal does.
    """

    cutoff: float | None
    at_ends: float | None = None
    still: float = 0.0

    def derived(self, known: Derivable) -> Floats:
        """The acceleration [n]."""
        if self.at_ends is None or self.cutoff is None:
            whole = Smoother(known.time, known.segment, self.cutoff)
            return whole.smooth(known.source, known.derivative)
        motions = known.motions(self.still)
        inside, beside = (
            _by_motion(known, motions, cutoff) for cutoff in (self.cutoff, self.at_ends)
        )
        weight = np.minimum(motions.to_end() * self.cutoff, 1.0)
        return weight * inside + (1.0 - weight) * beside

    def text(self) -> str:
        """How the filter is stated in a note."""
        if self.at_ends is None:
            return filter_text(self.cutoff)
        beside = "" if self.at_ends == self.cutoff else f", {self.at_ends:.3g} Hz beside its ends"
        return f"{filter_text(self.cutoff)}, over each motion by itself{beside}"


def _by_motion(known: Derivable, motions: Motions, cutoff: float) -> Floats:
    """The acceleration [n] over each motion by itself; short ones are filtered with the others."""
    out = Smoother(known.time, known.segment, cutoff).smooth(known.source, known.derivative)
    for part in motions.parts():
        time = known.time[part]
        if (time[-1] - time[0]) * cutoff >= _PERIODS:
            alone = Smoother(time, motions.number[part], cutoff)
            out[part] = alone.smooth(known.source[part], known.derivative)
    return out


def filter_text(cutoff: float | None) -> str:
    """How a filter is stated in a note."""
    if cutoff is None:
        return "no filter: the data show no noise above the motion"
    return f"zero-phase low-pass at {cutoff:.3g} Hz chosen from the data"
