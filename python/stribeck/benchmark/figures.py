"""The confusion matrix and the calibration curve as figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from stribeck.benchmark.reliability import Reliability
from stribeck.benchmark.score import Confusion
from stribeck.report.style import AFTER, BEFORE, DPI, MEASURED

#: Colours of shares from 0 to 1.
SHADES = LinearSegmentedColormap.from_list("shares", ["#ffffff", AFTER])
#: Share above which a number in a cell is written in white.
DARK = 0.55


def confusion_figure(confusion: Confusion) -> Figure:
    """Shares of each row in colour, counts as numbers; the correct cell is framed."""
    rows, columns = len(confusion.rows), len(confusion.columns)
    figure = _figure(3.2 + 0.42 * columns, 2.6 + 0.34 * rows)
    axes = figure.subplots()
    total = np.maximum(confusion.counts.sum(axis=1, keepdims=True), 1)
    shares = confusion.counts / total
    axes.imshow(shares, cmap=SHADES, vmin=0.0, vmax=1.0, aspect="auto")
    for i, j in np.argwhere(confusion.counts > 0):
        colour = "white" if shares[i, j] > DARK else "black"
        axes.text(
            j, i, str(confusion.counts[i, j]), ha="center", va="center", color=colour, fontsize=8
        )
    for i, hidden in enumerate(confusion.rows):
        right = confusion.right_column(hidden)
        if right in confusion.columns:
            j = confusion.columns.index(right)
            frame = Rectangle((j - 0.5, i - 0.5), 1, 1, fill=False, edgecolor=BEFORE, linewidth=1.3)
            axes.add_patch(frame)
    axes.set_xticks(
        range(columns),
        _words(confusion.columns),
        rotation=55,
        ha="right",
        rotation_mode="anchor",
        fontsize=8.5,
    )
    labels = [f"{name} ({n})" for name, n in zip(_words(confusion.rows), total[:, 0], strict=True)]
    axes.set_yticks(range(rows), labels, fontsize=8.5)
    axes.set_xticks(np.arange(columns + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(rows + 1) - 0.5, minor=True)
    axes.grid(True, which="minor", color="#e6e6e6", linewidth=0.6)
    axes.tick_params(which="both", length=0)
    for side in axes.spines.values():
        side.set_visible(False)
    axes.set_xlabel("named first", fontsize=10)
    axes.set_ylabel("hidden (recordings)", fontsize=10)
    axes.set_title("What is hidden and what was named (framed: right)", loc="left", fontsize=10.5)
    return figure


def calibration_figure(bins: Sequence[Reliability]) -> Figure:
    """Share of correct findings against their mean confidence, with 95 % intervals."""
    figure = _figure(5.4, 5.0)
    axes: Any = figure.subplots()
    axes.plot([0, 1], [0, 1], color=MEASURED, linewidth=0.9, linestyle="--", label="calibrated")
    means = np.array([r.mean for r in bins])
    shares = np.array([r.share.value for r in bins])
    spans = np.array([r.share.interval for r in bins]).T
    bars = np.abs(spans - shares)
    axes.errorbar(
        means,
        shares,
        yerr=bars,
        color=AFTER,
        marker="o",
        markersize=5,
        capsize=3,
        linewidth=1.3,
        linestyle="none",
        label="findings, 95 % interval",
    )
    plain = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}
    below = {"xytext": (0, -5), "textcoords": "offset points", "ha": "center", "va": "top"}
    for mean, low, r in zip(means, spans[0], bins, strict=True):
        count = str(r.share.total)
        axes.annotate(count, (mean, low), fontsize=8, color=MEASURED, bbox=plain, **below)
    axes.set(
        xlim=(-0.02, 1.02),
        ylim=(-0.02, 1.04),
        xlabel="stated confidence",
        ylabel="share of findings that are right",
    )
    axes.grid(True, color="#e6e6e6", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    axes.set_title(
        "Confidence and truth (numbers of findings below the intervals)", loc="left", fontsize=10.5
    )
    figure.legend(frameon=False, fontsize=9, loc="outside lower center", ncols=2)
    return figure


def _words(names: Sequence[str]) -> list[str]:
    return [name.replace("_", " ") for name in names]


def _figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure
