"""A motion that shows effects which the data at hand cannot show, or cannot tell apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray
from scipy.optimize import differential_evolution

from stribeck.design.advice import ADVICE, OF_TEMPERATURE, WARMING
from stribeck.design.fourier import FourierMotions
from stribeck.design.information import Sight, Wanted, least_information, sight
from stribeck.design.motion import Family, Limits, Motion
from stribeck.design.passes import PassMotions
from stribeck.design.setting import Setting, setting_of_file, setting_of_fit
from stribeck.diagnose import LEAST_FALL
from stribeck.diagnose.power import Demand, Noise
from stribeck.diagnose.testable import untestable
from stribeck.diagnose.trial import SIGNIFICANCE
from stribeck.diagnose.visibility import Shown, problem_of
from stribeck.errors import SpecError
from stribeck.fit import Fit
from stribeck.model import Model, catalog, check_effect, effect_ids
from stribeck.model_file import ModelFile
from stribeck.recording import Recording

Array = NDArray[np.float64]

#: Candidates of a generation and generations of the search, for each family of motions.
CANDIDATES, GENERATIONS = 24, 30
#: Samples of a motion while it is searched; with a memory in the model they must lie closer.
FEW_SAMPLES, MORE_SAMPLES = 1200, 5000
#: Samples a second of a motion for a joint of which no recording is given.
RATE = 100.0
SHORTEST, LONGEST = 5.0, 3600.0


@dataclass(frozen=True)
class Size:
    """The smallest effect that is seen: its parameter's value, and the RMS of its torque."""

    value: float | None
    rms: float | None

    @classmethod
    def of(cls, shown: Shown) -> Size:
        """None where no size is seen."""
        if not np.isfinite(shown.factor):
            return cls(None, None)
        result = shown.result("")
        return cls(float(result.value), float(result.rms))

    def to_dict(self) -> dict[str, float | None]:
        """As JSON."""
        return {"value": self.value, "rms": self.rms}


@dataclass(frozen=True)
class Prospect:
    """What a plan brings for one effect.

    Attributes
    ----------
    inverse
        Whether the effect is the smaller the larger its size.
    before, after
        Smallest size seen on the data at hand (None without data) and on the planned motion.
    advice
        What the motion cannot do for it; empty if nothing.
    """

    effect: str
    parameter: str
    unit: str
    inverse: bool
    before: Size | None
    after: Size
    advice: str

    @property
    def gain(self) -> float | None:
        """How many times smaller an effect is seen; None where that is no number."""
        before = None if self.before is None else self.before.value
        if before is None or self.after.value is None:
            return None
        return self.after.value / before if self.inverse else before / self.after.value

    def to_dict(self) -> dict[str, Any]:
        """As JSON."""
        return {
            "effect": self.effect,
            "parameter": self.parameter,
            "unit": self.unit,
            "before": None if self.before is None else self.before.to_dict(),
            "after": self.after.to_dict(),
            "gain": self.gain,
            "advice": self.advice or None,
        }


@dataclass(frozen=True)
class Plan:
    """A motion, and what a recording of it is expected to show.

    Attributes
    ----------
    motion, rate
        Its samples, and their number a second.
    kind
        Family that it was chosen from.
    cosines
        Of each pair to be told apart, how alike both look: on the data at hand (None without
        data) and on the planned motion.
    """

    model: Model
    motion: Motion
    rate: float
    kind: str
    limits: Limits
    prospects: tuple[Prospect, ...]
    cosines: Mapping[tuple[str, str], tuple[float | None, float]]
    source: str | None
    seed: int
    notes: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """Seconds."""
        return float(self.motion.time[-1])

    def to_dict(self) -> dict[str, Any]:
        """The JSON of `stribeck plan`."""
        m, limits = self.motion, self.limits
        return {
            "model": self.model.spec,
            "data": self.source,
            "motion": {
                "kind": self.kind,
                "duration": self.duration,
                "rate_hz": self.rate,
                "rows": int(m.time.size),
                "position": [float(m.position.min()), float(m.position.max())],
                "speed": float(np.abs(m.velocity).max()),
                "acceleration": float(np.abs(m.acceleration).max()),
            },
            "limits": {
                "position": [limits.low, limits.high],
                "speed": limits.speed,
                "acceleration": limits.acceleration,
            },
            "effects": [row.to_dict() for row in self.prospects],
            "torque_unit": self.model.torque_unit,
            "cosines": [
                {"effects": list(pair), "before": before, "after": after}
                for pair, (before, after) in self.cosines.items()
            ],
            "seed": self.seed,
            "notes": list(self.notes),
        }

    def to_frame(self) -> pl.DataFrame:
        """The motion as a table: time, position, velocity, acceleration."""
        m = self.motion
        return pl.DataFrame(
            {
                name: getattr(m, name) + 0.0
                for name in ("time", "position", "velocity", "acceleration")
            }
        )

    def plot(self) -> Any:
        """Position and speed over time, within their limits, as a matplotlib figure."""
        from stribeck.design.figures import plan_figure

        return plan_figure(self)

    def __repr__(self) -> str:
        from stribeck.design.text import plan_text

        return plan_text(self)


def plan(
    of: Fit | ModelFile,
    *,
    position: tuple[float, float],
    speed: float,
    acceleration: float,
    separate: Sequence[str] = (),
    show: Sequence[str] = (),
    duration: float = 60.0,
    rate: float | None = None,
    noise: float | None = None,
    seed: int = 0,
) -> Plan:
    """Find a motion within limits that shows effects best which a model lacks.

    The motion is searched among Fourier series and point-to-point moves; of all wanted effects
    the least visible one counts, each beside what a refit of the model takes up.

    Parameters
    ----------
    of : Fit or ModelFile
        A fit to the data at hand, or a model of the joint without data (`read_model_file`).
    position, speed, acceleration
        Limits that every sample keeps to, in rad or m and s.
    separate, show : sequences of str
        Effects to be told from each other, and effects to be seen.
    duration, rate : float
        Seconds, and samples a second; default: the rate of the data, else 100 Hz.
    noise : float
        RMS of the torque noise, for a model file that does not say it.
    seed : int
        Of the search; the same seed gives the same motion.

    Raises
    ------
    SpecError, FitError
        Effects that the model has already or that cannot be planned for; limits that are none.
    """
    limits = Limits(float(position[0]), float(position[1]), float(speed), float(acceleration))
    fitted = of if isinstance(of, Fit) else None
    effects = _checked(of.model, separate, show)
    setting = setting_of_fit(of) if isinstance(of, Fit) else setting_of_file(of, limits, noise)
    if set(effects) & set(OF_TEMPERATURE):
        (usual,) = setting.temperatures
        setting = replace(setting, temperatures=(usual - WARMING / 2, usual + WARMING / 2))
    _check_load(effects, setting)
    samples = _rate(rate, fitted)
    _check_size(duration, samples)
    families: tuple[Family, ...] = (
        FourierMotions(limits, duration, samples), PassMotions(limits, duration),
    )  # fmt: skip
    at_hand = problem_of(fitted) if fitted is not None else None
    reference = at_hand or setting.problem(
        setting.recording(families[1].motion(families[1].start, samples), samples)
    )
    residual = None if fitted is None else fitted.residual
    wanted = Wanted.of(reference, residual, show, separate)
    kind, motion = _search(families, wanted, setting, duration, samples, seed)
    demand = Demand(SIGNIFICANCE / len(effect_ids()), LEAST_FALL)
    planned = setting.recording(motion, samples)
    after = sight(wanted, setting.problem(planned), setting.expected_noise(planned), demand)
    before = None
    if fitted is not None and at_hand is not None:
        before = sight(wanted, at_hand, Noise.of(fitted.residual[fitted.rows]), demand)
    return Plan(
        model=of.model, motion=motion, rate=samples, kind=kind, limits=limits,
        prospects=tuple(_prospect(e, wanted, before, after) for e in effects),
        cosines={
            pair: (None if before is None else before.cosines[pair], cosine)
            for pair, cosine in after.cosines.items()
        },
        source=None if fitted is None else fitted.recording.path, seed=seed,
        notes=(*setting.notes, *_still_hidden(effects, setting, planned)),
    )  # fmt: skip


def _still_hidden(effects: Sequence[str], setting: Setting, planned: Recording) -> tuple[str, ...]:
    """What the motion leaves undone by the rules that a diagnosis goes by."""
    cannot = untestable(planned, setting.problem(planned).load)
    return tuple(
        f"a diagnosis would not look for {e} on this motion ({cannot[e].why}): {cannot[e].do}"
        for e in effects
        if e in cannot
    )


def _checked(model: Model, separate: Sequence[str], show: Sequence[str]) -> tuple[str, ...]:
    """The wanted effects, each of which the model must lack."""
    effects = tuple(dict.fromkeys((*separate, *show)))
    if not effects:
        raise SpecError("no effect is given: say which to tell apart (--separate) or --show")
    if len(set(separate)) == 1:
        raise SpecError(
            f"{separate[0]} alone cannot be told apart: give two effects or more to --separate, "
            f"or --show {separate[0]}"
        )
    for effect in effects:
        check_effect(effect)
        if model.has(effect) or effect in model.rigid_body:
            raise SpecError(
                f"{model.spec} has {effect} already: a plan is for effects that a model lacks"
            )
    return effects


def _check_load(effects: Sequence[str], setting: Setting) -> None:
    if setting.load is not None or setting.model.rigid_body:
        return
    for effect in effects:
        if "load_torque" in catalog()["effects"][effect]["channels"]:
            raise SpecError(
                f"{effect} depends on the load, and nothing says what load a motion has here: "
                f"give data with load_torque, or a model with identified inertia and gravity"
            )


def _rate(rate: float | None, fitted: Fit | None) -> float:
    if rate is None:
        # A clock's rate to four digits is the one that it was set to.
        return RATE if fitted is None else float(f"{fitted.recording.rate_hz:.4g}")
    return float(rate)


def _check_size(duration: float, rate: float) -> None:
    if not SHORTEST <= duration <= LONGEST:
        raise SpecError(
            f"a motion of {duration:g} s is out of range: give {SHORTEST:g} s to {LONGEST:g} s"
        )
    if not 10.0 <= rate <= 1e4:
        raise SpecError(f"a rate of {rate:g} Hz is out of range: give 10 Hz to 10000 Hz")


def _search(
    families: Sequence[Family],
    wanted: Wanted,
    setting: Setting,
    duration: float,
    rate: float,
    seed: int,
) -> tuple[str, Motion]:
    """The best motion of all families, and the name of its own."""
    plain = all(one.problem.model.memoryless for one in wanted.widened.values())
    coarse = min(rate, (FEW_SAMPLES if plain else MORE_SAMPLES) / duration)
    found = []
    for k, family in enumerate(families):
        rng = np.random.default_rng([seed, k])
        first = rng.random((CANDIDATES, family.variables))
        first[0] = family.start

        def cost(design: Array, family: Family = family) -> float:
            value = least_information(wanted, setting, family.motion(design, coarse), coarse)
            return -value if np.isfinite(value) else 1e6

        best = differential_evolution(
            cost, [(0.0, 1.0)] * family.variables, maxiter=GENERATIONS, init=first, seed=rng,
            polish=False, tol=1e-4,
        )  # fmt: skip
        found.append((best.fun, family, best.x))
    _, family, design = min(found, key=lambda row: row[0])
    return family.name, family.motion(design, rate)


def _prospect(effect: str, wanted: Wanted, before: Sight | None, after: Sight) -> Prospect:
    one = wanted.widened[effect]
    return Prospect(
        effect, one.size.name, one.size.unit, one.is_inverse,
        None if before is None else Size.of(before.smallest[effect]),
        Size.of(after.smallest[effect]), ADVICE.get(effect, ""),
    )  # fmt: skip
