"""Effects that explain less than what remains unexplained.

A cause that the catalog lacks can often be imitated in part: a gap in the friction curve by a
Stribeck curve, for example. The rest of its torque then remains as structure. An effect that
explains much more than what remains is not such an imitation; one that explains less may be.
"""

from __future__ import annotations

from collections.abc import Sequence

from stribeck.diagnosis.residual.unexplained import Unexplained
from stribeck.diagnosis.result import Finding
from stribeck.effect.describe import is_friction

#: A friction effect with a smaller part is demoted: it explains less than what remains.
LEAST_PART = 0.5
REASON = (
    "it explains less than what remains unexplained, so it may imitate a cause that no effect of "
    "the catalog has"
)


def part_explained(gain: float | None, remains: Unexplained) -> float:
    """The share that an effect explains of what it and the remaining structure make up, 0..1.

    Parameters
    ----------
    gain
        Rise of the squared held-out error without the effect, as a multiple of that of the model;
        None where it is not known.
    """
    if gain is None or not remains.is_structure or remains.shown <= 0.0:
        return 1.0
    return max(gain, 0.0) / (max(gain, 0.0) + remains.shown)


def imitations(findings: Sequence[Finding]) -> list[str]:
    """The friction effects that explain less than what remains, the smallest part first."""
    doubtful = [f for f in findings if f.part < LEAST_PART and is_friction(f.effect)]
    return [finding.effect for finding in sorted(doubtful, key=lambda finding: finding.part)]
