"""Free functions of the motion: what friction may depend on, in any form."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from stribeck.effect.base import FreeForm, Identified
from stribeck.effect.columns import half_waves, hats

Array = NDArray[np.float64]

#: Knots of a free function of the speed, each with as many samples between it and the next.
KNOTS = 12


def _of_speed(fit: Identified) -> list[Array]:
    """Friction as any function of the speed."""
    v = fit.recording.velocity[fit.rows]
    return [np.sign(v) * hat for hat in hats(np.abs(v), KNOTS)]


def _of_velocity(fit: Identified) -> list[Array]:
    """Friction as any function of the speed, larger in one direction."""
    return hats(np.abs(fit.recording.velocity[fit.rows]), KNOTS)


def _of_stroke_and_speed(waves: int, fit: Identified) -> list[Array]:
    """Friction that varies along the stroke in another way at another speed."""
    if fit.recording.position is None:
        return []
    v = fit.recording.velocity[fit.rows]
    # The rank of a speed: a change at any speed then shows, however often that speed occurs.
    rank = np.argsort(np.argsort(np.abs(v))) / max(v.size - 1, 1)
    powers = (2.0 * rank - 1.0, (2.0 * rank - 1.0) ** 2)
    along = half_waves(fit.recording.position[fit.rows], range(1, waves + 1))
    return [np.sign(v) * wave * power for wave in along for power in powers]


def of_stroke_and_speed(waves: int) -> FreeForm:
    """Any function of position and speed, with so many half waves along the stroke."""
    return FreeForm("position and speed", partial(_of_stroke_and_speed, waves))


OF_SPEED = FreeForm("the speed", _of_speed)
OF_VELOCITY = FreeForm("the velocity", _of_velocity)
