"""Friction compensation: how much better a joint follows, and how much of it is safe to cancel.

`compensate` moves a joint along a trajectory without and with compensation, `teach` lets a hand
guide it, and `largest_factor` proves which share of the friction can be cancelled without ever
cancelling more than there is.
"""

from stribeck.compensate.controller import HInfinity
from stribeck.compensate.factor import Factor, largest_factor
from stribeck.compensate.loop import Compensator, Motion
from stribeck.compensate.teaching import Guidance, Teaching, teach
from stribeck.compensate.tracking import Tracking, compensate

__all__ = [
    "Compensator",
    "Factor",
    "Guidance",
    "HInfinity",
    "Motion",
    "Teaching",
    "Tracking",
    "compensate",
    "largest_factor",
    "teach",
]
