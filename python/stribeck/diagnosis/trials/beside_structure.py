"""Friction and another kind of cause that explain nearly the same, where structure remains.

The standard error of a difference counts noise alone. What further causes leave tilts it as well:
where structure remains, a difference that is small beside it decides nothing.
"""

from __future__ import annotations

from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.trials.evidence import held_out_square
from stribeck.effect.describe import is_friction
from stribeck.fitting.result import Fit

#: Least share of what the better effect explains that a tie explains too.
ALIKE = 0.9
#: Largest difference of the two, as a share of the structure that remains.
SMALL = 0.05


def is_undecided(effects: tuple[str, str], fits: tuple[Fit, Fit], before: Fit, left: float) -> bool:
    """Whether the structure that remains may decide between two effects of different kinds.

    Parameters
    ----------
    effects, fits
        The better effect and the other, and the model with each.
    before
        The model without them.
    left
        Structure as a share of the squared held-out error of the better model, 0..1.
    """
    if not left > 0.0 or is_friction(effects[0]) == is_friction(effects[1]):
        return False
    best, other, level = (held_out_square(fit, before) for fit in (*fits, before))
    return level - other >= ALIKE * (level - best) and other - best <= SMALL * left * best


def structure_share(fit: Fit, floor: NoiseFloor) -> float:
    """Share of the squared held-out error of a fit above the noise floor, 0..1; 0 without one."""
    if floor.value is None or floor.is_reached_by(fit.rmse):
        return 0.0
    square = held_out_square(fit, fit) / fit.rows.size
    return max(1.0 - floor.value**2 / square, 0.0) if square > 0.0 else 0.0
