"""What a recording could have shown beside a model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stribeck.diagnosis.testable import Untestable


@dataclass(frozen=True)
class SmallestVisible:
    """The smallest effect that would have been significant, with 95 % probability.

    The diagnosis may demote a significant effect, for example where few moves carry it.

    Attributes
    ----------
    rms
        RMS of its torque over the samples fitted to, in `unit`.
    parameter, value, parameter_unit
        The effect's size at which it has this torque, its other parameters at their starts.
    """

    effect: str
    rms: float
    unit: str
    parameter: str
    value: float
    parameter_unit: str

    def to_dict(self) -> dict[str, object]:
        """The JSON of one row of `smallest_visible`."""
        return {
            "effect": self.effect,
            "rms": self.rms,
            "unit": self.unit,
            "parameter": self.parameter,
            "value": self.value,
            "parameter_unit": self.parameter_unit,
        }


@dataclass(frozen=True)
class Group:
    """Effects that are indistinguishable on a recording.

    Attributes
    ----------
    rms
        Torque (RMS) that one of them would need to be distinguished from another; infinite where
        no size is enough.
    """

    effects: tuple[str, ...]
    rms: float
    unit: str

    def to_dict(self) -> dict[str, object]:
        """The JSON of one row of `indistinguishable`."""
        rms = self.rms if np.isfinite(self.rms) else None
        return {"effects": list(self.effects), "rms_to_tell_apart": rms, "unit": self.unit}


@dataclass(frozen=True)
class Visibility:
    """What a recording could have shown beside a model.

    Attributes
    ----------
    smallest
        For each effect that was not found, the smallest that would have been significant; smallest
        first.
    groups
        Effects that are indistinguishable on this recording.
    hidden
        Effects that a refit of the model absorbs, whatever their size.
    """

    smallest: tuple[SmallestVisible, ...] = ()
    groups: tuple[Group, ...] = ()
    hidden: tuple[Untestable, ...] = ()
