"""Whether a recording determines how large an effect is."""

from __future__ import annotations

from stribeck.fitting.result import Fit
from stribeck.identify.errors.estimates import poorly_determined
from stribeck.models.catalog import effect_row
from stribeck.models.model import Model


def has_known_size(effect: str, fit: Fit) -> bool:
    """Whether at least one amplitude of an effect is determined; False where none is.

    Amplitudes are the parameters in which the torque is linear; all parameters, where it is in
    none. Of an effect with several, such as both parts of a ripple, one may be zero.
    """
    # A model has only those that act on the terms it has: the temperature of dry friction changes a
    # Stribeck height where there is one.
    names = [name for name in _own_names(effect, fit.model) if name in fit.estimates]
    linear = {p.name for p in fit.model.parameters if p.linear}
    amplitudes = [name for name in names if name in linear] or names
    poor = set(poorly_determined(fit.estimates.values()))
    known = (fit.estimates[name] for name in amplitudes if name not in poor)
    return any(estimate.identifiable for estimate in known)


def _own_names(effect: str, model: Model) -> list[str]:
    """Names of the parameters that an effect may bring to a model."""
    own, row = model.formula(effect), effect_row(effect)
    if own is not None:
        return list(own.names)
    return [] if row is None else [parameter["name"] for parameter in row["parameters"]]
