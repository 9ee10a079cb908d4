"""Motions that show what a recording does not: optimal experiment design."""

from __future__ import annotations

from stribeck.design.motion import Limits, Motion
from stribeck.design.plan import plan
from stribeck.design.result import Plan, Prospect, Size

__all__ = ["Limits", "Motion", "Plan", "Prospect", "Size", "plan"]
