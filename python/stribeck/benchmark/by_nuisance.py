"""What each nuisance does to the diagnosis."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from stribeck.benchmark.answer import CaseAnswer
from stribeck.benchmark.distortion import EVERY
from stribeck.benchmark.judge import false_claims, judge
from stribeck.benchmark.share import Share


@dataclass(frozen=True)
class OfNuisance:
    """The recordings with one nuisance, alone or among others.

    Attributes
    ----------
    controls
        Recordings without a hidden effect in which no friction was claimed.
    effects
        Recordings with hidden effects in which all were found, and no other friction claimed.
    claimed
        Friction effects that were claimed and not hidden, the most frequent first.
    """

    nuisance: str
    controls: Share
    effects: Share
    claimed: tuple[tuple[str, int], ...]

    def to_dict(self) -> dict[str, object]:
        """As JSON."""
        return {
            "nuisance": self.nuisance,
            "controls": self.controls.to_dict(),
            "effects": self.effects.to_dict(),
            "falsely_claimed": dict(self.claimed),
        }


def by_nuisance(answers: Sequence[CaseAnswer]) -> Iterator[OfNuisance]:
    """One row for each nuisance that is in a recording."""
    for name in EVERY:
        of = [a for a in answers if name in a.case.nuisances]
        if not of:
            continue
        claimed = Counter(effect for a in of for effect in false_claims(a))
        controls = _right([a for a in of if a.case.group == "none"])
        effects = _right([a for a in of if a.case.group != "none"])
        yield OfNuisance(name, controls, effects, tuple(claimed.most_common()))


def _right(answers: Sequence[CaseAnswer]) -> Share:
    return Share(sum(judge(a).right for a in answers), len(answers))
