"""The loop: the best effect is added at each step; superfluous ones are dropped or exchanged."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace

from stribeck.base.errors import FitError
from stribeck.diagnosis.diagnose import LEAST_FALL, diagnose
from stribeck.diagnosis.loop.path import ImprovementPath
from stribeck.diagnosis.loop.provisional import judged, on_trial
from stribeck.diagnosis.loop.remainder import REASON, imitations
from stribeck.diagnosis.loop.superfluous import needed
from stribeck.diagnosis.result import Finding
from stribeck.effect.base import number
from stribeck.fitting.result import Fit

MOST_STEPS = 8


def improvement_paths(
    start: Fit,
    *,
    seed: int = 0,
    least_fall: float = LEAST_FALL,
    most_steps: int = MOST_STEPS,
    rejected: Collection[str] = (),
    candidates: Collection[str] = (),
    progress: Callable[[str], None] = lambda sentence: None,
) -> Iterator[ImprovementPath]:
    """The path of the loop after each effect that is added or dropped.

    The loop ends where nothing passes the test, or after `most_steps`. The last diagnosis of the
    last path is that of its current model. Parameters as in `improve`.
    """
    path: ImprovementPath | None = None
    before: ImprovementPath | None = None
    doubtful: str | None = None
    while True:
        current = start if path is None else path.current
        gone = () if path is None else path.dropped
        progress(f"searching for effects that {current.model.spec} lacks{_error_of(current)}")
        found = diagnose(
            current,
            least_fall=least_fall,
            rejected={*rejected, *(s.effect for s in gone)},
            candidates=candidates,
            seed=seed,
            sample_rows=start.recording.rows,
            brief=True,
            progress=progress,
        )
        path = ImprovementPath(start, found) if path is None else replace(path, last=found)
        ends = not found.findings or len(path.steps) >= most_steps
        if not ends:
            path = path.with_best()
            progress(f"adding {found.findings[0].effect}{_error_of(path.current)}")
            if before is None:
                yield path
        findings = [step.finding for step in path.steps]
        shorter, path = _shortened(
            path, findings if ends else findings[:-1], least_fall, seed, progress
        )
        if shorter is None and ends:
            shorter, path = _exchanged(path, rejected, least_fall, seed, progress)
        if shorter is None and ends and doubtful is None:
            tried = on_trial(found)
            if tried is not None:
                progress(f"adding {tried.effect} on trial{_error_of(tried.fit)}")
                before, doubtful, shorter = path, tried.effect, path.with_finding(tried)
        elif shorter is None and ends and before is not None:
            path = _decided(before, path, doubtful, least_fall, seed, progress)
            before = None
        if shorter is None and ends:
            shorter = _without_imitations(path, seed, progress)
            if shorter is None:
                said = replace(path.last, demoted=(*path.demoted, *path.last.demoted))
                yield replace(path, last=said)
                return
        if shorter is not None:
            path = shorter
            if before is None:
                yield path


def _decided(
    before: ImprovementPath,
    path: ImprovementPath,
    doubtful: str,
    least: float,
    seed: int,
    progress: Callable[[str], None],
) -> ImprovementPath:
    """The path with the effect that was added on trial, or the one before it."""
    finding = path.holding(doubtful)
    if finding is None:
        return path
    finding = judged(finding, path.current, least, seed)
    if finding is None:
        progress(f"{doubtful} does not stand beside the others: going back")
        return before
    return path.with_instead(finding)


def _error_of(fitted: Fit) -> str:
    """The held-out error of a model, for a sentence of progress."""
    error = fitted.rmse_held_out
    return "" if error is None else f" (held-out error {number(error)} {fitted.model.torque_unit})"


def _shortened(
    path: ImprovementPath,
    findings: Sequence[Finding],
    least_fall: float,
    seed: int,
    progress: Callable[[str], None],
) -> tuple[ImprovementPath | None, ImprovementPath]:
    """The path without one of some findings, or None where all stay; and the path as it is.

    Each of these findings then has the certainty that the last model needs it.
    """
    found = needed(findings, path.current, least_fall, seed)
    path = path.with_needed(found)
    if found.idle is None:
        return None, path
    progress(f"{found.idle} is superfluous: refitting the later effects without it")
    try:
        return path.without(found.idle, seed), path
    except FitError as error:
        # For example a bristle whose dry friction is positive only with this effect.
        progress(f"{found.idle} stays: {error}")
        return None, path


def _exchanged(
    path: ImprovementPath,
    rejected: Collection[str],
    least: float,
    seed: int,
    progress: Callable[[str], None],
) -> tuple[ImprovementPath | None, ImprovementPath]:
    """The path with one effect exchanged, or None; and the path with its ties."""
    if len(path.steps) + len(path.last.not_claimed) < 2:
        return None, path
    progress("trying other effects in the place of each of those found")
    found = path.exchanges(rejected, least, seed)
    path = path.with_ties(found.ties)
    if found.best is None:
        return None, path
    progress(f"{found.best.by.effect} takes the place of {found.best.finding.effect}")
    try:
        return path.exchanged(found.best, seed), path
    except FitError as error:
        progress(f"{found.best.finding.effect} stays: {error}")
        return None, path


def _without_imitations(
    path: ImprovementPath, seed: int, progress: Callable[[str], None]
) -> ImprovementPath | None:
    """The path without effects that may imitate another cause, or None where there are none.

    Once: without them more remains, beside which another effect would explain less.
    """
    shorter = None
    for effect in [] if path.demoted else imitations([step.finding for step in path.steps]):
        progress(f"{effect} is doubtful: {REASON}")
        try:
            path = shorter = path.demoting(effect, REASON, seed)
        except FitError as error:
            progress(f"{effect} stays: {error}")
    return shorter
