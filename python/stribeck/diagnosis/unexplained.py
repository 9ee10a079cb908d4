"""What is left: how much of the error is structure, and where it sits.

Two kinds of structure can be shown without knowing its cause: what a flexible regressor finds in
the recorded channels on blocks that it has not seen, and friction that swings along the recording
in both directions of motion alike. What neither shows counts as noise. How much structure there
is, the noise floor tells better: a regressor never finds all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from stribeck.diagnosis.bound import Explainable
from stribeck.diagnosis.compare import regime_rows
from stribeck.diagnosis.floor import NoiseFloor
from stribeck.diagnosis.swings import Swings, swings
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

#: Share of the squared error from which what is shown counts as structure.
STRUCTURE = 0.1
#: Share of the squared error above the noise floor that is no proof, but a reason to look.
SUSPICIOUS = 0.15
#: A place is named where the error is so many times the average.
WORSE = 1.15
FEWEST_ROWS = 50

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
    """Share of the squared held-out error that is structure, and where it sits.

    Attributes
    ----------
    share : float
        None where it cannot be said.
    where : str
        In words; None where what is left counts as noise.
    """

    share: float | None
    where: str | None

    @property
    def is_structure(self) -> bool:
        """Whether what is left is more than noise."""
        return self.share is not None and self.share > STRUCTURE

    def to_dict(self) -> dict[str, Any]:
        """The contract's JSON."""
        return {"share": self.share, "where": self.where}


def unexplained(
    fit: Fit, floor: NoiseFloor, could: Explainable | None, *, last: bool = True
) -> Unexplained:
    """What `fit` leaves that is not noise, on held-out data.

    Parameters
    ----------
    last : bool
        Whether no effect is left to try. Otherwise friction may well swing with one of those.
    """
    total = rms(fit.held_out_residual[fit.rows]) ** 2
    if could is None or not total > 0.0:
        return Unexplained(None, None)
    above = 0.0 if floor.value is None else 1.0 - floor.value**2 / total
    swing = swings(fit, suspected=above > SUSPICIOUS) if last else Swings(0.0)
    swinging = min(swing.rms**2 / total, 1.0)
    share = max(could.left, swinging)
    if share <= STRUCTURE:
        return Unexplained(share, None)
    share = max(share, above)
    return Unexplained(share, _changing(fit, swing) if swinging > could.left else _place(fit))


def _changing(fit: Fit, swing: Swings) -> str:
    return (
        f"friction swings by {swing.rms:.2g} {fit.model.torque_unit} (RMS) along the recording, "
        f"forward and backward alike, with nothing that was recorded"
    )


def _place(fit: Fit) -> str:
    """Where the error is largest beside the average."""
    total = rms(fit.held_out_residual[fit.rows])
    worst, level = None, WORSE
    for name, mask in regime_rows(fit).items():
        chosen = mask & fit.recording.moving & ~fit.transient
        if name not in PLACES or chosen.sum() < FEWEST_ROWS:
            continue
        ratio = rms(fit.held_out_residual[chosen]) / total
        if ratio > level:
            worst, level = name, ratio
    return f"the error is {level:.2g} times the average {PLACES[worst]}" if worst else "everywhere"
