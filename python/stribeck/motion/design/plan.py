"""Find a motion that shows or separates effects which the present data cannot.

The search covers Fourier series and point-to-point motions. It maximises the visibility of the
least visible effect after a refit of the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from stribeck.base.arguments import door
from stribeck.base.errors import SpecError, option
from stribeck.base.pool import serial_linear_algebra
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.diagnosis.testable import untestable
from stribeck.diagnosis.trials.trial import SIGNIFICANCE
from stribeck.diagnosis.visibility.power import Demand, Noise
from stribeck.diagnosis.visibility.visibility import problem_of
from stribeck.effect.registry import of_catalog
from stribeck.effect.thermal import WARMING
from stribeck.fitting.result import Fit
from stribeck.identify.problem import Problem
from stribeck.models.catalog import catalog, check_effect, effect_ids
from stribeck.models.model import Model
from stribeck.models.model_file import WITH_MODEL, ModelFile
from stribeck.motion.design.fourier import FourierMotions
from stribeck.motion.design.information import Sight, Wanted, sight
from stribeck.motion.design.motion import Family, Limits
from stribeck.motion.design.passes import PassMotions
from stribeck.motion.design.result import Plan, Prospect, Size
from stribeck.motion.design.search import search
from stribeck.motion.design.setting import Setting, setting_of_file, setting_of_fit
from stribeck.recording.recording import Recording

#: Sampling rate of a planned motion if there is no recording, Hz.
RATE = 100.0
SHORTEST, LONGEST = 5.0, 3600.0
#: Smallest ratio of the largest speed to the noise of the velocity.
FASTER = 5.0


@door(of=WITH_MODEL)
@serial_linear_algebra
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
    """Find a motion within limits that best shows effects which a model lacks.

    Parameters
    ----------
    of
        A fit to the present data, or a model without data (`read_model_file`).
    position, speed, acceleration
        Limits of every sample, rad or m and s.
    separate, show : sequences of str
        Effects to separate from each other; effects to show.
    duration, rate, noise, seed
        Duration, s; sampling rate, Hz (default: that of the data, else 100 Hz); RMS of the torque
        noise, if a model file does not state it; seed of the search.

    Raises
    ------
    SpecError, FitError
        An effect is in the model already or cannot be planned for; a limit is invalid.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=60.0, rate=100.0, seed=1)[0])
    >>> fitted = sb.fit("coulomb", recording, starts=2)
    >>> limits = {"position": (-1.0, 1.0), "speed": 2.0, "acceleration": 10.0}
    >>> planned = sb.plan(fitted, **limits, show=["load"], duration=10.0)
    >>> bool(abs(planned.motion.velocity).max() <= 2.0)
    True
    """
    limits = Limits(*map(float, (*position, speed, acceleration)))
    fitted = of if isinstance(of, Fit) else None
    effects = _checked(of.model, separate, show)
    setting = _setting(of, limits, noise, effects)
    samples = _rate(rate, fitted)
    _check_size(duration, samples, ", that of the recording," if rate is None and fitted else "")
    moves = PassMotions(limits, duration)
    families: tuple[Family, ...] = (FourierMotions(limits, duration, samples), moves)
    present = None if fitted is None else problem_of(fitted)
    reference = present or _reference(setting, moves, samples)
    residual = None if fitted is None else fitted.residual
    wanted = Wanted.of(reference, residual, show, tuple(dict.fromkeys(separate)))
    kind, motion = search(families, wanted, setting, duration, samples, seed)
    planned = setting.recording(motion, samples)
    _check_moving(planned, limits)
    before, after = _sights(wanted, setting, planned, fitted, present)
    return Plan(
        model=of.model,
        motion=motion,
        rate=samples,
        kind=kind,
        limits=limits,
        prospects=tuple(_prospect(e, wanted, before, after) for e in effects),
        cosines=_cosines(before, after),
        source=None if fitted is None else fitted.recording.path,
        seed=seed,
        notes=(*setting.notes, *_still_hidden(effects, setting, planned)),
    )


def _setting(
    of: Fit | ModelFile, limits: Limits, noise: float | None, effects: Sequence[str]
) -> Setting:
    """Return the conditions of the planned recording, checked for the wanted effects."""
    setting = setting_of_fit(of) if isinstance(of, Fit) else setting_of_file(of, limits, noise)
    if any("temperature" in catalog()["effects"][e]["channels"] for e in effects):
        # A motion at one temperature cannot show such an effect.
        (usual,) = setting.temperatures
        setting = replace(setting, temperatures=(usual - WARMING / 2, usual + WARMING / 2))
    _check_load(effects, setting)
    _check_speed(limits, setting)
    return setting


def _check_moving(planned: Recording, limits: Limits) -> None:
    """Refuse limits within which no sample of the motion counts as moving."""
    if planned.moving.any():
        return
    unit = planned.position_unit
    raise SpecError(
        f"between {limits.low:g} and {limits.high:g} {unit} no sample at {planned.rate_hz:g} Hz "
        f"moves faster than {planned.velocity_threshold:.3g} {unit}/s, above which samples are "
        f"scored: give a longer range with {option('position')}, or a higher {option('rate')}"
    )


def _reference(setting: Setting, moves: PassMotions, rate: float) -> Problem:
    """Return the model on a first motion, used if there are no data."""
    return setting.problem(setting.recording(moves.motion(moves.start, rate), rate))


def _sights(
    wanted: Wanted,
    setting: Setting,
    planned: Recording,
    fitted: Fit | None,
    present: Problem | None,
) -> tuple[Sight | None, Sight]:
    """Return the visibility of the wanted effects in the present data and the planned recording."""
    demand = Demand(SIGNIFICANCE / len(effect_ids()), LEAST_FALL)
    after = sight(wanted, setting.problem(planned), setting.expected_noise(planned), demand)
    if fitted is None or present is None:
        return None, after
    return sight(wanted, present, Noise.of(fitted.residual[fitted.rows]), demand), after


def _still_hidden(effects: Sequence[str], setting: Setting, planned: Recording) -> tuple[str, ...]:
    """Return the effects that a diagnosis would not test on this motion, and why."""
    cannot = untestable(planned, setting.problem(planned).load)
    return tuple(
        f"a diagnosis would not test {e} on this motion ({cannot[e].why}): {cannot[e].do}"
        for e in effects
        if e in cannot
    )


def _checked(model: Model, separate: Sequence[str], show: Sequence[str]) -> tuple[str, ...]:
    """Return the wanted effects; the model must lack each of them."""
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
                f"{effect} depends on the load torque, which is unknown for a new motion: give "
                f"data with load_torque, or a model with identified inertia and gravity"
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
        # Four digits of a measured rate are those of the nominal rate.
        return RATE if fitted is None else float(f"{fitted.recording.rate_hz:.4g}")
    return float(rate)


def _check_size(duration: float, rate: float, of: str) -> None:
    """Refuse a duration or a sampling rate out of range; `of` says whose rate it is."""
    if not SHORTEST <= duration <= LONGEST:
        raise SpecError(
            f"a motion of {duration:g} s is out of range: give {SHORTEST:g} s to {LONGEST:g} s"
        )
    if not 10.0 <= rate <= 1e4:
        raise SpecError(
            f"a rate of {rate:g} Hz{of} is out of range: give 10 Hz to 10000 Hz with "
            f"{option('rate')}"
        )


def _cosines(
    before: Sight | None, after: Sight
) -> dict[tuple[str, str], tuple[float | None, float]]:
    return {
        pair: (None if before is None else before.cosines[pair], cosine)
        for pair, cosine in after.cosines.items()
    }


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
