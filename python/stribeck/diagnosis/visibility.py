"""What a recording could have shown: the smallest effects, and those that look alike on it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import StribeckError
from stribeck.base.pool import on_threads
from stribeck.diagnosis.leverage import held_out
from stribeck.diagnosis.power import Demand, ExpectedNoise, Noise, needed_factor
from stribeck.diagnosis.shape import flexible_columns
from stribeck.diagnosis.tangent import Beside, Widened, orthonormal, rest, sine
from stribeck.diagnosis.testable import Untestable
from stribeck.effect.registry import of_catalog
from stribeck.fitting.result import Fit
from stribeck.fitting.rigid_body import own_load
from stribeck.identify.confounded import partners, reason
from stribeck.identify.figures import rms
from stribeck.identify.problem import Problem
from stribeck.models.catalog import effect_row, simpler_effect

Array = NDArray[np.float64]

#: Two effects are told apart if this many times the smallest visible size is enough for it.
TOLD_APART = 3.0
#: Sine of the angle to a model from which on it is not the model that hides an effect.
TAKEN_UP = 0.3
#: Share of a torque from which on it is more than what rounding leaves of it.
INVISIBLE = 1e-8
#: Sizes between which the smallest visible one of an effect is looked for, if it is not linear.
SIZES = 9


@dataclass(frozen=True)
class SmallestVisible:
    """The smallest effect that the diagnosis would have seen, with 95 % probability.

    Attributes
    ----------
    rms
        Of its torque over the rows fitted to, in `unit`.
    parameter, value, parameter_unit
        The effect's size at which it has this torque, its other parameters at their starts.
    """

    effect: str
    rms: float
    unit: str
    parameter: str
    value: float
    parameter_unit: str

    def to_dict(self) -> dict[str, Any]:
        """The JSON of one row of `smallest_visible`."""
        return {
            "effect": self.effect,
            "rms": self.rms,
            "unit": self.unit,
            "parameter": self.parameter,
            "value": self.value,
            "parameter_unit": self.parameter_unit,
        }


@dataclass(frozen=True)
class Group:
    """Effects that look alike on a recording.

    Attributes
    ----------
    rms
        Torque (RMS) that one of them would need for the recording to tell it from another;
        infinite where no size is enough.
    """

    effects: tuple[str, ...]
    rms: float
    unit: str

    def to_dict(self) -> dict[str, Any]:
        """The JSON of one row of `indistinguishable`."""
        rms = self.rms if np.isfinite(self.rms) else None
        return {"effects": list(self.effects), "rms_to_tell_apart": rms, "unit": self.unit}


@dataclass(frozen=True)
class Visibility:
    """What a recording could have shown beside a model.

    Attributes
    ----------
    smallest
        Of each effect that was not found, the smallest that would have been; smallest first.
    groups
        Effects that this recording cannot tell apart.
    hidden
        Effects that a refit of the model takes up, whatever their size.
    """

    smallest: tuple[SmallestVisible, ...] = ()
    groups: tuple[Group, ...] = ()
    hidden: tuple[Untestable, ...] = ()


@dataclass(frozen=True)
class Shown:
    """One effect beside a model: the torque of the size at hand, and what of it can be seen."""

    widened: Widened
    size: float
    torque: Array
    factor: float

    @property
    def effect(self) -> str:
        return self.widened.effect

    def is_looked_for(self, found: Collection[str]) -> bool:
        """Whether a diagnosis looks for it: one beyond a simpler effect only where that is."""
        simpler = simpler_effect(self.effect)
        return self.widened.simpler.size == 0 or simpler in found

    @property
    def smallest(self) -> float:
        """RMS of the smallest torque that is seen."""
        return self.factor * rms(self.torque) if np.isfinite(self.factor) else np.inf

    def result(self, unit: str) -> SmallestVisible:
        """As users get it."""
        row, curved = self.widened.size, self.widened.is_curved
        value = self.size if curved else self.size * self.factor
        return SmallestVisible(self.effect, self.smallest, unit, row.name, value, row.unit)


def visibility(
    fit: Fit,
    candidates: Iterable[str],
    *,
    found: Collection[str] = (),
    tried: int = 1,
    significance: float = 0.01,
    least_fall: float = 0.01,
) -> Visibility:
    """What of `candidates`, effects that `fit` lacks, its recording shows beside its model.

    Parameters
    ----------
    found
        Effects that were found; they take part in the groups alone.
    tried, significance, least_fall
        What the diagnosis asks of a finding: chance over all effects tried, and the least
        relative fall of the held-out error.
    """
    problem = problem_of(fit)
    base = Beside(problem)
    noise = Noise.of(fit.residual[fit.rows])
    need = Demand(significance / max(tried, 1), least_fall)
    freer = flexible_columns(fit)
    beside = [(base, need)]
    if freer.shape[1]:
        # What a freer form of the effects in the model takes up is not claimed for another.
        beside.append((Beside(problem, freer), replace(need, least_fall=need.least_fall / 2.0)))
    unit, largest = fit.model.torque_unit, _friction(fit)

    def look(effect: str) -> Shown | None:
        try:
            widened = Widened.of(problem, effect, fit.residual)
            forms = of_catalog(effect).forms(fit.recording)
            return show(widened, beside, noise, fit.prediction[fit.rows], forms)
        except StribeckError:
            return None

    shown, hidden = [], []
    with on_threads() as pool:
        looked_at = [one for one in pool.map(look, candidates) if one is not None]
    for one in looked_at:
        if one.smallest <= largest:
            shown.append(one)
        elif (
            one.effect not in found
            and one.is_looked_for(found)
            and not fit.model.has(of_catalog(one.effect).part_of or one.effect)
        ):
            hidden.append(_hidden(one, base, unit))
    smallest = sorted(
        (s.result(unit) for s in shown if s.effect not in found and s.is_looked_for(found)),
        key=lambda s: s.rms,
    )
    groups = indistinguishable(shown, problem, rms(noise.residual), unit)
    return Visibility(tuple(smallest), groups, tuple(hidden))


def problem_of(fit: Fit) -> Problem:
    """The problem that `fit` solves, with the load torque that an effect may depend on."""
    load = fit.load if fit.load is not None else own_load(fit.model, fit.recording)
    return Problem(fit.recording, fit.model, fit.rows, load)


def show(
    widened: Widened,
    beside: Sequence[tuple[Beside, Demand]],
    noise: Noise | ExpectedNoise,
    base: Array,
    guesses: int = 1,
) -> Shown:
    """How much of an effect is seen beside a model, in each form that the model may take.

    Parameters
    ----------
    base : array [m]
        Torque that the model predicts.
    guesses
        Forms that a fit of the effect chooses from by looking at the data: a ripple's periods.
    """
    if widened.is_curved:
        return _least_of_sizes(widened, beside, noise, base)
    torque = widened.unit_torque()
    return Shown(widened, 1.0, torque, _factor(widened, torque, beside, noise, guesses))


def _factor(
    widened: Widened,
    torque: Array,
    beside: Sequence[tuple[Beside, Demand]],
    noise: Noise | ExpectedNoise,
    guesses: int = 1,
    loss: float = 0.0,
) -> float:
    """By what `torque` [m] must be multiplied to be seen; infinite where no size is enough."""
    factors = []
    problem = beside[0][0].problem
    step = beside[0][0].step
    block = problem.recording.block[problem.rows][::step]
    space = widened.own_columns(torque)[::step]
    for base, need in beside:
        left = base.without(torque[:, None])
        if widened.simpler.size:
            left = rest(orthonormal(base.without(widened.simpler_columns())), left)
        square = float(np.sum(left**2))
        if square <= INVISIBLE**2 * float(torque @ torque):
            return np.inf
        variance = noise.variance_along(left[:, 0])
        demand = replace(need, significance=need.significance / guesses)
        factors.append(
            needed_factor(
                square, variance, noise, widened.own.size, demand, loss=loss,
                held_out=held_out(_with_simpler(base, widened), torque[::step], space, block),
            )
        )  # fmt: skip
    return max(factors)


def _with_simpler(base: Beside, widened: Widened) -> Array:
    """Basis, on few rows, of what the model and the simpler effect take up."""
    if widened.simpler.size == 0:
        return base.few
    more = orthonormal(rest(base.few, widened.simpler_columns()[:: base.step]))
    return np.column_stack([base.few, more])


def _least_of_sizes(
    widened: Widened,
    beside: Sequence[tuple[Beside, Demand]],
    noise: Noise | ExpectedNoise,
    base: Array,
) -> Shown:
    """The smallest size that is still seen: between two of a grid, where one is and one not.

    What the wider model leaves of the plain one where its effect is absent is no effect, but an
    error that a fit with it makes, and counts as noise.
    """
    error = beside[0][0].without((widened.absent - base)[:, None])
    if widened.simpler.size:
        error = rest(orthonormal(beside[0][0].without(widened.simpler_columns())), error)
    loud = noise.beside(error[:, 0])
    loss = float(np.sum(error**2))

    def shown(size: float) -> Shown:
        torque = widened.change(size)
        return Shown(widened, size, torque, _factor(widened, torque, beside, loud, loss=loss))

    sizes = widened.sizes(SIZES)
    seen, hidden = shown(sizes[0]), shown(sizes[-1])
    if seen.factor > 1.0:
        return replace(seen, factor=np.inf)
    if hidden.factor <= 1.0:
        return replace(hidden, factor=1.0)
    while len(sizes) > 2:
        middle = len(sizes) // 2
        one = shown(sizes[middle])
        if one.factor <= 1.0:
            seen, sizes = one, sizes[middle:]
        else:
            hidden, sizes = one, sizes[: middle + 1]
    if not np.isfinite(hidden.factor):
        return replace(seen, factor=1.0)
    share = -np.log(seen.factor) / np.log(hidden.factor / seen.factor)
    between = float(seen.size * (hidden.size / seen.size) ** share)
    return replace(shown(between), factor=1.0)


def _friction(fit: Fit) -> float:
    """RMS of the friction that the model predicts: a larger effect would be no addition."""
    friction = fit.prediction - fit.recording.known_torque
    load = own_load(fit.model, fit.recording)
    if load is not None:
        friction = friction - load
    return rms(friction[fit.rows])


def _hidden(one: Shown, base: Beside, unit: str) -> Untestable:
    """Say why an effect is not seen, were it as large as all friction."""
    model = base.problem.model
    columns = np.column_stack([one.torque, base.columns])
    names = (one.effect, *(model.names[k] for k in base.free))
    alike = partners(columns, 0, np.ones(columns.shape[1], dtype=bool))
    why = reason(names, alike)
    if sine(one.torque, base.basis) > TAKEN_UP:
        why = (
            "a part of it shows in one stretch of the recording alone, and no refit without that "
            "stretch foretells it"
        )
    elif np.isfinite(one.smallest):
        why = (
            f"it would be seen from {one.smallest:.2g} {unit} RMS on, more than all friction there "
            f"is ({why}, or nearly)"
        )
    row = effect_row(one.effect)
    needs = "other motion" if row is None else row["needs"]
    return Untestable(one.effect, why, f"record {needs}")


def indistinguishable(
    shown: list[Shown], problem: Problem, noise: float, unit: str
) -> tuple[Group, ...]:
    """Groups of effects of which each looks like each other.

    One looks like the other if telling them apart takes more than `TOLD_APART` times what it
    takes to see it, and more than the noise: the angle between what both show beside the model
    is too small.
    """
    step = Beside(problem).step
    base = Beside(replace(problem, rows=problem.rows[::step]))
    made: dict[str, tuple[Shown, Array, list[Array]]] = {}
    for one in shown:
        try:
            spaces = [orthonormal(base.without(s)) for s in one.widened.spaces(step)]
        except StribeckError:
            continue
        made[one.effect] = (one, base.without(one.torque[::step, None])[:, 0], spaces)
    apart: dict[frozenset[str], float] = {}
    alike: dict[str, set[str]] = {effect: set() for effect in made}
    for effect, (one, left, _) in made.items():
        for other, (_, _, spaces) in made.items():
            if other in (effect, simpler_effect(effect)):
                continue
            if simpler_effect(other) == effect:
                continue
            angle = min(sine(left, space) for space in spaces)
            needed = one.smallest / angle if angle > 1e-8 else np.inf
            if needed > max(TOLD_APART * one.smallest, noise):
                pair = frozenset((effect, other))
                apart[pair] = min(needed, apart.get(pair, np.inf))
                alike[effect].add(other)
                alike[other].add(effect)
    groups = [
        Group(
            tuple(e for e in made if e in members),
            max(apart[frozenset((a, b))] for a in members for b in members if a < b),
            unit,
        )
        for members in cliques(alike)
    ]
    return tuple(groups)


def cliques(alike: dict[str, set[str]]) -> list[frozenset[str]]:
    """Largest sets of two or more in which each is alike each other (Bron and Kerbosch 1973).

    Examples
    --------
    >>> found = cliques({"a": {"b", "c"}, "b": {"a"}, "c": {"a"}})
    >>> sorted("".join(sorted(members)) for members in found)
    ['ab', 'ac']
    """
    found: list[frozenset[str]] = []

    def extend(members: frozenset[str], open_: set[str], closed: set[str]) -> None:
        if not open_ and not closed and len(members) > 1:
            found.append(members)
        for name in sorted(open_):
            extend(members | {name}, open_ & alike[name], closed & alike[name])
            open_ = open_ - {name}
            closed = closed | {name}

    extend(frozenset(), set(alike), set())
    return found
