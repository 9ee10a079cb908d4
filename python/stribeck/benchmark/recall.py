"""How many of the effects that the generator's own model detects the diagnosis names surely."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from stribeck.benchmark.answer import CaseAnswer
from stribeck.benchmark.share import Share

#: Standard errors at which the generator's own model detects an effect.
DETECTABLE = 5.0
#: Confidence above which a finding counts.
CONFIDENT = 0.9
#: Effects that a tie may name.
MOST_NAMES = 3
#: Smallest share of the detectable effects that must be named.
RECALL_BAR = 0.85
#: Groups with hidden effects of the library.
HIDDEN = {"one": "one effect", "two": "two effects", "three": "three effects"}


@dataclass(frozen=True)
class Recall:
    """Hidden effects of at least `DETECTABLE` standard errors, and those named.

    Attributes
    ----------
    named
        Named with a confidence above `CONFIDENT`, or one of at most `MOST_NAMES` effects between
        which the recording does not decide.
    ties
        Number of the latter.
    found
        Named with any confidence, or reported as indistinguishable from what is named.
    too_small
        Number of hidden effects of fewer standard errors.
    """

    title: str
    named: Share
    ties: int
    found: Share
    too_small: int

    @property
    def passed(self) -> bool:
        """Whether the share of effects named reaches the bar."""
        return self.named.value >= RECALL_BAR

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "of": self.title,
            "standard_errors": DETECTABLE,
            "confidence": CONFIDENT,
            **self.named.to_dict(),
            "of_them_ties": self.ties,
            "with_any_confidence": self.found.count,
            "too_small": self.too_small,
            "bar": RECALL_BAR,
            "passed": self.passed,
        }


def recalls(answers: Sequence[CaseAnswer]) -> Iterator[Recall]:
    """One row for each number of hidden effects, without and with nuisances."""
    for group, hidden in (
        ("one", "one effect"),
        ("two", "two effects"),
        ("three", "three effects"),
    ):
        for nuisances in (False, True):
            of = [a for a in answers if a.case.group == group]
            of = [a for a in of if bool(a.case.nuisances) == nuisances and not a.failure]
            if any(a.detectable for a in of):
                title = f"{hidden}, {'with' if nuisances else 'no'} nuisances"
                yield _recall(title, of)


def _recall(title: str, answers: Sequence[CaseAnswer]) -> Recall:
    named = ties = found = detectable = effects = 0
    for a in answers:
        apart = a.apart or (None,) * len(a.detectable)
        for effect, z, told in zip(a.hidden, a.detectable, apart, strict=False):
            effects += 1
            if z < DETECTABLE:
                continue
            detectable += 1
            sure = any(s.effect == effect and s.confidence > CONFIDENT for s in a.steps)
            tie = not sure and told is not None and told < DETECTABLE and _is_tie(a, effect)
            named += sure or tie
            ties += tie
            found += any(effect in (s.effect, *s.indistinguishable_from) for s in a.steps)
    share = Share(named, detectable)
    return Recall(title, share, ties, Share(found, detectable), effects - detectable)


def _is_tie(answer: CaseAnswer, effect: str) -> bool:
    """Whether an effect is one of at most `MOST_NAMES` that a step names together."""
    every = [{s.effect, *s.indistinguishable_from} for s in answer.steps]
    return any(effect in names and len(names) <= MOST_NAMES for names in every)
