"""The picture of an improvement: torque, residual, what each effect explains, the errors."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stribeck.report.channels import clock, torque_name
from stribeck.report.finding import finding_panel, panel_legend
from stribeck.report.improvement import step_errors, step_labels
from stribeck.report.numbers import change_text, plain
from stribeck.report.residual import velocity_panel
from stribeck.report.style import (
    AFTER,
    BEFORE,
    MEASURED,
    broken,
    headline,
    legend_above,
    legend_below,
    limits,
    new_figure,
    over_time,
    style,
    title,
    zero_line,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stribeck.diagnosis.loop.improve import Improvement

#: Effects that get a panel, and the longest spec in a legend.
MOST_PANELS, LONGEST = 2, 48


def improvement_figure(improvement: Improvement) -> Figure:
    """The way from the base model to the final one.

    Torque in the window where the gain is largest, the residual over the whole recording, the
    residual against the channel in which each effect shows (two at most), and the held-out error
    after each step with the noise floor.
    """
    base, steps = improvement.base, improvement.steps
    count = max(min(len(steps), MOST_PANELS), 1)
    figure = new_figure(12.0, 11.0)
    outer = figure.add_gridspec(3, 1, height_ratios=[1.2, 0.85, 1.15])
    below = outer[2].subgridspec(1, count + 1)
    top, middle = figure.add_subplot(outer[0]), figure.add_subplot(outer[1])
    panels = [figure.add_subplot(below[0, k]) for k in range(count)]
    last = figure.add_subplot(below[0, count])
    for axes in (top, middle, *panels, last):
        style(axes)
    window = telling_window(improvement)
    _torque_panel(top, improvement, window)
    _residual_panel(middle, improvement, window)
    if not steps:
        velocity_panel(panels[0], base, BEFORE)
    for axes, step in zip(panels, steps, strict=False):
        effect = step.finding.effect
        finding_panel(axes, effect, step.before, step.after)
        title(axes, f"Residual without and with {effect}")
        legend_below(axes, 2, panel_legend(effect))
    _errors_panel(last, improvement)
    way = f"{base.model.spec} → {improvement.final.model.spec}" if steps else base.model.spec
    headline(figure, f"{way} on {Path(base.recording.path).name}", 12.5)
    return figure


def telling_window(improvement: Improvement) -> slice:
    """The few seconds in which the final model gains most on the base, as a range of samples."""
    r = improvement.final.recording
    n = r.time.size
    if r.averaged or r.rate_hz <= 0:
        return slice(0, n)
    duration = float(np.clip(0.1 * float(np.sum(r.dt)), 3.0, 12.0))
    length = min(max(round(duration * r.rate_hz), 20), n)
    gain = np.where(r.moving, improvement.base.residual**2 - improvement.final.residual**2, 0.0)
    sums = np.concatenate(([0.0], np.cumsum(gain)))
    total = sums[length:] - sums[:-length]
    # A window must not run across a gap.
    whole = r.segment[length - 1 :] == r.segment[: n - length + 1]
    if whole.any():
        total = np.where(whole, total, -np.inf)
    start = int(np.argmax(total))
    return slice(start, start + length)


def _labels(improvement: Improvement) -> tuple[str, str]:
    """What the base and the final model are called in a legend."""
    spec = improvement.final.model.spec
    short = spec if len(spec) <= LONGEST else f"with {len(improvement.steps)} effects added"
    return improvement.base.model.spec, short


def _torque_panel(axes: Axes, improvement: Improvement, window: slice) -> None:
    base, final = improvement.base, improvement.final
    r, unit, time = final.recording, final.model.torque_unit, clock(final.recording)
    what, x = torque_name(unit), time.values[window]
    over_time(axes, r, x, r.torque[window], MEASURED, (2.6, 7.0), f"measured {what}", 0.55)
    fits = [(base, BEFORE), (final, AFTER)] if improvement.steps else [(base, BEFORE)]
    for (fit, colour), label in zip(fits, _labels(improvement), strict=False):
        shown = broken(r, fit.prediction)[window]
        over_time(axes, r, x, shown, colour, (1.3, 3.0), label)
    axes.set_xlabel(time.label)
    axes.set_ylabel(f"{what} [{unit}]")
    axes.margins(x=0.01)
    part = (x[-1] - x[0]) / max(np.ptp(time.values), 1e-12) <= 0.95
    chosen = improvement.steps and part and not r.averaged
    where = ", where the added effects help most" if chosen else ""
    title(axes, f"Measured and modelled {what}{where}")
    legend_above(axes)


def _residual_panel(axes: Axes, improvement: Improvement, window: slice) -> None:
    base, final = improvement.base, improvement.final
    r, unit, time = final.recording, final.model.torque_unit, clock(final.recording)
    part = window.stop - window.start < r.time.size
    if part:
        x = time.values[window]
        axes.axvspan(x[0], x[-1], color="#ececec", zorder=0, linewidth=0)
    zero_line(axes)
    fits = [(base, BEFORE), (final, AFTER)] if improvement.steps else [(base, BEFORE)]
    for (fit, colour), label in zip(fits, _labels(improvement), strict=False):
        shown = broken(r, fit.residual)
        over_time(axes, r, time.values, shown, colour, (0.7, 3.0), label)
    limits(axes, [base.residual[r.moving], final.residual[r.moving]])
    axes.set_xlabel(time.label)
    axes.set_ylabel(f"residual [{unit}]")
    grey = "; grey: the window shown above" if part else ""
    title(axes, f"Residual (measured minus modelled) of the {torque_name(unit)}{grey}")
    legend_above(axes)
    axes.margins(x=0.01)


def _errors_panel(axes: Axes, improvement: Improvement) -> None:
    """The error after each step as bars, and the noise floor."""
    from matplotlib.ticker import MaxNLocator

    unit = improvement.final.model.torque_unit
    fits = [improvement.base, *(s.after for s in improvement.steps)]
    known = [e for e in step_errors(improvement) if e is not None]
    held_out = len(known) == len(fits)
    values = known if held_out else [f.rmse for f in fits]
    axes.barh(
        np.arange(len(values)),
        values,
        color=[BEFORE, *([AFTER] * (len(values) - 1))],
        height=0.62,
    )
    largest = max(values)
    for k, value in enumerate(values):
        fall = "" if k == 0 else f"  ({change_text(values[k - 1], value)})"
        inside = value > 0.6 * largest
        axes.text(
            value + (-0.02 if inside else 0.02) * largest,
            k,
            f"{plain(value)}{fall}",
            va="center",
            ha="right" if inside else "left",
            fontsize=9,
            color="white" if inside else "black",
        )
    axes.set_yticks(np.arange(len(values)), step_labels(improvement))
    axes.set_ylim(max(len(values), 3) - 0.5, -0.5)
    axes.set_xlim(0.0, 1.05 * largest)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.set_xlabel(f"{'held-out ' if held_out else ''}RMSE [{unit}]")
    axes.grid(False, axis="y")
    floor = improvement.noise_floor.value
    if floor is not None:
        label = f"noise floor {plain(floor)} {unit}"
        axes.axvline(floor, color="black", linewidth=1.3, linestyle=":", label=label)
        legend_below(axes, heading="prediction error on held-out data" if held_out else None)
    title(axes, "Error after each step")
