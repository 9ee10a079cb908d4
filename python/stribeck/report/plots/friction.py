"""Friction, measured and modelled: over velocity, over time, and about reversals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stribeck.base.errors import SpecError
from stribeck.effect.columns import displacement_since_reversal
from stribeck.effect.describe import is_drive_train
from stribeck.motion.simulate.acting import friction_of
from stribeck.report.channels import clock, torque_name
from stribeck.report.plots.page import Page, centred
from stribeck.report.style import MEASURED, MOST_POINTS, dots, strided, thin, zero_line

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.fitting.result import Fit
    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

#: Measured samples behind the models.
_GREY = "#b3b3b3"
#: Speeds at which a curve is drawn.
_SPEEDS = 400
#: Slow motion, as a share of the largest speed, and in thresholds of moving rows.
_SLOW, _THRESHOLDS = 0.02, 3.0
#: Most points of a path about reversals.
_PATH = 6000


def load_torque(fits: Sequence[Fit]) -> Array:
    """The load that is no friction, array [n].

    That of the recording; where it has none, that of the rigid body which the best of the fits
    identified. Measured minus modelled friction of each fit is then its residual.
    """
    best = min(fits, key=lambda fit: fit.rmse)
    own = best.own_load
    return best.recording.known_torque if own is None or best.model.drive is not None else own


def friction_velocity(page: Page) -> Figure:
    """Friction over velocity: a curve where the velocity alone decides, else the samples."""
    (axes,) = page.panels(1)
    first, r = page.fits[0], page.fits[0].recording
    moving = np.flatnonzero(r.moving)
    load, some = load_torque(page.fits), thin(moving)
    measured = r.torque - load
    zero_line(axes)
    dots(axes, r.velocity[some], measured[some], _GREY)
    dotted = []
    for k, fit in enumerate(page.fits):
        curve = _curve(fit)
        if curve is not None:
            axes.plot(*curve, **page.line(k))  # type: ignore[arg-type]
            continue
        dotted.append(k)
        some = thin(moving, MOST_POINTS // len(page.fits))
        dots(axes, r.velocity[some], (fit.prediction - load)[some], page.colour(k))
    centred(axes, measured[moving])
    axes.set_xlabel(_velocity_label(r))
    axes.set_ylabel(_friction_label(first))
    return page.finished([axes], dotted=dotted)


def _curve(fit: Fit) -> tuple[Array, Array] | None:
    """Speeds and steady friction; None where the friction depends on more than the velocity."""
    r = fit.recording
    trains = [e for e in fit.model.effects if is_drive_train(e)]
    if fit.model.drive is not None or trains:
        return None
    friction, left_out = friction_of(fit.model)
    if left_out or friction.has_state or {*friction.core.needs} - {"velocity"}:
        return None
    top = float(np.abs(r.velocity[r.moving]).max())
    one_way = np.geomspace(top / 1e4, top, _SPEEDS)
    speeds = np.concatenate([-one_way[::-1], [np.nan], one_way])
    low, high = r.velocity[r.moving].min(), r.velocity[r.moving].max()
    seen = speeds[np.isnan(speeds) | ((speeds >= low) & (speeds <= high))]
    torque = np.full(seen.shape, np.nan)
    known = np.isfinite(seen)
    torque[known] = friction.torque(seen[known])
    return seen, torque


def over_time(page: Page) -> Figure:
    """Motor torque and load over time, and friction below; one panel where it was measured."""
    first, r = page.fits[0], page.fits[0].recording
    if r.averaged:
        raise SpecError(f"{r.path} has steady-state points, which have no order in time")
    load, time = load_torque(page.fits), clock(r)
    with_motor = bool(load.any())
    panels = page.panels(2 if with_motor else 1, stacked=True, height=0.68 if with_motor else 0.9)
    some = strided(r.time.size)
    at = time.values[some]
    if with_motor:
        axes = panels[0]
        axes.plot(at, r.torque[some], color=MEASURED, linewidth=0.5)
        axes.plot(at, load[some], color="#56B4E9", linewidth=0.8)
        centred(axes, np.concatenate([r.torque, load]), 0.18)
        for text, x, colour in (("motor", 0.01, MEASURED), ("load", 0.13, "#0072B2")):
            axes.text(x, 0.98, text, transform=axes.transAxes, va="top", fontsize=7, color=colour)
        axes.set_ylabel(f"{torque_name(r.torque_unit)} [{r.torque_unit}]")
    axes = panels[-1]
    zero_line(axes)
    dots(axes, at, (r.torque - load)[some], _GREY)
    for k, fit in enumerate(page.fits):
        # At rest a static law has no say: the line breaks there.
        shown = np.where(r.moving | fit.model.has_state, fit.prediction - load, np.nan)
        axes.plot(at, shown[some], **page.line(k))  # type: ignore[arg-type]
    centred(axes, (r.torque - load)[r.moving])
    axes.margins(x=0.01)
    axes.set_xlabel(time.label)
    axes.set_ylabel(_friction_label(first))
    return page.finished(panels)


def hysteresis(page: Page) -> Figure:
    """Friction in slow motion, over velocity and over the displacement since a reversal."""
    first, r = page.fits[0], page.fits[0].recording
    if r.averaged:
        raise SpecError(f"{r.path} has steady-state points, which have no reversals")
    top = float(np.abs(r.velocity[r.moving]).max())
    slow = max(_SLOW * top, _THRESHOLDS * r.velocity_threshold)
    left, right = page.panels(2)
    near = np.abs(r.velocity) <= slow
    _paths(page, left, r.velocity, near, r)
    left.set_xlim(-slow, slow)
    left.set_xlabel(_velocity_label(r))
    left.set_ylabel(_friction_label(first))
    way = np.asarray(displacement_since_reversal(r), dtype=np.float64)
    shown = r.moving & (way <= _reach(r, way))
    signed = np.sign(r.velocity) * way
    _paths(page, right, signed, shown, r)
    right.set_xlabel(f"displacement since reversal · sgn v [{r.position_unit}]")
    right.set_ylabel(_friction_label(first))
    for axes in (left, right):
        axes.locator_params(axis="x", nbins=5)
    return page.finished([left, right])


def _reach(r: Recording, way: Array) -> float:
    """Displacement that shows what follows a reversal: 2 % of the longest way, 40 samples."""
    typical = float(np.median(np.abs(r.velocity[r.moving]) * r.dt[r.moving]))
    return max(0.02 * float(way[r.moving].max()), 40.0 * typical)


def _paths(page: Page, axes: Axes, x: Array, shown: NDArray[np.bool_], r: Recording) -> None:
    zero_line(axes)
    rows = np.flatnonzero(shown)
    if not rows.size:
        raise SpecError(f"{r.path} has no slow motion in which hysteresis would show")
    some = thin(rows)
    load = load_torque(page.fits)
    measured = r.torque - load
    dots(axes, x[some], measured[some], _GREY)
    part = rows[:_PATH]
    begins = np.diff(part, prepend=part[:1]) > 1
    reverses = np.diff(np.sign(r.velocity[part]), prepend=np.sign(r.velocity[part[:1]])) != 0
    for k, fit in enumerate(page.fits):
        # A static law jumps at a reversal; its line breaks there.
        breaks = begins | (reverses & (not fit.model.has_state))
        y = np.where(breaks, np.nan, (fit.prediction - load)[part])
        axes.plot(x[part], y, **{**page.line(k), "linewidth": 0.7})  # type: ignore[arg-type]
    centred(axes, measured[rows], 0.12)


def _velocity_label(r: Recording) -> str:
    return f"velocity [{r.position_unit}/s]"


def _friction_label(fit: Fit) -> str:
    unit = fit.recording.torque_unit
    kind = torque_name(unit)
    return f"friction [{unit}]" if kind != "effort" else f"{kind} without load [{unit}]"
