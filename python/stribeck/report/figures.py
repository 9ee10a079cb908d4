"""Pictures: measured and modelled torque, residuals, and the way down to the noise.

Figures are made without pyplot, so that nothing is shared between threads or callers. Colours
are those of Okabe and Ito, which colour-blind readers can tell apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from stribeck.report.channels import Channel, channel, clock, load_of, torque_name
from stribeck.report.numbers import change_text, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from stribeck.diagnosis.compare import Comparison
    from stribeck.diagnosis.improve import Improvement
    from stribeck.diagnosis.result import Diagnosis
    from stribeck.fitting.result import Fit
    from stribeck.projects.project import Project
    from stribeck.projects.sides import Sides
    from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

MEASURED = "#4d4d4d"
BEFORE = "#D55E00"
AFTER = "#0072B2"
FLOOR = "#009E73"
COLOURS = (BEFORE, AFTER, FLOOR, "#CC79A7", "#E69F00", "#56B4E9")
DPI = 120
#: Points drawn of a scatter; more only make ink.
MOST_POINTS = 3000
BINS = 30
#: With fewer rows a median by bins says less than the rows themselves.
FEWEST_FOR_MEDIAN = 150


def new_figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def style(axes: Axes) -> None:
    axes.grid(True, color="#e6e6e6", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.title.set_fontsize(10.5)
    axes.tick_params(labelsize=9)


def title(axes: Axes, text: str) -> None:
    axes.set_title(text, loc="left", fontsize=10.5)


def _legend_above(axes: Axes, columns: int = 4) -> None:
    """A legend to the right above the axes, where it covers no data."""
    legend = axes.legend(
        loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=columns, frameon=False, fontsize=9,
        borderaxespad=0.2, handlelength=1.6, columnspacing=1.2,
    )  # fmt: skip
    for line in legend.get_lines():
        line.set_linewidth(2.4)


def thin(rows: NDArray[np.intp], most: int = MOST_POINTS) -> NDArray[np.intp]:
    if rows.size <= most:
        return rows
    # Seeded and not strided: a stride may beat with a periodic motion.
    picked = np.random.default_rng(0).choice(rows, most, replace=False)
    return np.asarray(np.sort(picked))


def dots(count: int) -> dict[str, Any]:
    """How to draw `count` single rows: few of them large, many of them faint."""
    size, alpha = (7.0, 0.9) if count < 300 else (4.0, 0.5) if count < 1500 else (3.0, 0.35)
    return {
        "linestyle": "none", "marker": ".", "markersize": size, "alpha": alpha,
        "markeredgewidth": 0, "rasterized": True,
    }  # fmt: skip


def binned_quartiles(
    x: Array, y: Array, bins: int = BINS, *, log: bool = False
) -> tuple[Array, Array, Array, Array]:
    """Where bins of `x` of equal width lie, and the quartiles of `y` in each: lower, median, upper.

    Parameters
    ----------
    log : bool
        Bins of equal ratio; `x` is above zero where it is drawn.

    Returns
    -------
    arrays [k]
        Of the bins that hold enough points.
    """
    none = (np.empty(0),) * 4
    if log:
        x, y = x[x > 0], y[x > 0]
    if x.size < FEWEST_FOR_MEDIAN or not np.ptp(x) > 0:
        return none
    along = np.log(x) if log else x
    low, high = np.quantile(along, [0.01 if log else 0.002, 0.998])
    if not high > low:
        return none
    index = np.clip(np.floor((along - low) / (high - low) * bins), -1, bins).astype(np.intp)
    least = max(5, x.size // 2000)
    inside = [index == k for k in range(bins)]
    rows = [
        [np.median(x[here]), *np.quantile(y[here], [0.25, 0.5, 0.75])]
        for here in inside if np.count_nonzero(here) >= least
    ]  # fmt: skip
    if not rows:
        return none
    at, lower, median, upper = np.array(rows, dtype=np.float64).T
    return at, lower, median, upper


def binned_median(x: Array, y: Array, bins: int = BINS) -> tuple[Array, Array]:
    """Median of `y` in bins of `x` of equal width, where there are enough points."""
    at, _, median, _ = binned_quartiles(x, y, bins)
    return at, median


def limits(axes: Axes, values: Sequence[Array]) -> None:
    """Show 99.8 % of the residuals; a single spike must not flatten the rest."""
    joined = np.concatenate([v[np.isfinite(v)] for v in values])
    if joined.size == 0:
        return
    low, high = np.quantile(joined, [0.001, 0.999])
    room = 0.1 * (high - low) or 1.0
    axes.set_ylim(float(low - room), float(high + room))


def _lines(r: Recording, values: Array) -> Array:
    """`values` with NaN at rest and before each gap, so that a line breaks there."""
    drawn = np.where(r.moving, values, np.nan)
    if r.averaged:
        return drawn
    drawn[np.flatnonzero(np.diff(r.segment)) + 1] = np.nan
    return drawn


def comparison_figure(comparison: Comparison) -> Figure:
    """Residual of each model against each channel."""
    return residual_figure([assessment.fit for assessment in comparison.models])


def sides_figure(sides: Sides) -> Figure:
    """Residual of both models against each channel."""
    return comparison_figure(sides.comparison)


def diagnosis_figure(diagnosis: Diagnosis) -> Figure:
    """Residual against each channel, before the first finding and after."""
    after = [diagnosis.findings[0].fit] if diagnosis.findings else []
    return residual_figure([diagnosis.fit, *after])


def project_figure(project: Project) -> Figure:
    """Residual of the base and of the current model against each channel."""
    numbers = (project.tree.root.number, project.current)
    return residual_figure([project.fit_of(n) for n in project.tree if n.number in numbers])


def residual_figure(fits: Sequence[Fit]) -> Figure:
    """Residual of one or several models against each channel of the recording.

    Dots are single rows (thinned); lines are medians of bins, forward solid, backward dashed,
    since friction turns its sign with the motion.
    """
    found = [
        (name, made)
        for name in ("time", "velocity", "position", "load", "temperature", "acceleration")
        if (made := channel(fits[0], name)) is not None
    ]
    columns = min(len(found), 2)
    rows = -(-len(found) // columns)
    figure = new_figure(12.0, 1.0 + 3.1 * max(rows, 1.3))
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    r, unit = fits[0].recording, fits[0].model.torque_unit
    moving = np.flatnonzero(r.moving)
    some = thin(moving, MOST_POINTS // min(len(fits), 3))
    for axes, (name, made) in zip(grid, found, strict=False):
        style(axes)
        axes.axhline(0.0, color="#999999", linewidth=0.8)
        for k, fit in enumerate(fits):
            colour = COLOURS[k % len(COLOURS)]
            residual = fit.residual
            if len(fits) <= 3:
                axes.plot(made.values[some], residual[some], color=colour, **dots(some.size))
            ways = (
                [(moving, "-")] if name == "velocity"
                else [(moving[r.velocity[moving] > 0], "-"), (moving[r.velocity[moving] < 0], "--")]
            )  # fmt: skip
            for way, line in ways:
                at, median = binned_median(made.values[way], residual[way])
                axes.plot(at, median, line, color=colour, linewidth=1.8)
        limits(axes, [fit.residual[moving] for fit in fits])
        axes.set_xlabel(made.label)
        axes.set_ylabel(f"residual [{unit}]")
    for axes in grid[len(found) :]:
        axes.set_visible(False)
    figure.suptitle(
        f"Residual (measured minus model) against each channel, {Path(r.path).name}",
        fontsize=12, x=0.01, ha="left",
    )  # fmt: skip
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=COLOURS[k % len(COLOURS)], linewidth=2.5,
               label=f"{fit.model.spec}  (RMSE {plain(fit.rmse)} {unit})")
        for k, fit in enumerate(fits)
    ]  # fmt: skip
    if moving.size >= FEWEST_FOR_MEDIAN:
        handles += [
            Line2D([], [], color="#555555", linewidth=1.8, label="median, moving forward"),
            Line2D([], [], color="#555555", linewidth=1.8, linestyle="--",
                   label="median, moving backward"),
        ]  # fmt: skip
    figure.legend(
        handles=handles, loc="outside lower left", ncols=2 if len(fits) > 1 else 3,
        frameon=False, fontsize=9,
    )  # fmt: skip
    return figure


def fit_figure(fit: Fit) -> Figure:
    """Measured and modelled torque over time, the residual, and the friction curve."""
    r, unit = fit.recording, fit.model.torque_unit
    what = torque_name(unit)
    figure = new_figure(12.0, 9.0)
    grid = figure.add_gridspec(3, 2, height_ratios=[1.15, 0.8, 1.15])
    top, middle = figure.add_subplot(grid[0, :]), figure.add_subplot(grid[1, :])
    left, right = figure.add_subplot(grid[2, 0]), figure.add_subplot(grid[2, 1])
    time = clock(r)
    for axes in (top, middle, left, right):
        style(axes)
    mark = "o" if r.averaged else "-"
    size: dict[str, Any] = {"markersize": 3.0} if r.averaged else {"linewidth": 0.9}
    broad: dict[str, Any] = {"markersize": 5.0} if r.averaged else {"linewidth": 2.4}
    top.plot(time.values, r.torque, mark, color=MEASURED, alpha=0.5, label="measured", **broad)
    top.plot(time.values, _lines(r, fit.prediction), mark, color=AFTER, label=fit.model.spec,
             **size)  # fmt: skip
    top.margins(x=0.01)
    top.set_ylabel(f"{what} [{unit}]")
    title(top, f"Measured and modelled {what}")
    _legend_above(top)
    top.tick_params(labelbottom=False)
    middle.sharex(top)
    middle.axhline(0.0, color="#999999", linewidth=0.8)
    middle.plot(time.values, _lines(r, fit.residual), mark, color=AFTER, **size)
    limits(middle, [fit.residual[r.moving]])
    middle.set_ylabel(f"residual [{unit}]")
    middle.set_xlabel(time.label)
    title(middle, f"Residual, measured minus model: RMSE {plain(fit.rmse)} {unit}")

    moving = np.flatnonzero(r.moving)
    some = thin(moving)
    load = load_of(fit)
    rest = np.zeros_like(r.torque) if load is None else load
    name = what if load is None else f"friction {what}"
    dots: dict[str, Any] = {"markeredgewidth": 0}
    # A rigid body identified with the friction is in the prediction, and so is a known load.
    left.plot(r.velocity[some], (r.torque - rest)[some], ".", color=MEASURED, markersize=6.0,
              alpha=0.35, label="measured", **dots)  # fmt: skip
    left.plot(r.velocity[some], (fit.prediction - rest)[some], ".", color=AFTER, markersize=2.2,
              label=fit.model.spec, **dots)  # fmt: skip
    left.set_xlabel(f"velocity [{r.position_unit}/s]")
    left.set_ylabel(f"{name} [{unit}]")
    without = "" if load is None else f" ({what} minus load)"
    title(left, f"{name[0].upper()}{name[1:]} against velocity{without}")
    for line in left.get_lines():
        line.set_rasterized(True)

    _velocity_panel(right, fit, AFTER)
    return figure


def _velocity_panel(axes: Axes, fit: Fit, colour: str) -> None:
    """The residual of one model against velocity."""
    made = channel(fit, "velocity") or clock(fit.recording)
    moving = np.flatnonzero(fit.recording.moving)
    some = thin(moving, 2000)
    axes.axhline(0.0, color="#999999", linewidth=0.8)
    axes.plot(made.values[some], fit.residual[some], color=colour, **dots(some.size))
    at, median = binned_median(made.values[moving], fit.residual[moving])
    axes.plot(at, median, "-", color="white", linewidth=3.6)
    axes.plot(at, median, "-", color=colour, linewidth=2.0, label=fit.model.spec)
    limits(axes, [fit.residual[moving]])
    axes.set_xlabel(made.label)
    axes.set_ylabel(f"residual [{fit.model.torque_unit}]")
    title(axes, "Residual against velocity")


def telling_window(improvement: Improvement) -> slice:
    """The rows, a few seconds, in which the final model gains most on the base."""
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


def improvement_figure(improvement: Improvement) -> Figure:
    """The way from the base model to the last one.

    Torque in the window where the gain is largest, the residual over the whole recording, the
    residual against the channel in which each effect shows (two at most), and the held-out
    error after each step with the noise floor.
    """
    from stribeck.report.finding import finding_panel, panel_legend

    base, final = improvement.base, improvement.final
    r, unit = final.recording, final.model.torque_unit
    what = torque_name(unit)
    steps = improvement.steps
    count = max(min(len(steps), 2), 1)
    figure = new_figure(12.0, 11.0)
    outer = figure.add_gridspec(3, 1, height_ratios=[1.2, 0.85, 1.15])
    top = figure.add_subplot(outer[0])
    middle = figure.add_subplot(outer[1])
    below = outer[2].subgridspec(1, count + 1)
    panels = [figure.add_subplot(below[0, k]) for k in range(count)]
    last = figure.add_subplot(below[0, count])
    for axes in (top, middle, *panels, last):
        style(axes)
    labels = _short_labels(improvement)

    time, window = clock(r), telling_window(improvement)
    _torque_panel(top, improvement, window, time, labels)
    mark = "." if r.averaged else "-"
    part = window.stop - window.start < r.time.size
    if part:
        middle.axvspan(
            time.values[window][0], time.values[window][-1], color="#ececec", zorder=0, linewidth=0
        )
    middle.axhline(0.0, color="#999999", linewidth=0.8)
    middle.plot(time.values, _lines(r, base.residual), mark, color=BEFORE, linewidth=0.7,
                label=labels[0])  # fmt: skip
    if steps:
        middle.plot(time.values, _lines(r, final.residual), mark, color=AFTER, linewidth=0.7,
                    label=labels[1])  # fmt: skip
    limits(middle, [base.residual[r.moving], final.residual[r.moving]])
    middle.set_xlabel(time.label)
    middle.set_ylabel(f"residual [{unit}]")
    grey = "; grey: the time shown above" if part else ""
    title(middle, f"Residual (measured minus model) of {what}{grey}")
    _legend_above(middle)
    middle.margins(x=0.01)

    if not steps:
        _velocity_panel(panels[0], base, BEFORE)
    for axes, step in zip(panels, steps, strict=False):
        effect = step.finding.effect
        finding_panel(axes, effect, step.before, step.after)
        title(axes, f"Residual without and with {effect}")
        axes.legend(
            loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2, frameon=False, fontsize=9,
            title=panel_legend(effect), title_fontsize=8.5,
        )  # fmt: skip
    _bars_panel(last, improvement)
    figure.suptitle(
        f"{base.model.spec} → {final.model.spec} on {Path(r.path).name}" if steps
        else f"{base.model.spec} on {Path(r.path).name}",
        fontsize=12.5, x=0.01, ha="left",
    )  # fmt: skip
    return figure


def _short_labels(improvement: Improvement) -> tuple[str, str]:
    spec = improvement.final.model.spec
    short = spec if len(spec) <= 48 else f"with {len(improvement.steps)} effects added"
    return improvement.base.model.spec, short


def _torque_panel(
    axes: Axes, improvement: Improvement, window: slice, time: Channel, labels: tuple[str, str]
) -> None:
    base, final = improvement.base, improvement.final
    r, unit = final.recording, final.model.torque_unit
    what = torque_name(unit)
    mark = "o" if r.averaged else "-"
    size: dict[str, Any] = {"markersize": 3.0} if r.averaged else {}
    x = time.values[window]
    broad: dict[str, Any] = {"markersize": 7.0} if r.averaged else {"linewidth": 2.6}
    axes.plot(x, r.torque[window], mark, color=MEASURED, alpha=0.55, label=f"measured {what}",
              **broad)  # fmt: skip
    axes.plot(x, _lines(r, base.prediction)[window], mark, color=BEFORE, linewidth=1.3,
              label=labels[0], **size)  # fmt: skip
    if improvement.steps:
        axes.plot(x, _lines(r, final.prediction)[window], mark, color=AFTER, linewidth=1.3,
                  label=labels[1], **size)  # fmt: skip
    axes.set_xlabel(time.label)
    axes.set_ylabel(f"{what} [{unit}]")
    axes.margins(x=0.01)
    share = (x[-1] - x[0]) / max(np.ptp(time.values), 1e-12)
    where = "" if r.averaged or share > 0.95 else ", where the added effects help most"
    if not improvement.steps:
        where = ""
    title(axes, f"Measured and modelled {what}{where}")
    _legend_above(axes)


def _bars_panel(axes: Axes, improvement: Improvement) -> None:
    from stribeck.report.text import step_errors, step_labels

    unit = improvement.final.model.torque_unit
    labels, errors = step_labels(improvement), step_errors(improvement)
    held_out = all(e is not None for e in errors)
    values = [
        e if e is not None else f.rmse
        for e, f in zip(
            errors, [improvement.base, *(s.after for s in improvement.steps)], strict=True
        )
    ]
    places = np.arange(len(values))
    colours = [BEFORE, *([AFTER] * (len(values) - 1))]
    axes.barh(places, values, color=colours, height=0.62)
    largest = max(values)
    for k, value in enumerate(values):
        fall = "" if k == 0 else f"  ({change_text(values[k - 1], value)})"
        inside = value > 0.6 * largest
        axes.text(
            value - 0.02 * largest if inside else value + 0.02 * largest, k,
            f"{plain(value)}{fall}", va="center", ha="right" if inside else "left", fontsize=9,
            color="white" if inside else "black",
        )  # fmt: skip
    axes.set_yticks(places, labels)
    axes.set_ylim(max(len(values), 3) - 0.5, -0.5)
    axes.set_xlim(0.0, 1.05 * largest)
    axes.xaxis.set_major_locator(MaxNLocator(5))
    axes.set_xlabel(f"{'held-out ' if held_out else ''}RMSE [{unit}]")
    axes.grid(False, axis="y")
    floor = improvement.noise_floor.value
    if floor is not None:
        axes.axvline(floor, color="black", linewidth=1.3, linestyle=":",
                     label=f"noise floor {plain(floor)} {unit}")  # fmt: skip
        axes.legend(
            loc="upper center", bbox_to_anchor=(0.5, -0.2), frameon=False, fontsize=9,
            title="error of predictions for data not seen" if held_out else None,
            title_fontsize=8.5,
        )  # fmt: skip
    title(axes, "Error after each step")
