"""Rule: an effect shows in several independent events, and not in one alone."""

from __future__ import annotations

import numpy as np

from stribeck.diagnosis.carrying import FEWEST_MOVES
from stribeck.diagnosis.least_fall import reduced
from stribeck.diagnosis.plausibility.carried import Carried, move_of, squares_of_moves
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.effect.base import number


def few_events(claim: Claim) -> str | None:
    """Why too few moves carry the effect; None where enough do."""
    events = Carried.of(claim).events
    if events >= FEWEST_MOVES:
        return None
    carry = "move carries" if events == 1 else "moves carry"
    return f"only {events} {carry} 90 % of what it gains, and at least {FEWEST_MOVES} must"


def one_event(claim: Claim) -> str | None:
    """Which move alone shows the effect; None where it shows without any of them.

    Left out, the held-out error of the other moves falls less than a finding must bring: half of
    the least fall for one that shows in the band of the motion, and brings no more with that move.
    """
    squares = squares_of_moves(claim)
    gain = squares[0] - squares[1]
    best = int(np.argmax(gain))
    others = [float(square.sum() - square[best]) for square in squares]
    whole = _fall(*(float(square.sum()) for square in squares))
    needed = claim.least_fall if whole >= claim.least_fall else reduced(claim.least_fall)
    if others[0] > 0.0 and _fall(*others) >= needed:
        return None
    first = claim.rows[move_of(claim) == best][0]
    at = float(claim.before.recording.time[first])
    return f"without the move that begins at {number(at)} s it would not be found"


def _fall(without: float, along: float) -> float:
    """Relative fall of the RMSE from squared errors without and with an effect."""
    return 1.0 - float(np.sqrt(along / without)) if without > 0.0 else 0.0
