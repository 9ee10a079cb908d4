"""Unexplained structure: how much of the error it is, and where it is largest.

Five kinds of structure can be shown without knowing the cause: what a flexible regressor finds in
the recorded channels on unseen blocks, friction that varies along the recording in both directions
alike, a residual that lasts longer than noise, shocks after the load torque changes its sign, and a
residual far above the noise floor, which repeats with the motion. If none shows, the residual
counts as noise. The amount of structure follows from the noise floor, because a regressor never
finds all of it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stribeck.diagnosis.residual.explainable import Explainable
from stribeck.diagnosis.residual.lasting import STRUCTURE, lasting_square
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.residual.regimes import regime_rows
from stribeck.diagnosis.residual.shocks import Shocks, shocks
from stribeck.diagnosis.residual.varying_friction import VaryingFriction, varying_friction
from stribeck.effect.base import number
from stribeck.effect.position import stroke_constants
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

#: Share of the squared error above the noise floor that is a reason for a less strict test.
SUSPICIOUS = 0.15
#: A regime is named where the error exceeds this multiple of the average.
WORSE = 1.15
FEWEST_ROWS = 50
#: Parts of the stroke, of which one may be named.
PARTS = 20

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
    """Share of the squared held-out error that is structure, and where it is largest.

    Attributes
    ----------
    share : float
        None where it cannot be estimated.
    where : str
        In words; None where the residual counts as noise.
    shown : float
        The share that a function of the recorded channels, friction that varies along the
        recording, what lasts, or shocks show. An effect may imitate its cause.
    shocks
        The share of shocks, whose cause is in the drive train.
    asked : bool
        False where a brief diagnosis has not looked for it.
    excluded : float
        Share of the squared held-out error in scored samples that are excluded from the fit. They
        are not judged.
    """

    share: float | None
    where: str | None
    shown: float = 0.0
    shocks: float = 0.0
    asked: bool = True
    excluded: float = 0.0

    @property
    def is_structure(self) -> bool:
        """Whether the residual is more than noise."""
        return self.share is not None and self.share > STRUCTURE

    @property
    def is_partial(self) -> bool:
        """Whether as much of the error as counts as structure is in samples that are not judged."""
        return self.excluded > STRUCTURE

    def to_dict(self) -> dict[str, object]:
        """The JSON of `unexplained`."""
        return {"share": self.share, "where": self.where}


def unexplained(
    fit: Fit, floor: NoiseFloor, explained: Explainable | None, *, last: bool = True
) -> Unexplained:
    """The part of the held-out residual of `fit` that is not noise.

    Parameters
    ----------
    last : bool
        Whether no effect is left to add. Otherwise such an effect may explain varying friction.
    """
    return replace(_unexplained(fit, floor, explained, last=last), excluded=_excluded(fit))


def _excluded(fit: Fit) -> float:
    """Share of the squared held-out error of the scored samples that the fit excludes."""
    square = np.where(fit.scored, fit.held_out_residual**2, 0.0)
    total = float(square.sum())
    return float(square[fit.transient].sum()) / total if total > 0.0 else 0.0


def _unexplained(
    fit: Fit, floor: NoiseFloor, explained: Explainable | None, *, last: bool
) -> Unexplained:
    """The same without the share of excluded samples."""
    total = rms(fit.held_out_residual[fit.rows]) ** 2
    if not total > 0.0:
        return Unexplained(None, None)
    learned = 0.0 if explained is None else explained.left
    above = 0.0 if floor.value is None else 1.0 - floor.value**2 / total
    varying = VaryingFriction(0.0)
    if last:
        varying = varying_friction(fit, suspected=above > SUSPICIOUS)
    varying_share = min(varying.rms**2 / total, 1.0)
    lasting = min(lasting_square(fit) / total, 1.0)
    share = max(learned, varying_share)
    struck = shocks(fit)
    shown = max(share, lasting, struck.share)
    if shown > STRUCTURE:
        if struck.share == shown:
            place = _shocks(struck)
        elif share <= STRUCTURE:
            place = _lasting(lasting, tested=explained is not None)
        else:
            place = _varying(fit, varying) if varying_share > learned else _place(fit)
        return Unexplained(max(shown, above), place, shown, struck.share)
    if explained is None:
        return Unexplained(None, None)
    if not floor.value or floor.is_reached_by(rms(fit.residual[fit.rows])):
        return Unexplained(share, None)
    return Unexplained(above, _repeated(fit, floor.value))


def _varying(fit: Fit, varying: VaryingFriction) -> str:
    return (
        f"friction varies by {number(varying.rms, 2)} {fit.model.torque_unit} (RMS) during the "
        f"recording, equally in both directions, and no effect of the catalog explains it"
    )


def _lasting(share: float, *, tested: bool) -> str:
    """What lasts; a flexible regressor was `tested` on the residual, and learned little of it."""
    size = f"{number(100.0 * share, 2)} % of that error"
    said = f"what lasts longer than the noise of a sensor is {size}, "
    if tested:
        return f"{said}but a flexible regressor finds hardly any of it in the recorded channels"
    return f"{said}and this motion does not tell whether it depends on the recorded channels"


def _shocks(struck: Shocks) -> str:
    return (
        f"in the {number(1e3 * struck.seconds)} ms after the load torque changes its sign the "
        f"error is {number(struck.ratio, 2)} times that elsewhere, as in a drive train with lost "
        f"motion (backlash)"
    )


def _repeated(fit: Fit, floor: float) -> str:
    return (
        f"repeats of the same state typically differ by only {number(floor, 2)} "
        f"{fit.model.torque_unit}, but a flexible regressor does not find the rest in the recorded "
        f"channels (structural vibration, for example)"
    )


def _place(fit: Fit) -> str:
    """Where the error is largest, compared with the average."""
    total = rms(fit.held_out_residual[fit.rows])
    worst, level = _along_stroke(fit, total)
    for name, mask in regime_rows(fit).items():
        chosen = mask & fit.recording.moving & ~fit.transient
        if name not in PLACES or chosen.sum() < FEWEST_ROWS:
            continue
        ratio = rms(fit.held_out_residual[chosen]) / total
        if ratio > level:
            worst, level = PLACES[name], ratio
    return f"the error is {level:.2g} times the average {worst}" if worst else "everywhere"


def _along_stroke(fit: Fit, total: float) -> tuple[str | None, float]:
    """The part of the stroke with the largest error, in words, and its ratio to the `total`.

    The smaller ratio of both halves of the time: a place has its error whenever it is passed.
    """
    r = fit.recording
    stroke = stroke_constants(r)
    if r.position is None or r.averaged or not stroke:
        return None, WORSE
    along = (r.position - stroke["position_start"]) / stroke["position_length"]
    if stroke["position_periodic"]:
        along = along % 1.0
    part = np.clip((along * PARTS).astype(np.intp), 0, PARTS - 1)
    rows = np.flatnonzero(r.moving & ~fit.transient)
    ratios = []
    for half in np.array_split(rows, 2):
        count = np.bincount(part[half], minlength=PARTS)
        square = np.bincount(part[half], fit.held_out_residual[half] ** 2, PARTS)
        level = np.sqrt(square / np.maximum(count, 1)) / total
        ratios.append(np.where(count >= FEWEST_ROWS, level, 0.0))
    level = np.minimum(*ratios)
    worst = int(np.argmax(level))
    if not level[worst] > WORSE:
        return None, WORSE
    ends = (
        stroke["position_start"] + stroke["position_length"] * np.array([worst, worst + 1]) / PARTS
    )
    low, high = (number(float(end)) for end in ends)
    return f"between {low} and {high} {fit.model.position_unit}", float(level[worst])
