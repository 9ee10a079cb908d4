"""Recordings of a joint under PD control that sticks and slips, as its drive sees it."""

from __future__ import annotations

from stribeck.benchmark.closed_loop.effects import EFFECTS, IMPLIED, LIMITS, OUTSIDE
from stribeck.benchmark.closed_loop.record import sample

__all__ = ["EFFECTS", "IMPLIED", "LIMITS", "OUTSIDE", "sample"]
