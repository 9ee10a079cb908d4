"""Standard errors and held-out errors of what is identified of a robot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from stribeck.identify.errors.covariance import covariance_of, seen
from stribeck.identify.errors.estimates import APART, Estimate, reached
from stribeck.robot.result import BaseEstimate, JointFit, Payload
from stribeck.robot.solve import Solved

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Errors:
    """The covariance of all parameters.

    Attributes
    ----------
    covariance : array [P, P]
        Valid for residuals that are correlated in time and between joints.
    shown : bool array [P]
        Parameters that the motion determines.
    quantile
        Standard errors to each end of a 95 % interval.
    """

    base: tuple[BaseEstimate, ...]
    covariance: Array
    shown: NDArray[np.bool_]
    at_bound: NDArray[np.bool_]
    quantile: float


def base_estimates(solved: Solved) -> Errors:
    """The base parameters, and the covariance of all parameters."""
    jacobian, residual, cell = solved.stacked()
    lowest, highest = solved.balance.bounds()
    values = solved.values.whole()
    held = lowest == highest
    at_bound = ~held & reached(values, lowest, highest)
    covariance, freedom = covariance_of(jacobian, residual, cell, ~held & ~at_bound, APART)
    base = solved.balance.base
    errors = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    quantile = float(scipy.special.stdtrit(freedom, 0.975))
    low, high = values - quantile * errors, values + quantile * errors
    rows = tuple(
        BaseEstimate(
            text, float(values[k]), float(errors[k]), (float(low[k]), float(high[k])), unit
        )
        for k, (text, unit) in enumerate(zip(base.texts, base.units, strict=True))
    )
    return Errors(rows, covariance, seen(jacobian, ~held, APART), at_bound, quantile)


@dataclass(frozen=True)
class Scores:
    """Errors of every joint: RMS of the residual over scored samples.

    Attributes
    ----------
    raw, raw_held_out : arrays [N]
        Of the torque as recorded.
    filtered, filtered_held_out : arrays [N]
        After the low-pass.
    cells : array [N, cells]
        Held-out sums of squares after the low-pass.
    """

    raw: Array
    raw_held_out: Array
    filtered: Array
    filtered_held_out: Array
    cells: Array

    @classmethod
    def of(cls, solved: Solved, *, raw: bool = True) -> Scores:
        """Errors on the samples fitted to, and without the group of each sample.

        Without `raw`, those of the torque as recorded are not computed: they are the filtered ones.
        """
        balance = solved.balance
        rows = balance.scored_rows
        steps = solved.held_out_steps()
        figures = []
        as_recorded = balance.factors(solved.values, filtered=False) if raw else solved.factors
        for factors in (as_recorded, solved.factors):
            fitted = np.array([joint.square(solved.every) for joint in factors])
            left = np.zeros((len(factors), balance.group_of_cell.size))
            for j, (joint, place) in enumerate(zip(factors, solved.places(), strict=True)):
                for group, step in steps.items():
                    cells = balance.group_of_cell == group
                    left[j, cells] = joint.squares_after(step[place], cells)
            figures.append((fitted, left))
        (recorded, recorded_left), (filtered, filtered_left) = figures
        return cls(
            np.sqrt(recorded / rows),
            np.sqrt(recorded_left.sum(axis=1) / rows),
            np.sqrt(filtered / rows),
            np.sqrt(filtered_left.sum(axis=1) / rows),
            filtered_left,
        )


def joint_fits(solved: Solved, errors: Errors) -> tuple[JointFit, ...]:
    """The friction of each joint, with its errors on the samples fitted to and held out."""
    balance, scores = solved.balance, Scores.of(solved)
    made = []
    for joint, model in enumerate(balance.models):
        size = balance.torque_size(joint)
        made.append(
            JointFit(
                balance.motion.robot.names[joint],
                model.with_values(solved.values.friction[joint]),
                _of_joint(solved, errors, joint),
                float(scores.raw[joint]),
                float(scores.raw_held_out[joint]),
                float(scores.filtered[joint]) / size,
                float(scores.filtered_held_out[joint]) / size,
            )
        )
    return tuple(made)


def _of_joint(solved: Solved, errors: Errors, joint: int) -> dict[str, Estimate]:
    low, high = solved.balance.bounds()
    place = solved.places()[joint][solved.values.base.size :]
    made = {}
    for parameter, k in zip(solved.balance.models[joint].parameters, place, strict=True):
        known = bool(errors.shown[k]) and not errors.at_bound[k] and low[k] < high[k]
        made[parameter.name] = Estimate.symmetric(
            parameter,
            float(solved.values.whole()[k]),
            float(np.sqrt(errors.covariance[k, k])) if known else None,
            errors.quantile,
            (float(low[k]), float(high[k])),
            at_bound=bool(errors.at_bound[k]),
            identifiable=bool(errors.shown[k]),
            held=bool(low[k] == high[k]),
        )
    return made


def payload_of(solved: Solved, errors: Errors) -> Payload | None:
    """The payload, where runs carry one; its columns follow the base parameters."""
    first = solved.balance.base.count
    for cause in solved.balance.causes:
        if cause.id == "payload":
            break
        first += cause.count
    else:
        return None
    mass, *moment = solved.values.base[first : first + 4]
    error = float(np.sqrt(errors.covariance[first, first]))
    reach = errors.quantile * error
    centre = tuple(float(m / mass) for m in moment) if mass > 0 else None
    return Payload(
        cause.runs,
        float(mass),
        error,
        (float(mass - reach), float(mass + reach)),
        None if centre is None else (centre[0], centre[1], centre[2]),
    )
