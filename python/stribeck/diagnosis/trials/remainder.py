"""Effects that explain less than what remains unexplained.

A cause that the catalog lacks can often be imitated in part: a gap in the friction curve by a
Stribeck curve, for example. The rest of its torque then remains as structure. An effect that
explains much more than what remains is not such an imitation; one that explains less may be.
What causes in the measurement leave behind is structure too, but imitated by no friction that
stands beside them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from stribeck.base import linear
from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.result import Finding
from stribeck.diagnosis.trials.evidence import held_out_square
from stribeck.diagnosis.trials.imitations import NARROW, explained_by_causes
from stribeck.diagnosis.trials.trial import Trial
from stribeck.effect.describe import is_drive_train, is_friction
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms

#: The highest confidence of an effect that explains less than the structure which remains, whether
#: or not a cause of that can be shown: the data are not understood.
BESIDE_STRUCTURE = NARROW
#: A friction effect with a smaller part is demoted: it explains less than what remains.
LEAST_PART = 0.5
#: Another effect with a smaller part: it explains less than half of what remains.
LEAST_PART_OF_OTHERS = 1 / 3
REASON = (
    "it explains less than what remains unexplained, so it may imitate a cause that no effect of "
    "the catalog has"
)


def unknown_structure(current: Fit, remains: Unexplained) -> float:
    """The share of a model's squared held-out error that an unknown cause leaves, 0..1.

    That is the structure which the recorded channels or varying friction show, less what causes in
    the measurement explain of the error.
    """
    if not remains.is_structure or remains.shown <= 0.0:
        return 0.0
    return max(remains.shown - max(explained_by_causes(current), 0.0), 0.0)


def part_explained(
    gain: float | None, unknown: float, remains: Unexplained, *, drive_train: bool = False
) -> float:
    """The share that an effect explains of what it and the unknown structure make up, 0..1.

    At most `BESIDE_STRUCTURE` where more structure remains than it explains.

    Parameters
    ----------
    gain
        Rise of the squared held-out error without the effect, as a multiple of that of the model;
        None where it is not known.
    unknown
        `unknown_structure`, of the same error.
    drive_train
        Whether the effect is one of the drive train, which does not imitate shocks but has them.
    """
    if gain is None:
        return 1.0
    gain = max(gain, 0.0)
    if drive_train:
        unknown = max(unknown - remains.shocks, 0.0)
    part = gain / (gain + unknown) if unknown > 0.0 else 1.0
    is_smaller = remains.is_structure and gain < (remains.share or 0.0)
    return min(part, BESIDE_STRUCTURE) if is_smaller else part


def limited(
    findings: Sequence[Finding], passed: Sequence[Trial], remains: Unexplained
) -> tuple[Finding, ...]:
    """Findings of one step with the part that each explains, beside an unknown structure.

    What remains beside the first may be another effect of the catalog: as much of it as the torques
    of others that pass the test explain is not unknown.

    Parameters
    ----------
    passed
        All trials that pass the test of evidence.
    remains
        What remains beside the first finding.
    """
    if not findings:
        return ()
    first, before = findings[0], findings[0].before
    level, square = held_out_square(before, before), held_out_square(first.fit, before)
    if not square > 0.0:
        return tuple(findings)
    known = _explained_by([t.fit for t in passed if t.effect != first.effect], first.fit, before)
    unknown = max(unknown_structure(first.fit, remains) - known, 0.0)
    # Without an unknown structure another effect explains what remains.
    left = remains if unknown > 0.0 else replace(remains, share=0.0)

    def part(finding: Finding) -> float:
        gain = (level - held_out_square(finding.fit, before)) / square
        return part_explained(gain, unknown, left, drive_train=is_drive_train(finding.effect))

    return tuple(replace(finding, part=part(finding)) for finding in findings)


def _explained_by(others: Sequence[Fit], first: Fit, before: Fit) -> float:
    """The share of the squared error of `first` that the torques of other effects explain, 0..1."""
    if not others:
        return 0.0
    rows = before.rows
    left = before.weighted(first.held_out_residual[rows])
    columns = np.column_stack(
        [before.weighted((other.prediction - before.prediction)[rows]) for other in others]
    )
    after = left - columns @ linear.least_norm(columns, left, 1e-8)
    return 1.0 - rms(after) ** 2 / rms(left) ** 2


def imitations(findings: Sequence[Finding]) -> list[str]:
    """The effects that explain too little beside what remains, the smallest part first."""
    doubtful = [finding for finding in findings if finding.part < _least_part(finding.effect)]
    return [finding.effect for finding in sorted(doubtful, key=lambda finding: finding.part)]


def _least_part(effect: str) -> float:
    return LEAST_PART if is_friction(effect) else LEAST_PART_OF_OTHERS
