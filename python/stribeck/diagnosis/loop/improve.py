"""Diagnose and add effects until the residual is noise."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import polars as pl

from stribeck.base.arguments import door
from stribeck.base.errors import FitError
from stribeck.base.pool import on_threads, serial_linear_algebra
from stribeck.base.shown import Plotted
from stribeck.diagnosis.all_samples import (
    on_all_samples,
    with_errors_of,
    with_excerpt_note,
    with_remainder_on_all_samples,
)
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.diagnosis.loop.determined import known_combinations, undetermined
from stribeck.diagnosis.loop.passive import MadePassive, cost_of_passivity
from stribeck.diagnosis.loop.path import ImprovementPath, ImprovementStep
from stribeck.diagnosis.loop.search import MOST_STEPS, improvement_paths
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.result import Diagnosis
from stribeck.diagnosis.testable import Untestable
from stribeck.diagnosis.trials.dry_friction import check_rejected
from stribeck.effect.describe import where
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.errors.confounded import Combination
from stribeck.identify.left_out.rows import rows_left_out
from stribeck.identify.scaling import model_for
from stribeck.identify.search.effort import FROM_NEARBY
from stribeck.identify.stated.choices import ChoiceArguments, Choices, parameters_of_effects
from stribeck.models.model import Model
from stribeck.models.model_file import MODEL
from stribeck.recording.motion.excerpt import SAMPLE_ROWS, excerpt
from stribeck.recording.recording import Recording
from stribeck.recording.several.concat import Recordings, as_one

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True, repr=False)
class Improvement(Plotted):
    """The steps from a base model to one whose residual is noise.

    Attributes
    ----------
    made_passive
        What it costs to make the final model passive, where it is not.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=20.0, rate=50.0, seed=1)[0])
    >>> found = sb.improve("coulomb", recording, starts=1)
    >>> found.to_frame()["model"].to_list()
    ['coulomb', 'coulomb+load']
    >>> found.final.rmse_held_out < 0.2 * found.base.rmse_held_out
    True
    """

    base: Fit
    steps: tuple[ImprovementStep, ...]
    final: Fit
    noise_floor: NoiseFloor
    stopped: str
    untestable: tuple[Untestable, ...]
    unexplained: Unexplained
    last: Diagnosis
    made_passive: MadePassive | None = None

    @property
    def combinations(self) -> tuple[Combination, ...]:
        """What is known of the parameters of the final model that are not determined."""
        return known_combinations(self.final)

    def to_dict(self) -> dict[str, object]:
        """The JSON of `stribeck improve`."""
        made: dict[str, object] = {
            "base": self.base.model.spec,
            "unit": self.final.model.torque_unit,
            "noise_floor": self.noise_floor.value,
            "steps": [step.to_dict() for step in self.steps],
            "final": {
                "model": self.final.model.spec,
                "rmse": self.final.rmse,
                "rmse_held_out": self.final.rmse_held_out,
                "relative_residual": self.final.relative_residual,
                "parameters": {n: e.to_dict() for n, e in self.final.estimates.items()},
                "passive": self.final.passive(),
                "undetermined": undetermined(self.final.estimates),
                "determined_combinations": [c.to_dict() for c in self.combinations],
                "passive_cost": None if self.made_passive is None else self.made_passive.to_dict(),
            },
            "rmse_held_out_base": self.base.rmse_held_out,
            "relative_residual_base": self.base.relative_residual,
            "stopped": self.stopped,
            "demoted": [row.to_dict() for row in self.last.demoted],
            "not_claimed": [row.to_dict() for row in self.last.unclaimed],
            "untestable": [row.to_dict() for row in self.untestable],
            "unexplained": self.unexplained.to_dict(),
            "explainable": self.last.explainable.to_dict() if self.last.explainable else None,
            "trend": self.last.trend.to_dict() if self.last.trend else None,
            "smallest_visible": [row.to_dict() for row in self.last.smallest_visible],
            "indistinguishable": [group.to_dict() for group in self.last.groups],
            "scored": self.final.recording.scored(self.final.scored),
            "notes": [*self.final.recording.notes, *self.final.notes],
            **self.final.evaluations_dict(),
        }
        if self.noise_floor.value is None:
            made["noise_floor_why"] = self.noise_floor.why
        return made

    def to_frame(self) -> pl.DataFrame:
        """One row per step, after one for the base model."""
        fits = [("(base)", self.base), *((s.finding.effect, s.after) for s in self.steps)]
        rows = [
            {
                "effect": effect,
                "model": fit.model.spec,
                "rmse": fit.rmse,
                "rmse_held_out": fit.rmse_held_out,
            }
            for effect, fit in fits
        ]
        return pl.DataFrame(rows)


@door(FitError, base=MODEL)
@serial_linear_algebra
def improve(
    base: str | Model,
    recording: Recordings,
    *,
    starts: int = 20,
    seed: int = 0,
    least_fall: float = LEAST_FALL,
    most_steps: int = MOST_STEPS,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    sample_rows: int = SAMPLE_ROWS,
    progress: Callable[[str], None] = lambda sentence: None,
    keep_when_stopped: bool = False,
    **choices: Unpack[ChoiceArguments],
) -> Improvement:
    """Diagnose and add until nothing passes the test.

    An effect that a later one makes superfluous is dropped, and those after it are fitted again.

    Parameters
    ----------
    rejected, candidates : collections of str
        Effects never to add, and effects by formula to try (``"creep = c*abs(load)*sgn(v)"``).
    sample_rows : int
        A longer recording is searched for effects on this number of samples, in evenly spaced
        stretches; the model of each step is then identified on all samples.
    progress : callable
        Called with one sentence at each step.
    keep_when_stopped : bool
        Whether Ctrl-C after the first step returns the steps that were made, with
        ``stopped="interrupted"``.
    **choices
        `start`, `bounds` and `fix` of `stribeck.fit`, of parameters of the base model or of effects
        that may be added. They stay in force throughout.

    Examples
    --------
    >>> import stribeck as sb
    >>> from stribeck.motion.generate.hidden import generate
    >>> recording = sb.read(generate(["load"], seconds=60.0, rate=100.0, seed=1)[0])
    >>> found = sb.improve("coulomb", recording, starts=2)
    >>> [step.finding.effect for step in found.steps], found.final.model.spec
    (['load'], 'coulomb+load')
    """
    check_rejected(rejected)
    recording = as_one(recording)
    progress(f"fitting {base if isinstance(base, str) else base.spec}")
    few = excerpt(recording, sample_rows, seed)
    later = parameters_of_effects(candidates=candidates)
    start = Choices.of(choices).applied(model_for(base, few), later)
    first = fit(start, few, starts=starts, seed=seed)
    ways = improvement_paths(
        first,
        seed=seed,
        least_fall=least_fall,
        most_steps=most_steps,
        rejected=rejected,
        candidates=candidates,
        progress=progress,
    )
    path, interrupted = _last_of(ways, keep=keep_when_stopped)
    if interrupted:
        progress("stopped: the steps so far are kept")
    if few is not recording:
        path = _on_all_samples(path, recording, progress)
    return _improvement(path, progress, interrupted=interrupted)


def _last_of(ways: Iterable[ImprovementPath], *, keep: bool) -> tuple[ImprovementPath, bool]:
    """The last path, and whether Ctrl-C ended the search there."""
    known: list[ImprovementPath] = []
    try:
        for path in ways:
            known = [path]
    except KeyboardInterrupt:
        if not known or not keep:
            raise
        return known[-1], True
    return known[-1], False


def _improvement(
    path: ImprovementPath, progress: Callable[[str], None], *, interrupted: bool
) -> Improvement:
    """The result of a path that has ended."""
    if not interrupted and path.current.passive() is False:
        progress("finding what a passive model costs")
    found = path.last
    return Improvement(
        base=path.start,
        steps=_with_final_values(path),
        final=path.current,
        noise_floor=found.noise_floor,
        stopped="interrupted" if interrupted else _stopped(path),
        untestable=found.untestable,
        unexplained=found.unexplained,
        last=found,
        made_passive=None if interrupted else cost_of_passivity(path.current),
    )


def _with_final_values(path: ImprovementPath) -> tuple[ImprovementStep, ...]:
    """The steps, each with a sentence that states the values of the final model.

    A later effect changes them, and a page must not state two values of one parameter.
    """
    return tuple(
        replace(
            step,
            finding=replace(
                step.finding, where=where(step.finding.effect, step.before, path.current)
            ),
        )
        for step in path.steps
    )


def _stopped(path: ImprovementPath) -> str:
    """Why the loop ended."""
    found = path.last
    if found.findings:
        return "max_steps"
    is_more = found.unexplained.is_structure or found.has_doubts
    noise = not is_more and found.noise_floor.is_reached_by(path.current.rmse)
    return "noise_floor" if noise else "nothing_passes"


def _on_all_samples(
    path: ImprovementPath, recording: Recording, progress: Callable[[str], None]
) -> ImprovementPath:
    """The same path with each model identified on all samples of `recording`."""
    progress(f"identifying the models on all {recording.rows} samples")
    transient = rows_left_out(recording)
    rows = path.start.recording.rows
    *earlier, final_model = [path.start, *(step.after for step in path.steps)]
    with on_threads() as pool:
        final = pool.submit(on_all_samples, final_model, recording, transient, FROM_NEARBY)
        # Only the errors of the earlier models are needed.
        fits = list(pool.map(lambda found: on_all_samples(found, recording, transient), earlier))
        fits.append(with_excerpt_note(final.result(), rows))
    remains = with_remainder_on_all_samples(path.last, fits[-1])
    steps = [
        ImprovementStep(
            with_errors_of(step.finding, before, after, remains.noise_floor), before, after
        )
        for step, (before, after) in zip(path.steps, itertools.pairwise(fits), strict=True)
    ]
    return replace(path, start=fits[0], last=remains, steps=tuple(steps))
