"""How often the program is right about arms."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from stribeck.base.pool import ProcessPool, run_each, worker_count
from stribeck.benchmark.arms.answer import ArmAnswer, arm_answer
from stribeck.benchmark.arms.cases import ArmCase
from stribeck.benchmark.share import Share

#: Smallest shares of right answers, and smallest and largest of intervals with the truth.
BARS = {"effect": 0.90, "rigid": 0.90, "joints": 0.97}
COVERAGE = (0.90, 0.98)


@dataclass(frozen=True)
class ArmLine:
    """A share, and the limits within which it is right."""

    title: str
    share: Share
    low: float
    high: float = 1.0

    @property
    def passed(self) -> bool:
        """Whether the share lies within its limits."""
        return self.low <= self.share.value <= self.high

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {"counted": self.title, **self.share.to_dict(), "passed": self.passed}


@dataclass(frozen=True)
class ArmScore:
    """All figures of a run.

    Attributes
    ----------
    lines
        The shares with limits.
    kinds
        Right answers for each thing that is hidden.
    """

    lines: tuple[ArmLine, ...]
    kinds: tuple[tuple[str, Share], ...]
    wrong: tuple[ArmAnswer, ...]
    arms: int

    @property
    def passed(self) -> bool:
        """Whether every share lies within its limits."""
        return all(line.passed for line in self.lines)

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "arms": self.arms,
            "passed": self.passed,
            "lines": [line.to_dict() for line in self.lines],
            "kinds": [{"hidden": name, **share.to_dict()} for name, share in self.kinds],
            "wrong": [answer.to_dict() for answer in self.wrong],
        }


def arm_score(answers: Sequence[ArmAnswer]) -> ArmScore:
    """Count the right answers."""
    judged = [answer for answer in answers if not _is_coverage(answer)]
    lines = []
    for group, title in (
        ("effect", "right joint and effect first, at 5 x the noise"),
        ("rigid", "right cause in the rigid bodies first"),
    ):
        of = [answer.right for answer in judged if answer.case.group == group]
        if of:
            lines.append(ArmLine(title, Share(sum(of), len(of)), BARS[group]))
    if judged:
        without = [answer.joints_without for answer in judged]
        quiet = Share(sum(a for a, _ in without), sum(b for _, b in without))
        lines.append(ArmLine("no effect claimed on a joint without one", quiet, BARS["joints"]))
    lines += _intervals(answers)
    hidden = dict.fromkeys(answer.case.hidden or "nothing" for answer in judged)
    kinds = []
    for name in hidden:
        of = [answer.right for answer in judged if (answer.case.hidden or "nothing") == name]
        kinds.append((name, Share(sum(of), len(of))))
    wrong = tuple(answer for answer in answers if not _is_good(answer))
    return ArmScore(tuple(lines), tuple(kinds), wrong, len(answers))


def _is_coverage(answer: ArmAnswer) -> bool:
    return answer.case.group == "coverage"


def _is_good(answer: ArmAnswer) -> bool:
    without, every = answer.joints_without
    if _is_coverage(answer):
        return not answer.failure
    return answer.right and without == every


def _intervals(answers: Iterable[ArmAnswer]) -> list[ArmLine]:
    found = [answer.intervals for answer in answers if answer.intervals is not None]
    if not found:
        return []

    def line(title: str, pairs: Sequence[tuple[int, int]]) -> ArmLine:
        share = Share(sum(a for a, _ in pairs), sum(b for _, b in pairs))
        return ArmLine(title, share, *COVERAGE)

    every = [(a + c, b + d) for (a, b), (c, d) in ((one.base, one.friction) for one in found)]
    possible = Share(sum(one.possible for one in found), len(found))
    return [
        line("95 % intervals that hold the truth", every),
        line("  of base parameters", [one.base for one in found]),
        line("  of friction parameters", [one.friction for one in found]),
        ArmLine(
            "  of the payload's mass",
            Share(sum(one.payload for one in found), len(found)),
            COVERAGE[0],
        ),
        ArmLine("every link a possible body", possible, 1.0),
    ]


def run_arms(
    cases: Sequence[ArmCase],
    *,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> tuple[list[ArmAnswer], ArmScore]:
    """Simulate and diagnose all arms in worker processes, and score the answers.

    Raises
    ------
    Stopped
        On Ctrl-C.
    """
    made: dict[str, ArmAnswer] = {}

    def finished(answer: ArmAnswer) -> None:
        made[answer.case.name] = answer
        progress(len(made), len(cases))

    count = min(worker_count(workers), max(len(cases), 1))
    if count == 1:
        run_each(arm_answer, cases, finished, None)
    else:
        with ProcessPool(count) as pool:
            run_each(arm_answer, cases, finished, pool, what="the benchmark")
    answers = [made[case.name] for case in cases]
    return answers, arm_score(answers)
