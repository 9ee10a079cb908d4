"""Rule: what is said to change during a recording changes."""

from __future__ import annotations

from stribeck.base.errors import StribeckError
from stribeck.diagnosis.extend import extended_models
from stribeck.diagnosis.plausibility.claim import Claim
from stribeck.diagnosis.plausibility.shape import share_kept
from stribeck.effect.registry import find
from stribeck.fitting.fit import fit
from stribeck.fitting.result import Fit
from stribeck.identify.search.effort import QUICK

#: Share of its gain that an effect must not keep where nothing changes with time.
MOST = 0.9


def steady(claim: Claim) -> str | None:
    """Which effects explain as much without a change; None where they explain less."""
    row = find(claim.effect)
    missing = [] if row is None else [e for e in row.steady if not claim.before.model.has(e)]
    plain = _with(claim.before, missing) if missing else None
    if plain is None or share_kept(claim.before, claim.after, plain) < MOST:
        return None
    return f"{' and '.join(missing)} that do not change with time explain as much"


def _with(before: Fit, effects: list[str]) -> Fit | None:
    """The model with some effects, refitted; None where that cannot be fitted."""
    model = before.model
    try:
        for effect in effects:
            models = extended_models(model, effect, before.recording, before.load, before.residual)
            model = models[-1]
        return fit(model, before.recording, starts=1, transient=before.transient, effort=QUICK)
    except StribeckError:
        return None
