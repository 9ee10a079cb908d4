"""The recordings that the loop is judged on.

Every effect alone, pairs, nothing at all, limited motions, closed loop.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import karnopp
import polars as pl
from stribeck.benchmark import open_loop

PAIRS = (
    ("load", "stribeck"),
    ("stribeck", "temperature_viscous"),
    ("load", "temperature_viscous"),
    ("position", "temperature_dry"),
    ("offset", "load"),
    ("inertia", "stribeck"),
    ("gravity", "temperature_viscous"),
    ("direction", "stribeck"),
    ("nonlinear_viscous", "temperature_dry"),
    ("presliding", "load"),
    ("gain", "load"),
    ("spring", "stribeck"),
    ("ripple", "position"),
    ("drift", "temperature_dry"),
    ("saturation", "temperature_viscous"),
)

#: A presliding distance that the samples resolve is never a small effect: its sizes are larger.
SIZES = {"presliding": (3.0, 1.5, 4.0)}
USUAL_SIZES = (1.0, 3.0, 0.5)

#: (limit, hidden effect): nothing, something the motion cannot show, something that it can.
LIMITED = (
    ("isothermal", "none"),
    ("isothermal", "temperature_dry"),
    ("isothermal", "load"),
    ("one_direction", "none"),
    ("one_direction", "direction"),
    ("one_direction", "load"),
    ("constant_load", "none"),
    ("constant_load", "load"),
    ("constant_load", "stribeck"),
    ("no_slow_motion", "none"),
    ("no_slow_motion", "stribeck"),
    ("no_slow_motion", "load"),
    ("warm_up_only", "none"),
    ("warm_up_only", "load"),
    ("short_range", "none"),
    ("short_range", "load"),
    ("constant_load", "gain"),
    ("one_direction", "ripple"),
    ("warm_up_only", "drift"),
)


#: Hidden effects that a limited motion shows as others: those may be named instead.
SHOWN_AS = {
    ("constant_load", "gain"): ("offset", "gravity", "direction"),
    ("warm_up_only", "drift"): ("temperature_dry",),
}

#: Single effects of the quick cases: one of every kind.
QUICK = ("stribeck", "load", "temperature_viscous", "position", "drift")


@dataclass(frozen=True)
class Case:
    """One recording to make, and how it is judged."""

    name: str
    group: str
    effects: tuple[str, ...]
    seed: int
    size: float = 1.0
    limit: str | None = None
    closed_loop: bool = False
    quick: bool = False

    def make(self) -> tuple[pl.DataFrame, dict[str, Any]]:
        """The recording and its truth."""
        if self.closed_loop:
            return karnopp.make_closed_loop(self.effects, self.seed, self.size)
        limits = {self.limit: True} if self.limit else {}
        return open_loop.make(self.effects, self.seed, self.size, **limits)


def _cases(seeds: int) -> Iterator[Case]:
    for i, effect in enumerate(open_loop.EFFECTS):
        sizes = SIZES.get(effect, USUAL_SIZES)
        for k in range(seeds):
            size = sizes[k % 3]
            seed = 1000 + 100 * i + k
            name, quick = f"{effect}-{size:g}-{seed}", k == 0 and effect in QUICK
            yield Case(name, "single", (effect,), seed, size, quick=quick)
    for i, pair in enumerate(PAIRS):
        size = 4.0 if "presliding" in pair else 2.0
        seed = 4100 + i
        yield Case("+".join(pair) + f"-{seed}", "pair", pair, seed, size)
    for k in range(8):
        yield Case(f"none-{5000 + k}", "none", ("none",), 5000 + k, quick=k == 0)
    for i, (limit, effect) in enumerate(LIMITED):
        seed = 6000 + i
        name = f"{limit}-{effect}-{seed}"
        quick = effect == "none" and limit == "isothermal"
        yield Case(name, "limit", (effect,), seed, 1.0, limit, quick=quick)
    closed = ("none", "stribeck", "load", "temperature_viscous", "position", "inertia", "none")
    for i, effect in enumerate(closed):
        seed = 7000 + i
        size = 2.0
        name = f"closed-{effect}-{seed}"
        yield Case(name, "closed", (effect,), seed, size, closed_loop=True, quick=i == 1)


def cases(seeds: int = 3) -> list[Case]:
    """All cases, with `seeds` recordings for every single effect."""
    return list(_cases(seeds))


@dataclass
class Verdict:
    """What an answer of the loop is worth on one case."""

    problems: list[str]
    found: list[str]
    ratio: float
    untestable_ok: bool

    @property
    def passed(self) -> bool:
        """Nothing to complain about."""
        return not self.problems


def judge(truth: dict[str, Any], answer: dict[str, Any]) -> Verdict:
    """Compare the JSON of `improve` with the truth.

    Hidden effects must be named, or listed as indistinguishable from what was named; nothing else
    may be added, but what the hidden effect contains (friction that differs between quadrants grows
    with the load) and what a motion shows in place of it; the held-out error must end
    at the noise, not above and not below; what the motion cannot show must be listed as untestable
    and never claimed, and what it leaves in the error must not be called noise.
    """
    steps = answer["steps"]
    found = [s["effect"] for s in steps]
    hidden = [e for e in truth["hidden"] if e != "none"]
    # A motion hides effects that nobody makes here (quadrant, frictional_lag) as well.
    cannot = set(truth["cannot_show"]) & set(open_loop.EFFECTS)
    visible = [e for e in hidden if e not in cannot]
    problems: list[str] = []

    def names(step: dict[str, Any]) -> set[str]:
        return {step["effect"], *step.get("indistinguishable_from", [])}

    shown_as = {e for h in hidden for e in SHOWN_AS.get((truth["limit"], h), ())}
    shown_as |= set(truth.get("implied", ()))
    open_effects = list(visible)
    if open_effects and not found:
        problems.append(f"nothing found, hidden: {visible}")
    for i, step in enumerate(steps):
        match = [e for e in open_effects if e == step["effect"]]
        match = match or [e for e in open_effects if e in names(step)]
        if match:
            open_effects.remove(match[0])
        elif step["effect"] not in shown_as:
            which = "first" if i == 0 else "further"
            problems.append(f"{which} step {step['effect']} is not hidden: {visible or 'nothing'}")
    if open_effects and found:
        problems.append(f"missed {open_effects}")
    claimed = cannot & set(found)
    if claimed:
        problems.append(f"claimed what the motion cannot show: {sorted(claimed)}")
    untestable = {u["effect"] for u in answer.get("untestable", [])}
    silent = sorted(cannot - untestable)
    if silent:
        problems.append(f"not listed as untestable: {silent}")
    wrong = sorted(set(visible) & untestable)
    if wrong:
        problems.append(f"visible but listed as untestable: {wrong}")
    ratio = answer["final"]["rmse_held_out"] / truth["noise_rms"]
    unseen = set(hidden) & cannot and answer["stopped"] != "noise_floor"
    if not 0.95 <= ratio <= 1.05 and not (unseen and ratio > 1.05):
        problems.append(f"held-out RMSE is {ratio:.3f} of the noise")
    return Verdict(problems, found, ratio, not silent and not wrong)
