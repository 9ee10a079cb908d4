"""A motion that shows effects which the data at hand cannot show, or cannot tell apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from stribeck.base.errors import SpecError, option
from stribeck.diagnosis.diagnose import LEAST_FALL
from stribeck.diagnosis.testable import untestable
from stribeck.diagnosis.trials.trial import SIGNIFICANCE
from stribeck.diagnosis.visibility.power import Demand, Noise
from stribeck.diagnosis.visibility.visibility import problem_of
from stribeck.effect.registry import of_catalog
from stribeck.effect.thermal import WARMING
from stribeck.fitting.result import Fit
from stribeck.models.catalog import catalog, check_effect, effect_ids
from stribeck.models.model import Model
from stribeck.models.model_file import ModelFile
from stribeck.motion.design.fourier import FourierMotions
from stribeck.motion.design.information import Sight, Wanted, sight
from stribeck.motion.design.motion import Family, Limits
from stribeck.motion.design.passes import PassMotions
from stribeck.motion.design.result import Plan, Prospect, Size
from stribeck.motion.design.search import search
from stribeck.motion.design.setting import Setting, setting_of_file, setting_of_fit
from stribeck.recording.recording import Recording

#: Samples a second of a motion for a joint of which no recording is given.
RATE = 100.0
SHORTEST, LONGEST = 5.0, 3600.0
#: A motion is at least so many times faster than the noise of the velocity.
FASTER = 5.0


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
    separate = tuple(dict.fromkeys(separate))
    effects = _checked(of.model, separate, show)
    setting = setting_of_fit(of) if isinstance(of, Fit) else setting_of_file(of, limits, noise)
    if any("temperature" in catalog()["effects"][e]["channels"] for e in effects):
        # No motion at one temperature shows such an effect.
        (usual,) = setting.temperatures
        setting = replace(setting, temperatures=(usual - WARMING / 2, usual + WARMING / 2))
    _check_load(effects, setting)
    _check_speed(limits, setting)
    samples = _rate(rate, fitted)
    _check_size(duration, samples)
    families: tuple[Family, ...] = (
        FourierMotions(limits, duration, samples),
        PassMotions(limits, duration),
    )
    at_hand = problem_of(fitted) if fitted is not None else None
    reference = at_hand or setting.problem(
        setting.recording(families[1].motion(families[1].start, samples), samples)
    )
    residual = None if fitted is None else fitted.residual
    wanted = Wanted.of(reference, residual, show, separate)
    kind, motion = search(families, wanted, setting, duration, samples, seed)
    demand = Demand(SIGNIFICANCE / len(effect_ids()), LEAST_FALL)
    planned = setting.recording(motion, samples)
    after = sight(wanted, setting.problem(planned), setting.expected_noise(planned), demand)
    before = None
    if fitted is not None and at_hand is not None:
        before = sight(wanted, at_hand, Noise.of(fitted.residual[fitted.rows]), demand)
    return Plan(
        model=of.model,
        motion=motion,
        rate=samples,
        kind=kind,
        limits=limits,
        prospects=tuple(_prospect(e, wanted, before, after) for e in effects),
        cosines={
            pair: (None if before is None else before.cosines[pair], cosine)
            for pair, cosine in after.cosines.items()
        },
        source=None if fitted is None else fitted.recording.path,
        seed=seed,
        notes=(*setting.notes, *_still_hidden(effects, setting, planned)),
    )


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
        raise SpecError(f"no effect is given: give {option('separate')} or {option('show')}")
    if len(set(separate)) == 1:
        raise SpecError(
            f"{separate[0]} alone cannot be separated: give {option('separate')} two effects or "
            f"more, or {option('show', separate[0])}"
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


def _check_speed(limits: Limits, setting: Setting) -> None:
    if limits.speed < FASTER * setting.slowest:
        unit = setting.model.position_unit
        raise SpecError(
            f"motion slower than {setting.slowest:.3g} {unit}/s is lost in the noise of the "
            f"velocity: give a largest speed of at least {FASTER * setting.slowest:.3g} {unit}/s"
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


def _prospect(effect: str, wanted: Wanted, before: Sight | None, after: Sight) -> Prospect:
    one = wanted.widened[effect]
    return Prospect(
        effect,
        one.size.name,
        one.size.unit,
        one.is_inverse,
        None if before is None else Size.of(before.smallest[effect]),
        Size.of(after.smallest[effect]),
        of_catalog(effect).design_note,
    )
