"""What is left: how much of the error is structure, and where it sits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from stribeck.compare import regime_rows
from stribeck.diagnose.floor import NoiseFloor
from stribeck.fit import Fit
from stribeck.identify.figures import rms

#: Share of the squared error above the noise floor from which it counts as structure.
STRUCTURE = 0.15

PLACES = {
    "reversal": "around reversals",
    "low_speed": "at low speed",
    "high_speed": "at high speed",
    "forward": "moving forward",
    "backward": "moving backward",
    "motoring": "while the motor drives the load",
    "generating": "while the load drives the motor",
    "cold": "while cold",
    "hot": "while hot",
    "start": "in the first quarter of the time",
    "end": "in the last quarter of the time",
}


@dataclass(frozen=True)
class Unexplained:
    """Share of the squared held-out error above the noise floor, and where it is largest."""

    share: float | None
    where: str | None

    @property
    def is_structure(self) -> bool:
        """Whether what is left is more than noise."""
        return self.share is not None and self.share > STRUCTURE

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON."""
        return {"share": self.share, "where": self.where}


def unexplained(fit: Fit, floor: NoiseFloor) -> Unexplained:
    """What `fit` leaves above the noise floor, on held-out data."""
    if floor.value is None or fit.rmse_held_out is None or fit.rmse_held_out <= 0:
        return Unexplained(None, None)
    rows = fit.rows
    total = rms(fit.held_out_residual[rows]) ** 2
    share = max(0.0, 1.0 - floor.value**2 / total) if total > 0 else 0.0
    worst, level = None, 1.15
    for name, mask in regime_rows(fit).items():
        chosen = mask & fit.recording.moving & ~fit.transient
        if name not in PLACES or chosen.sum() < 50:
            continue
        ratio = rms(fit.held_out_residual[chosen]) / total**0.5
        if ratio > level:
            worst, level = name, ratio
    if share <= STRUCTURE:
        return Unexplained(share, None)
    place = f"the error is {level:.2g} times the average {PLACES[worst]}" if worst else "everywhere"
    return Unexplained(share, place)
