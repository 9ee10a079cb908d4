"""Presliding as an Iwan model: sliders that break away one after the other."""

from __future__ import annotations

import numpy as np

SLIDERS = 12


class Iwan:
    """Share of the dry friction carried by a contact, a function of displacement only.

    The initial loading is ``x/sqrt(1 + x^2)`` of displacement divided by `reach`, up to the last
    slider. After a reversal every slider is first unloaded.
    """

    def __init__(self, reach: float) -> None:
        ends = reach * np.geomspace(0.15, 5.0, SLIDERS)
        curve = ends / np.sqrt(reach**2 + ends**2)
        curve /= curve[-1]
        slope = np.append(np.diff(np.concatenate([[0.0], curve])) / np.diff([0.0, *ends]), 0.0)
        weight = ends * (slope[:-1] - slope[1:])
        self._limits: list[float] = ends.tolist()
        self._gains: list[float] = (weight / ends).tolist()
        self._states = [0.0] * SLIDERS

    def move(self, way: float) -> float:
        """Return the share of the dry friction, in -1..1, after a displacement `way`."""
        states, total = self._states, 0.0
        for k, limit in enumerate(self._limits):
            z = states[k] + way
            z = limit if z > limit else -limit if z < -limit else z
            states[k] = z
            total += self._gains[k] * z
        return total
