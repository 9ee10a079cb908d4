"""Which samples and which moves carry what an effect gains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.carrying import fewest
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.recording.motion.moves import moves

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
    move, before = move_of(claim), claim.before
    without, along = (
        np.bincount(move, before.weighted(fit.held_out_residual[claim.rows]) ** 2)
        for fit in (before, claim.after)
    )
    return without.astype(np.float64), along.astype(np.float64)
