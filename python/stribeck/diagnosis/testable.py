"""The effects that a recording cannot show, with the reason and what to record instead."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.facts import RecordingFacts
from stribeck.effect.registry import effects
from stribeck.models.model import Model
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Untestable:
    """An effect that the data cannot show: why, and the motion or sensor that would."""

    effect: str
    why: str
    do: str

    def to_dict(self) -> dict[str, object]:
        """The JSON of one row of `untestable`."""
        return {"effect": self.effect, "why": self.why, "do": self.do}


def untestable(
    recording: Recording, load: Array | None = None, model: Model | None = None
) -> dict[str, Untestable]:
    """Effects that `recording` cannot show, by id, with the reason and what to do instead.

    Parameters
    ----------
    load : array [n]
        Load torque identified with the friction, where the recording gives none.
    model
        The model beside which the effects would be added; None: any.
    """
    facts = RecordingFacts.of(recording, load)
    found = {}
    for name, effect in effects().items():
        obstacle = effect.obstacle(facts)
        if obstacle is None and model is not None:
            obstacle = effect.absorbed(model, recording)
        if obstacle is not None:
            found[name] = Untestable(name, obstacle.why, obstacle.do)
    return found
