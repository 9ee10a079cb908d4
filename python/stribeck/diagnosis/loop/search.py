"""The loop: the best effect is added at each step; superfluous ones are dropped or exchanged."""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from stribeck.base.errors import FitError
from stribeck.diagnosis.diagnose import diagnose, with_visibility
from stribeck.diagnosis.least_fall import LEAST_FALL
from stribeck.diagnosis.loop.at_the_end import impossible_at_the_end
from stribeck.diagnosis.loop.form import of_other_form
from stribeck.diagnosis.loop.path import ImprovementPath
from stribeck.diagnosis.loop.provisional import judged, trials_of
from stribeck.diagnosis.loop.superfluous import needed
from stribeck.diagnosis.loop.ties import settled
from stribeck.diagnosis.loop.ways import best_of, other_beginnings, predicts_better
from stribeck.diagnosis.result import Diagnosis, Finding
from stribeck.diagnosis.trials.remainder import REASON, imitations
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
    search = Search(seed, least_fall, most_steps, rejected, candidates, progress)
    return search.paths(ImprovementPath(start, search.diagnosis(start)))


@dataclass(frozen=True)
class Search:
    """A search with its options, which are those of `improve`."""

    seed: int
    least_fall: float
    most_steps: int
    rejected: Collection[str]
    candidates: Collection[str]
    progress: Callable[[str], None]

    def paths(self, path: ImprovementPath) -> Iterator[ImprovementPath]:
        """The path after each change, from one whose last diagnosis is that of its model."""
        path = yield from self._best_way(path)
        trials = trials_of(path.last)
        if trials:
            path = self._beyond(path, trials)
            yield path
        # Imitations once: without them more remains, beside which another effect explains less.
        findings = [step.finding for step in path.steps]
        shorter = self._without(
            path, {**self._doubtful(path), **dict.fromkeys(imitations(findings), REASON)}
        )
        while shorter is not None:
            shorter = self._needed(shorter)
            yield shorter
            path = yield from self._grown(self._asked(shorter))
            # What an imitation has hidden beside it may be two effects that show only together.
            path = self._beyond(path, trials_of(path.last))
            shorter = self._without(path, self._doubtful(path))
        path = settled(path, self.least_fall, self.seed)
        last = path.last if path.last.findings else with_visibility(path.last)
        said = replace(last, demoted=(*path.demoted, *last.demoted))
        yield replace(path, last=said)

    def diagnosis(self, current: Fit, dropped: Collection[str] = ()) -> Diagnosis:
        """What a model lacks; effects that were dropped are not tried again."""
        self.progress(f"searching for effects that {current.model.spec} lacks{_error_of(current)}")
        return diagnose(
            current,
            least_fall=self.least_fall,
            rejected={*self.rejected, *dropped},
            candidates=self.candidates,
            seed=self.seed,
            sample_rows=current.recording.rows,
            brief=True,
            progress=self.progress,
        )

    def _asked(self, path: ImprovementPath) -> ImprovementPath:
        """The path with the diagnosis of its model."""
        return replace(path, last=self.diagnosis(path.current, [s.effect for s in path.dropped]))

    def _grown(self, path: ImprovementPath) -> Generator[ImprovementPath, None, ImprovementPath]:
        """Add, drop and exchange until nothing changes; yields the path after each change."""
        while True:
            ends = not path.last.findings or len(path.steps) >= self.most_steps
            if not ends:
                path = path.with_best()
                added = path.steps[-1].finding.effect
                self.progress(f"adding {added}{_error_of(path.current)}")
                yield path
            findings = [step.finding for step in path.steps]
            # What the path begins with on trial, without a weight, is judged at its end.
            proven = [finding for finding in findings[:-1] if finding.weight > 0.0]
            shorter, path = self._shortened(path, findings if ends else proven)
            if shorter is None and ends:
                shorter, path = self._exchanged(path)
                if shorter is None:
                    return path
            if shorter is not None:
                path = shorter
                yield path
            path = self._asked(path)

    def _best_way(
        self, start: ImprovementPath
    ) -> Generator[ImprovementPath, None, ImprovementPath]:
        """Like `_grown`, from several beginnings where the first effect is in doubt."""
        path = yield from self._grown(start)
        ways = [path]
        others = other_beginnings(start.last, path, self.seed) if self.most_steps > 0 else ()
        for finding in others:
            self.progress(f"trying {finding.effect} first")
            *_, end = self._ends(start.with_found(finding))
            ways.append(end)
        best = best_of(ways, self.least_fall, self.seed)
        if best is not path:
            yield best
        return best

    def _shortened(
        self, path: ImprovementPath, findings: Sequence[Finding]
    ) -> tuple[ImprovementPath | None, ImprovementPath]:
        """The path without one of some findings, or None where all stay; and the path as it is.

        Each of these findings then has the certainty that the last model needs it.
        """
        found = needed(findings, path.current, self.least_fall, self.seed)
        path = path.with_needed(found)
        if found.idle is None:
            return None, path
        self.progress(f"{found.idle} is superfluous: refitting the later effects without it")
        try:
            return path.without(found.idle, self.seed), path
        except FitError as error:
            # For example a bristle whose dry friction is positive only with this effect.
            self.progress(f"{found.idle} stays: {error}")
            return None, path

    def _needed(self, path: ImprovementPath) -> ImprovementPath:
        """The path without what is superfluous."""
        while True:
            shorter, path = self._shortened(path, [step.finding for step in path.steps])
            if shorter is None:
                return path
            path = shorter

    def _exchanged(self, path: ImprovementPath) -> tuple[ImprovementPath | None, ImprovementPath]:
        """The path with one effect exchanged, or None; and the path with its ties."""
        if len(path.steps) + len(path.last.not_claimed) < 2:
            return None, path
        self.progress("trying other effects in the place of each of those found")
        found = path.exchanges(self.rejected, self.least_fall, self.seed)
        path = path.with_ties(found.ties)
        if found.best is None:
            return None, path
        self.progress(f"{found.best.by.effect} takes the place of {found.best.finding.effect}")
        try:
            return path.exchanged(found.best, self.seed), path
        except FitError as error:
            self.progress(f"{found.best.finding.effect} stays: {error}")
            return None, path

    def _beyond(self, path: ImprovementPath, trials: Sequence[Finding]) -> ImprovementPath:
        """The path grown beyond the first finding on trial that stands; as it is without one."""
        for finding in trials:
            grown = self._tried(path, finding)
            if grown is not path:
                return grown
        return path

    def _tried(
        self, path: ImprovementPath, finding: Finding, *, beside_another: bool = False
    ) -> ImprovementPath:
        """The path grown beyond a finding on trial, or as it is where that does not stand then.

        It may displace an effect that was found before where the whole model predicts better, and
        give way itself to what was found beside it. Where two effects predict only together even
        then, one of them is tried `beside_another`, once.
        """
        self.progress(f"adding {finding.effect} on trial{_error_of(finding.fit)}")
        *_, grown = self._ends(path.with_finding(finding))
        if grown.last.pair is not None and not beside_another:
            grown = self._tried(grown, grown.last.pair.first, beside_another=True)
        found = [step.finding.effect for step in path.steps]
        kept = grown.holding(finding.effect)
        if kept is None and self._stands(grown) and predicts_better(grown.current, path.current):
            return grown
        stands = None
        holds_all = all(map(grown.holding, found))
        if kept is not None and (holds_all or predicts_better(grown.current, path.current)):
            stands = judged(kept, grown.current, self.least_fall, self.seed)
        if stands is None:
            self.progress(f"{finding.effect} does not stand beside the others: going back")
            return path
        return grown.with_instead(stands)

    def _stands(self, path: ImprovementPath) -> bool:
        """Whether each effect of a path passes all tests beside the others."""
        each = (judged(s.finding, path.current, self.least_fall, self.seed) for s in path.steps)
        return bool(path.steps) and all(finding is not None for finding in each)

    def _ends(self, path: ImprovementPath) -> Iterator[ImprovementPath]:
        """The path after each change of its growth, and at the end."""
        path = yield from self._grown(self._asked(path))
        yield path

    def _doubtful(self, path: ImprovementPath) -> dict[str, str]:
        """The effects of a path that the last model shows to be something else, and why."""
        findings = [step.finding for step in path.steps]
        return {
            **of_other_form(findings, path.current, path.last.unexplained, self.seed),
            **impossible_at_the_end(findings, path.current),
        }

    def _without(
        self, path: ImprovementPath, doubtful: Mapping[str, str]
    ) -> ImprovementPath | None:
        """The path without effects that may be another cause, and why; None where none leaves."""
        shorter = None
        for effect, reason in doubtful.items():
            self.progress(f"{effect} is doubtful: {reason}")
            try:
                path = shorter = path.demoting(effect, reason, self.seed)
            except FitError as error:
                self.progress(f"{effect} stays: {error}")
        return shorter


def _error_of(fitted: Fit) -> str:
    """The held-out error of a model, for a sentence of progress."""
    error = fitted.rmse_held_out
    return "" if error is None else f" (held-out error {number(error)} {fitted.model.torque_unit})"
