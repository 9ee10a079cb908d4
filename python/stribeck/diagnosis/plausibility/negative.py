"""Rules: friction, its dry part, friction under load and inertia are not negative."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stribeck.base import linear
from stribeck.base.errors import StribeckError
from stribeck.diagnosis.plausibility.claim import Array, Claim, term_torque
from stribeck.effect.base import number
from stribeck.fitting.result import Fit
from stribeck.identify.figures import rms
from stribeck.models.model import Model
from stribeck.models.parts import friction_parts

#: Standard errors by which a value must be negative.
BEYOND = 1.96
#: What must not be negative.
DRY, WHOLE = "dry friction", "friction"
#: Share of the samples in which friction may be negative, and its size there as a share of the
#: largest: the shape of an effect by a few waves or powers is not exact.
SHARE = 0.01
SIZE = {DRY: 0.05, WHOLE: 0.02}
#: Part of the friction under load, as RMS, that may be negative in one quadrant.
DRIVING = 0.1
#: Samples on which friction is looked at.
ROWS = 2000


def negative_friction(claim: Claim) -> str | None:
    """Why the model's friction, or its dry part, is negative; None where none is, or may not be."""
    unit = claim.after.model.load_unit
    for what in (DRY, WHOLE):
        if (least := _least(claim.after, what)) is not None:
            return f"{what} would be negative, down to {number(least)} {unit}"
    return None


def _least(fit: Fit, what: str) -> float | None:
    """The least friction along the motion, if it is negative beyond its standard error."""
    if fit.model.by_formula:
        return None
    rows = fit.rows[:: -(-fit.rows.size // ROWS)]
    try:
        friction = _along(fit, fit.model, rows, what)
    except StribeckError:
        return None
    least = float(np.quantile(friction, SHARE))
    if least >= -SIZE[what] * float(np.quantile(np.abs(friction), 1.0 - SHARE)):
        return None
    reach = BEYOND * _error(fit, rows, friction, what)
    return None if float(np.quantile(friction + reach, SHARE)) >= 0.0 else least


def _along(fit: Fit, model: Model, rows: NDArray[np.intp], what: str) -> Array:
    """Friction of some samples against the motion, or its dry part, array [m]."""
    parts = friction_parts(model, fit.recording, fit.load_torque, rows)
    if what == DRY:
        return parts["dry"]
    return parts["dry"] + np.sign(fit.recording.velocity[rows]) * parts["rate"]


def _error(fit: Fit, rows: NDArray[np.intp], friction: Array, what: str) -> Array:
    """Standard error of such friction, array [m]; zero where the fit has no covariance."""
    if fit.covariance is None:
        return np.zeros_like(friction)
    covariance = fit.covariance.values
    columns = []
    for k, name in enumerate(fit.covariance.names):
        step = 1e-3 * float(np.sqrt(max(covariance[k, k], 0.0)))
        values = fit.model.values.copy()
        values[fit.model.names.index(name)] += step
        if step > 0.0:
            moved = _along(fit, fit.model.with_values(values), rows, what)
            columns.append((moved - friction) / step)
        else:
            columns.append(np.zeros_like(friction))
    slope = np.column_stack(columns) if columns else np.zeros((friction.size, 0))
    return np.sqrt(np.maximum(np.sum((slope @ covariance) * slope, axis=1), 0.0))


def negative_under_load(claim: Claim) -> str | None:
    """Why friction under load is negative in one quadrant; None where it is not.

    The difference of the quadrants is then more than their mean: the load torque on another scale.
    """
    fit, quadrant = claim.after, claim.torque
    if claim.effect != "quadrant" or quadrant is None:
        return None
    load = term_torque(fit, "load")
    if load is None:
        return None
    friction = (load + quadrant) * np.sign(fit.recording.velocity[fit.rows])
    if rms(np.minimum(friction, 0.0)) <= DRIVING * rms(friction):
        return None
    return (
        "friction under load would drive the joint in one quadrant, as a load on a wrong scale does"
    )


def negative_inertia(claim: Claim) -> str | None:
    """Why the whole inertia is negative; None where it is not, or may not be."""
    fit = claim.after
    found = fit.estimates.get("inertia")
    if found is None or found.value >= 0.0:
        return None
    known = _known_inertia(fit) if "inertia" in fit.model.effects else 0.0
    reach = BEYOND * found.stderr if found.stderr is not None else 0.0
    if known is None or known + found.value + reach >= 0.0:
        return None
    return f"the inertia would be negative, {number(known + found.value)} {found.unit}"


def _known_inertia(fit: Fit) -> float | None:
    """Inertia in the recorded load torque: what in it is proportional to the acceleration."""
    r, rows = fit.recording, fit.rows
    load, a = r.load_torque, r.acceleration
    if load is None or float(np.std(a[rows])) == 0.0:
        return None
    columns = [a[rows], np.ones(rows.size)]
    if r.position is not None:
        columns += [np.cos(r.position[rows]), np.sin(r.position[rows])]
    return float(linear.least_norm(np.column_stack(columns), load[rows])[0])
