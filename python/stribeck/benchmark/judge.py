"""Check the result of a case against its truth."""

from __future__ import annotations

from dataclasses import dataclass

from stribeck.benchmark.answer import CaseAnswer, NamedEffect
from stribeck.effect.describe import is_friction
from stribeck.models.catalog import effect_ids

#: Columns of the confusion matrix for results without an effect.
NONE, UNEXPLAINED, FAILED = "none", "unexplained", "failed"


@dataclass(frozen=True)
class Judgement:
    """Whether a result is correct, and why not.

    Attributes
    ----------
    right
        Correct by the rule of the group.
    exact
        Every hidden effect was named and nothing else.
    named
        The first result: an effect, "none" or "unexplained". It is the hidden effect if that was
        reported as indistinguishable from the first one.
    problem
        The error, or an empty string.
    extra
        An effect was named that is not hidden.
    """

    right: bool
    exact: bool
    named: str
    problem: str
    extra: bool = False


def judge(answer: CaseAnswer) -> Judgement:
    """Judge a result of any group except "coverage".

    With nuisances every hidden effect is named, and no friction effect that is not hidden is
    claimed. Causes other than friction may be named: the nuisances are such causes. One without
    nuisances is right by its group:

    one
        The first effect is the hidden one, or one reported as indistinguishable from it. An effect
        that contains a simpler one may come after the simpler one.
    two, three
        All hidden effects are found, and no others.
    none
        No effect is added and the verdict is "none".
    limited
        The effects that the motion cannot show are listed as untestable and not found.
    outside
        No effect is added and the verdict is "unexplained".
    """
    if answer.failure:
        return Judgement(False, False, FAILED, answer.failure)
    missed, wrong = _compare(answer)
    named = _top(answer)
    rule = _with_nuisances if answer.case.nuisances else _PROBLEMS[answer.case.group]
    problems = rule(answer, missed, wrong, named)
    exact = not missed and not wrong
    return Judgement(not problems, exact, named, "; ".join(problems), bool(wrong))


def is_right(step: NamedEffect, answer: CaseAnswer) -> bool:
    """Whether the effect of one step is hidden in the recording, or part of one that is."""
    return step.effect in visible(answer) or step.effect in answer.implied


def visible(answer: CaseAnswer) -> list[str]:
    """Hidden effects of the library that the motion can show."""
    outside = answer.hidden if answer.case.group == "outside" else ()
    return [e for e in answer.hidden if e not in answer.cannot_show and e not in outside]


def _names(step: NamedEffect) -> set[str]:
    return {step.effect, *step.indistinguishable_from}


def _compare(answer: CaseAnswer) -> tuple[list[str], list[str]]:
    """Hidden effects that were not named, and named ones that are not hidden."""
    missed, wrong = visible(answer), []
    spare = [e for e in answer.implied if e not in missed]
    for step in answer.steps:
        for left in (missed, spare):
            match = step.effect if step.effect in left else None
            match = match or next((e for e in left if e in _names(step)), None)
            if match is not None:
                left.remove(match)
                break
        else:
            wrong.append(step.effect)
    return missed, wrong


def _top(answer: CaseAnswer) -> str:
    """The first result, as used in the confusion matrix."""
    if not answer.steps:
        return UNEXPLAINED if answer.verdict == "unexplained" else NONE
    hidden = visible(answer)
    for step in answer.steps:
        if (match := next((e for e in hidden if e in _names(step)), None)) is not None:
            return match
        if step.effect not in answer.implied:
            break
    return answer.steps[0].effect


def _one(answer: CaseAnswer, missed: list[str], wrong: list[str], named: str) -> list[str]:
    hidden = visible(answer)
    return [] if named in hidden else [f"named {named}, hidden {' and '.join(hidden)}"]


def _several(answer: CaseAnswer, missed: list[str], wrong: list[str], named: str) -> list[str]:
    problems = [f"missed {effect}" for effect in missed]
    return problems + [f"{effect} is not hidden" for effect in wrong]


def _none(answer: CaseAnswer, missed: list[str], wrong: list[str], named: str) -> list[str]:
    return [] if named == NONE else [f"named {named}, nothing is hidden"]


def _with_nuisances(
    answer: CaseAnswer, missed: list[str], wrong: list[str], named: str
) -> list[str]:
    problems = [f"missed {effect}" for effect in missed]
    return problems + [f"claimed {effect}, which is not hidden" for effect in false_claims(answer)]


def false_claims(answer: CaseAnswer) -> list[str]:
    """Friction effects that were claimed and are not hidden.

    One that is reported as indistinguishable from a cause other than friction is not claimed.
    """
    _, wrong = _compare(answer)
    return [
        step.effect
        for step in answer.steps
        if step.effect in wrong and all(map(is_friction, _names(step)))
    ]


def _limited(answer: CaseAnswer, missed: list[str], wrong: list[str], named: str) -> list[str]:
    claimed = [s.effect for s in answer.steps if s.effect in answer.cannot_show]
    known = [e for e in answer.cannot_show if e in effect_ids()]
    silent = [e for e in known if e not in answer.untestable]
    problems = [f"claimed {effect}, which this motion cannot show" for effect in claimed]
    return problems + [f"{effect} is not listed as untestable" for effect in silent]


def _outside(answer: CaseAnswer, missed: list[str], wrong: list[str], named: str) -> list[str]:
    return [] if named == UNEXPLAINED else [f"named {named}, hidden is outside the library"]


_PROBLEMS = {
    "one": _one,
    "two": _several,
    "three": _several,
    "none": _none,
    "limited": _limited,
    "outside": _outside,
}
