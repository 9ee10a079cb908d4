"""How many samples a window needs before and after its own."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.models.model import Model
from stribeck.recording.motion.derived_motion import cutoff_of
from stribeck.recording.recording import Recording

__all__ = ["Margin", "smoothed"]

#: Memory of a filter in periods of its cut-off frequency (to 1e-10).
PERIODS = 10.0
#: Seconds before a window over which the state of friction settles.
RUN_IN = 20.0
#: Largest number of samples of a margin.
MOST = 131_072


@dataclass(frozen=True)
class Margin:
    """Number of samples that a window needs before and after its own."""

    before: int
    after: int

    def at_least(self, other: Margin) -> Margin:
        """The wider of both on each side."""
        return Margin(max(self.before, other.before), max(self.after, other.after))

    @classmethod
    def of(cls, model: Model, sample: Recording) -> Margin:
        """Return the margin that `model` needs on data like `sample`.

        One sample before gives the time step; only filters and states need more.
        """
        if not smoothed(model, sample):
            return cls(1, 0)
        bands = [x for x in (sample.cutoff_hz, cutoff_of(sample)) if x is not None]
        filters = int(PERIODS * sample.rate_hz / min(bands)) if bands else 8
        state = int(RUN_IN * sample.rate_hz) if model.has_state else 0
        most = MOST
        return cls(min(1 + filters + state, most), min(filters, most))


def smoothed(model: Model, sample: Recording) -> bool:
    """Whether `model` on data like `sample` reads a channel that is filtered or has a memory."""
    derived = {name for name, column in sample.columns.items() if column.derived}
    accelerated = "acceleration" in derived and (
        "inertia" in model.rigid_body
        or "acceleration" in model.core.needs
        or _known_inertia(sample)
    )
    return (
        not model.memoryless
        or "elasticity" in model.effects
        or ("velocity" in derived and sample.columns["velocity"].source == "position")
        or accelerated
    )


def _known_inertia(sample: Recording) -> bool:
    """Whether the load torque is computed from the acceleration."""
    load = sample.columns.get("load_torque")
    return load is not None and load.source == "rigid-body terms"
