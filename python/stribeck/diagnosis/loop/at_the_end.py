"""Findings that the values of the last model make impossible.

An effect is judged when it is added. Beside later effects its size may end at a bound, or it may
act within what the recording resolves: then it imitates another cause. A size of zero is none of
these: an effect of several parts, such as one of the load, may need only the others.
"""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.unresolved import unresolved
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.trial import bound_reason, size_of
from stribeck.fitting.result import Fit


def impossible_at_the_end(findings: Sequence[Finding], current: Fit) -> dict[str, str]:
    """The effects of the model `current` that it makes impossible, and why."""
    reasons = ((finding.effect, _reason(finding, current)) for finding in findings)
    return {effect: reason for effect, reason in reasons if reason is not None}


def _reason(finding: Finding, current: Fit) -> str | None:
    size = size_of(finding.effect, current)
    if size is not None and size.at_bound and size.value != 0.0:
        return bound_reason(size)
    return unresolved(Claim(finding.effect, finding.before, current))
