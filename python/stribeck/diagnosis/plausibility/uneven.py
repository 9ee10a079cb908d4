"""Rule: the torque of an effect is the same function in all conditions.

An effect that stands in for another one is fitted to the conditions in which the two agree: what
acts in slow motion alone and depends on the position is, on average, friction that depends on the
position. Its torque then has another size where they differ. So has that of a right effect on which
one acts that is missing too.

For a series, such as waves along the stroke, the channel that it reads is no such condition: of a
narrow tight spot its terms are wrong in one half of the stroke.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.visibility.subspace import orthonormal, outside_span
from stribeck.effect.base import number
from stribeck.effect.describe import is_friction
from stribeck.effect.registry import find
from stribeck.fitting.result import Fit
from stribeck.identify.errors.added_torque import added_torque_test
from stribeck.identify.problem import Problem
from stribeck.models.catalog import effect_row

Array = NDArray[np.float64]

#: Largest ratio of the sizes in two halves of the samples.
RATIO = 3.0
#: Probability below which noise does not explain a difference of the sizes.
CERTAIN = 1e-5
#: Share of the difference that the parameters of the model must not be able to imitate.
OWN = 0.5


def uneven(claim: Claim) -> str | None:
    """In which half of the samples a friction effect is much larger; None where in none."""
    if claim.torque is None or not is_friction(claim.effect):
        return None
    fit = claim.after
    problem = Problem(
        fit.recording, fit.model, fit.rows, fit.load, loss_weight=claim.before.loss_weight
    )
    residual, jacobian = map(problem.weighted, problem.linearise(fit.model.values))
    basis = orthonormal(jacobian)
    for halves in _all_halves(fit, claim.effect):
        side = halves.side(claim.torque**2)
        if np.ptp(side) == 0.0:
            continue
        wider = problem.weighted(claim.torque * side)
        own = outside_span(basis, wider[:, None])[:, 0]
        square = float(own @ own)
        if square <= OWN * float(wider @ wider):
            continue
        change = float(own @ residual) / square
        noise = residual - change * own
        if added_torque_test(change * own, noise, 1) < CERTAIN and _ratio(change) > RATIO:
            return halves.sentence(change)
    return None


def _ratio(change: float) -> float:
    """The larger size divided by the smaller one, for sizes of 1 - `change`/2 and 1 + `change`/2.

    Infinite where the smaller one is not positive.
    """
    larger, smaller = 2.0 + abs(change), 2.0 - abs(change)
    return larger / smaller if smaller > 0.0 else np.inf


@dataclass(frozen=True)
class _Halves:
    """The samples by one condition: the `lower` half and the `upper` half of `values` [m]."""

    values: Array
    lower: str
    upper: str

    def side(self, weight: Array) -> Array:
        """-1/2 in the lower half and 1/2 in the upper one, which have the same `weight` [m]."""
        order = np.argsort(self.values, kind="stable")
        reached = np.cumsum(weight[order])
        middle = int(np.searchsorted(reached, 0.5 * reached[-1]))
        return np.where(self.values > self.values[order[middle]], 0.5, -0.5)

    def sentence(self, change: float) -> str:
        """Where the effect is larger."""
        larger, smaller = (self.upper, self.lower) if change > 0 else (self.lower, self.upper)
        ratio = _ratio(change)
        much = f"{number(ratio)} times" if ratio < 10.0 else "many times"
        return f"its torque is not the same everywhere: {larger} it is {much} that {smaller}"


def _all_halves(fit: Fit, effect: str) -> Iterator[_Halves]:
    """The halves by every channel, of a series without its own."""
    r, rows = fit.recording, fit.rows
    row, known = effect_row(effect), find(effect)
    own = row["channels"] if row is not None and known is not None and known.series else ()
    for channel, values, lower, upper in (
        ("velocity", np.abs(r.velocity), "in slow motion", "in fast motion"),
        ("time", r.elapsed, "in the first part of the recording", "in the last part of it"),
        ("position", r.position, "at low positions", "at high positions"),
        ("load_torque", r.load_torque, "at low load torque", "at high load torque"),
        ("temperature", r.temperature, "at low temperatures", "at high temperatures"),
    ):
        if values is not None and channel not in own:
            yield _Halves(values[rows], lower, upper)
