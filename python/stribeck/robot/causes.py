"""Causes in the rigid bodies, told from friction by the torques of all joints together.

Base parameters absorb whatever moves with the links in every run. What remains to be told is what
they cannot hold: a payload in some runs, springs, a base that is not level, coupled rotors.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.robot.columns import (
    Cause,
    coupling,
    payload,
    spring,
    tilt,
    transmission,
    turned_friction,
)
from stribeck.robot.estimates import Scores
from stribeck.robot.problem import Balance, Values
from stribeck.robot.solve import QUICK, Solved, solve

Array = NDArray[np.float64]

#: Largest probability that noise brings the fall, over all that is tried.
SIGNIFICANCE = 0.01
#: Turns of a motor with another joint that are tried, and the least fall of what is left of its
#: torque, as a share, by friction at that velocity.
TURNS, LEAST_SEEN = (-1.0, -0.5, 0.5, 1.0), 0.1
#: Share of the fall that must lie in the joints whose torque a cause changes. Elsewhere the errors
#: fall where base parameters that it frees take the place of something else.
OWN = 0.5


@dataclass(frozen=True)
class Found:
    """A cause in the rigid bodies that lowers the held-out error of the joints.

    Attributes
    ----------
    confidence
        One minus the probability that noise brings the fall, among all causes tried.
    before, after
        Weighted held-out error of all joints: 1 is the error of the fit without the cause.
    joints
        Those whose held-out error falls most, with the fall as a share.
    own
        Share of the fall that lies in the joints whose torque the cause changes.
    """

    cause: Cause
    confidence: float
    before: float
    after: float
    joints: tuple[tuple[str, float], ...]
    own: float
    solved: Solved

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "cause": self.cause.id,
            "text": self.cause.text,
            "confidence": self.confidence,
            "error_before": self.before,
            "error_after": self.after,
            "joints": [{"joint": name, "fall": fall} for name, fall in self.joints],
        }


def possible(solved: Solved, parameters: Array) -> Iterator[Cause]:
    """Causes that this motion may show."""
    motion = solved.balance.motion
    runs = motion.joints[0].run_names
    carried = {run for cause in solved.balance.causes for run in cause.runs}
    if len(runs) > 1 and not carried:
        # Of two runs, a payload in one is the lack of it in the other.
        yield from (payload(motion, (run,)) for run in (runs if len(runs) > 2 else runs[1:]))
    count = len(motion.joints)
    yield from (spring(motion, joint) for joint in range(count))
    yield from (coupling(motion, k, k + 1) for k in range(count - 1))
    yield from transmissions(solved)
    if motion.robot.gravity[:2] == (0.0, 0.0) and motion.robot.gravity[2] != 0.0:
        yield tilt(motion, parameters)


def transmissions(solved: Solved) -> Iterator[Cause]:
    """Motors that may turn with other joints than stated: one at most for each motor.

    One is offered where what is left of the motor's torque falls much by friction at the velocity
    that the motor would then have.
    """
    balance, motion = solved.balance, solved.balance.motion
    count = len(motion.joints)
    for motor in range(count):
        scored = motion.scored[:, motor]
        load = balance.load(solved.values.base)[:, motor]
        left = balance.problem(motor, load).residual(solved.values.friction[motor])
        left = motion.filtered(left, motor)[scored]
        best = (LEAST_SEEN, motor, 0.0)
        for other, turns in itertools.product(range(count), TURNS):
            if other != motor:
                columns = turned_friction(motion, motor, other, turns)
                columns = motion.filtered(columns, motor)[scored]
                after = left - columns @ linear.least_norm(columns, left)
                fall = 1.0 - float(np.sqrt(np.sum(after**2) / np.sum(left**2)))
                best = max(best, (fall, other, turns))
        _, other, turns = best
        if other != motor:
            friction = balance.problem(motor, load)
            torque = friction.predict(solved.values.friction[motor])
            yield transmission(motion, torque, motor, other, turns)


def rigid_causes(solved: Solved, parameters: Array, least_fall: float) -> list[Found]:
    """The causes that pass the test, best first.

    A cause passes if the held-out error of all joints, weighted by their noise, falls by at least
    `least_fall`, most of that in the joints whose torque it changes, and significantly from cell to
    cell.
    """
    offered = list(possible(solved, parameters))
    found = [_tried(solved, cause, len(offered)) for cause in offered]
    passed = [
        one
        for one in found
        if one.after <= (1.0 - least_fall) * one.before
        and one.own >= OWN
        and one.confidence >= 1.0 - SIGNIFICANCE
    ]
    return sorted(passed, key=lambda one: one.after)


def _tried(solved: Solved, cause: Cause, tried: int) -> Found:
    balance = replace(solved.balance, causes=(*solved.balance.causes, cause))
    # Both sides of the comparison leave out the same samples.
    before = _by(balance, solved)
    extra = np.zeros(cause.count)
    start = Values(np.concatenate([solved.values.base, extra]), solved.values.friction)
    after = solve(balance, start, solved.weights, QUICK)
    scores = Scores.of(before, raw=False), Scores.of(after, raw=False)
    weights = solved.weights[:, None] ** 2
    squares = [weights * one.cells for one in scores]
    sums = [np.sum(one, axis=0) for one in squares]
    left = [one.filtered_held_out for one in scores]
    falls = sorted(
        zip(balance.motion.robot.names, 1.0 - left[1] / left[0], strict=True),
        key=lambda pair: -pair[1],
    )
    rows = float(balance.motion.scored.sum())
    by_joint = np.sum(squares[0] - squares[1], axis=1)
    total = float(by_joint.sum())
    acts = np.any(cause.columns != 0.0, axis=(0, 2))
    return Found(
        cause,
        1.0 - min(1.0, tried * chance(sums[0], sums[1])),
        float(np.sqrt(sums[0].sum() / rows)),
        float(np.sqrt(sums[1].sum() / rows)),
        tuple((name, float(fall)) for name, fall in falls[:3]),
        float(by_joint[acts].sum()) / total if total > 0.0 else 0.0,
        after,
    )


def _by(other: Balance, solved: Solved) -> Solved:
    """The same solution, held out in the groups of another balance."""
    if other.held_out == solved.balance.held_out:
        return solved
    balance = replace(solved.balance, by_block=True)
    return replace(solved, balance=balance, factors=balance.factors(solved.values))


def chance(before: Array, after: Array) -> float:
    """Probability that noise lowers held-out sums of squares so much, from cell to cell.

    A t-test and a signed-rank test of the differences, one-sided, with the smaller probability
    twice (Diebold and Mariano, J. Business and Economic Statistics 13(3), 1995): the t-test says
    little where most of a fall is in few cells.

    Examples
    --------
    >>> cells = np.array([1.0, 1.2, 0.9, 1.1])
    >>> chance(cells, cells) > 0.4, chance(cells, 0.5 * cells) < 0.01
    (True, True)
    """
    fall = before - after
    error = float(np.std(fall, ddof=1) / np.sqrt(fall.size))
    if error == 0.0:
        return 0.5
    by_size = float(scipy.special.stdtr(fall.size - 1, -float(fall.mean()) / error))
    by_rank = float(scipy.stats.wilcoxon(fall, alternative="greater").pvalue)
    return min(1.0, 2.0 * min(by_size, by_rank))
