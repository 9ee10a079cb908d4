"""An effect in plain sentences."""

from __future__ import annotations

from stribeck.effect.base import Identified, number
from stribeck.effect.registry import find, of_catalog
from stribeck.models.catalog import catalog, effect_row, simpler_effect
from stribeck.models.model import Model

#: Groups of the catalog whose cause is not friction.
NOT_FRICTION = ("measurement", "actuator", "rigid body", "drive")


def where(effect: str, before: Identified, after: Identified) -> str:
    """One sentence that says where `effect` shows, from the fitted values and the data.

    For a cause other than friction, the sentence says so first.

    Parameters
    ----------
    before, after
        The model without and with the effect.
    """
    own = after.model.formula(effect)
    if own is not None:
        found = (f"{n} = {number(after.model.value(n))}" for n in own.names)
        return f"{own.text} fits with {', '.join(found)}"
    sentence = of_catalog(effect).where(before, after) + _held(effect, before.model, after.model)
    return sentence if is_friction(effect) else f"this is not friction: {sentence}"


def _held(effect: str, before: Model, after: Model) -> str:
    """Which parameters of an effect are held, though nobody asked for it."""
    row = effect_row(effect)
    names = [] if row is None else [parameter["name"] for parameter in row["parameters"]]
    new = [name for name in names if name in after.limits and name not in before.limits]
    held = [name for name in new if after.limits[name][0] == after.limits[name][1]]
    said = " and ".join(f"{name} at {number(after.value(name))}" for name in held)
    return f". This data does not determine the shape: it is held, {said}" if held else ""


def is_friction(effect: str) -> bool:
    """Whether the cause is friction; an effect by formula is assumed to be."""
    row = effect_row(effect)
    return row is None or row["group"] not in NOT_FRICTION


def is_drive_train(effect: str) -> bool:
    """Whether the effect describes a drive train by what it does to the load torque."""
    known = find(effect)
    return known is not None and known.in_motion == "drive train"


def acts_in_shocks(effect: str) -> bool:
    """Whether the effect acts in shocks, which are faster than the motion and few samples long."""
    known = find(effect)
    return known is not None and known.in_shocks


def base_of(effect: str) -> tuple[str, ...]:
    """The effect beside which another one shows: the simpler one that it contains or acts on.

    Examples
    --------
    >>> base_of("frictional_lag"), base_of("load")
    (('stribeck',), ())
    """
    base = simpler_effect(effect) or of_catalog(effect).shown_beside
    return () if base is None else (base,)


def physically(effect: str, model: Model) -> str:
    """What the effect of a model is, in one sentence: the catalog's, or its formula."""
    own = model.formula(effect)
    return str(catalog()["effects"][effect]["what"]) if own is None else f"{effect} = {own.text}."
