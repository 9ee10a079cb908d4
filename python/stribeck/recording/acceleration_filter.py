"""The low-pass behind which an acceleration is derived."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.recording.arrays import Floats, Ints
from stribeck.recording.derive import Smoother
from stribeck.recording.rows import segment_slices

__all__ = ["AccelerationFilter", "filter_text"]

#: Periods of the cut-off that a motion must last to be filtered by itself.
_PERIODS = 2.0


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

    def derived(
        self, time: Floats, segment: Ints, value: Floats, derivative: int, smooth: Floats
    ) -> Floats:
        """The acceleration [n].

        Parameters
        ----------
        value, derivative
            What it is derived from, and how often: position 2, velocity 1.
        smooth
            The velocity behind a low-pass.
        """
        if self.at_ends is None or self.cutoff is None:
            return Smoother(time, segment, self.cutoff).smooth(value, derivative)
        direction = np.where(np.abs(smooth) > self.still, np.sign(smooth), 0.0)
        ends = np.diff(direction, prepend=direction[:1]) != 0.0
        motion = segment + np.cumsum(ends)
        inside, beside = (
            _by_motion(Smoother(time, segment, cutoff), motion, value, derivative)
            for cutoff in (self.cutoff, self.at_ends)
        )
        weight = np.minimum(_to_end(time, motion) * self.cutoff, 1.0)
        return weight * inside + (1.0 - weight) * beside

    def text(self) -> str:
        """How the filter is stated in a note."""
        if self.at_ends is None:
            return filter_text(self.cutoff)
        beside = "" if self.at_ends == self.cutoff else f", {self.at_ends:.3g} Hz beside its ends"
        return f"{filter_text(self.cutoff)}, over each motion by itself{beside}"


def _by_motion(whole: Smoother, motion: Ints, value: Floats, derivative: int) -> Floats:
    """A derivative [n] over each motion by itself; those that are short are filtered as a whole."""
    assert whole.cutoff is not None
    out = whole.smooth(value, derivative)
    for part in segment_slices(motion):
        time = whole.time[part]
        if (time[-1] - time[0]) * whole.cutoff >= _PERIODS:
            alone = Smoother(time, motion[part], whole.cutoff)
            out[part] = alone.smooth(value[part], derivative)
    return out


def _to_end(time: Floats, motion: Ints) -> Floats:
    """Time from each sample to the nearer end of its motion, s, [n]."""
    slices = segment_slices(motion)
    first, last = (_per_sample(motion, [float(time[s][at]) for s in slices]) for at in (0, -1))
    return np.minimum(time - first, last - time)


def _per_sample(motion: Ints, values: list[float]) -> Floats:
    """The value of its motion for each sample, [n]."""
    return np.repeat(np.array(values), [s.stop - s.start for s in segment_slices(motion)])


def filter_text(cutoff: float | None) -> str:
    """How a filter is stated in a note."""
    if cutoff is None:
        return "no filter: the data show no noise above the motion"
    return f"zero-phase low-pass at {cutoff:.3g} Hz chosen from the data"
