"""Information of a recording about effects: the criterion of a plan, and its results.

D_s-optimality for the sizes of the wanted effects: the torque of each effect outside the span of
the model and of the other wanted effects. The plan maximises the smallest of these (maximin).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stribeck.diagnosis.visibility.added_effect import AddedEffect
from stribeck.diagnosis.visibility.model_space import ModelSpace
from stribeck.diagnosis.visibility.power import Demand, ExpectedNoise, Noise
from stribeck.diagnosis.visibility.smallest import VisibleEffect, smallest_visible
from stribeck.diagnosis.visibility.subspace import orthonormal, outside_span, sine_to_span
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.motion.design.motion import SampledMotion
from stribeck.motion.design.setting import Setting

Array = NDArray[np.float64]

#: Size of a wanted effect on the reference motion in the criterion, as a share of friction.
WEIGHED = 0.1


@dataclass(frozen=True)
class Wanted:
    """Effects that a plan is to show.

    Attributes
    ----------
    widened
        The model with each effect added, on a reference recording.
    apart
        Effects that are also to be distinguished from each other.
    sizes
        Size of each effect at which all have the same torque RMS on the reference.
    """

    widened: Mapping[str, AddedEffect]
    apart: tuple[str, ...]
    sizes: Mapping[str, float]

    @classmethod
    def of(
        cls, reference: Problem, residual: Array | None, show: Sequence[str], apart: Sequence[str]
    ) -> Wanted:
        """Add each effect to the model of `reference`, and compute its weight."""
        effects = dict.fromkeys((*apart, *show))
        widened = {e: AddedEffect.of(reference, e, residual) for e in effects}
        level = WEIGHED * rms(reference.target - reference.known[reference.rows])
        sizes = {}
        for effect, one in widened.items():
            unit = rms(typical_torque(one))
            sizes[effect] = level / unit if unit > 0 else 1.0
        return cls(widened, tuple(apart), sizes)

    def others(self, effect: str) -> list[str]:
        """Effects from which `effect` is to be distinguished."""
        return [e for e in self.apart if e != effect] if effect in self.apart else []


def typical_torque(one: AddedEffect) -> Array:
    """Torque per unit of size, array [m]; for a bristle, at a medium stiffness."""
    return one.torque_of(one.sizes(3)[1]) if one.is_nonlinear else one.unit_torque()


def columns_of(one: AddedEffect) -> Array:
    """Basis of the torques of the effect near its start values, array [m, k]."""
    return typical_torque(one)[:, None] if one.is_nonlinear else one.spaces(1)[0]


def least_information(
    wanted: Wanted, setting: Setting, motion: SampledMotion, rate: float
) -> float:
    """Logarithm of the smallest signal energy of a wanted effect, in T2 s.

    The weights are the same for every motion. The result is -inf if an effect is not visible.
    """
    recording = setting.recording(motion, rate)
    problem = setting.problem(recording)
    if problem.rows.size < 50:
        return -np.inf
    beside = ModelSpace(problem)
    here = {effect: one.on(problem) for effect, one in wanted.widened.items()}
    spaces = {effect: beside.outside(columns_of(here[effect])) for effect in wanted.apart}
    least = np.inf
    for effect, one in here.items():
        left = beside.outside(wanted.sizes[effect] * typical_torque(one)[:, None])
        others = [spaces[e] for e in wanted.others(effect)]
        if one.simpler.size:
            others.append(beside.outside(one.simpler_columns()))
        if others:
            left = outside_span(orthonormal(np.column_stack(others)), left)
        least = min(least, float(np.sum(left**2)) / rate)
    return float(np.log(least)) if least > 0 else -np.inf


@dataclass(frozen=True)
class Sight:
    """Visibility of the wanted effects in a recorded or planned motion.

    Attributes
    ----------
    smallest
        Smallest size of each effect that is visible and distinguishable from the others.
    cosines
        Similarity of each pair of effects to distinguish, after projection on the model, 0 to 1.
    """

    smallest: Mapping[str, VisibleEffect]
    cosines: Mapping[tuple[str, str], float]


def sight(wanted: Wanted, problem: Problem, noise: Noise | ExpectedNoise, demand: Demand) -> Sight:
    """Return the visibility in the recording of `problem`."""
    base = problem.predict(problem.model.values)[problem.rows]
    here = {effect: one.on(problem) for effect, one in wanted.widened.items()}
    spaces = {effect: columns_of(here[effect]) for effect in wanted.apart}
    smallest = {}
    for effect, one in here.items():
        others = [spaces[e] for e in wanted.others(effect)]
        beside = ModelSpace(problem, np.column_stack(others) if others else None)
        smallest[effect] = smallest_visible(one, [(beside, demand)], noise, base)
    alone = ModelSpace(problem)
    left = {e: alone.outside(typical_torque(here[e])[:, None])[:, 0] for e in wanted.apart}
    span = {e: orthonormal(alone.outside(spaces[e])) for e in wanted.apart}
    cosines = {}
    for k, one_ in enumerate(wanted.apart):
        for other in wanted.apart[k + 1 :]:
            angle = min(
                sine_to_span(left[one_], span[other]), sine_to_span(left[other], span[one_])
            )
            cosines[one_, other] = float(np.sqrt(max(0.0, 1.0 - angle**2)))
    return Sight(smallest, cosines)
