"""Which samples and which moves carry what an effect gains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.carrying import fewest
from stribeck.diagnosis.in_band import held_out_in_band
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.recording.moves import moves

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Carried:
    """What carries the gain of an effect.

    Both follow from what the effect changes in the prediction, squared. The squared error of a
    least-squares fit falls by that: it is the gain without the noise.

    Attributes
    ----------
    share
        Share of the samples fitted to that carries 90 % of the gain: the fewest that do.
    events
        Number of moves that carry 90 % of it: the fewest that do, of those in which the held-out
        error falls. A move ends at a reversal or a stop.
    """

    share: float
    events: int

    @classmethod
    def of(cls, claim: Claim) -> Carried:
        """What carries a claim."""
        changed = claim.change**2
        without, along = squares_of_moves(claim)
        of_moves = np.bincount(move_of(claim), changed, without.size)[along < without]
        share = fewest(changed) / max(changed.size, 1)
        return cls(share, fewest(of_moves.astype(np.float64)))

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"share": self.share, "events": self.events}


def move_of(claim: Claim) -> NDArray[np.intp]:
    """The move of each sample that was fitted to, int array [m]."""
    return np.maximum(moves(claim.before.recording)[claim.rows], 0)


def squares_of_moves(claim: Claim) -> tuple[Array, Array]:
    """Squared held-out error of each move, without and with the effect."""
    fits = claim.before, claim.after
    return _of_moves(claim, *(claim.before.weighted(f.held_out_residual[claim.rows]) for f in fits))


def squares_in_band(claim: Claim) -> tuple[Array, Array]:
    """The same in the band of the motion."""
    fits = claim.before, claim.after
    return _of_moves(claim, *(held_out_in_band(fit, claim.before) for fit in fits))


def _of_moves(claim: Claim, without: Array, along: Array) -> tuple[Array, Array]:
    """Sums of squares of each move, of two residuals [m]."""
    move = move_of(claim)
    squares = (np.bincount(move, residual**2).astype(np.float64) for residual in (without, along))
    first, second = squares
    return first, second
