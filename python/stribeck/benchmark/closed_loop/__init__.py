"""Recordings of a joint with stick-slip under PD control, as measured by its drive."""

from __future__ import annotations

from stribeck.benchmark.closed_loop.effects import EFFECTS, IMPLIED, LIMITS, OUTSIDE
from stribeck.benchmark.closed_loop.record import sample

__all__ = ["EFFECTS", "IMPLIED", "LIMITS", "OUTSIDE", "sample"]
