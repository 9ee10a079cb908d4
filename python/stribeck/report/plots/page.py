"""The page of a journal: column widths, type sizes, one legend above the panels."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from stribeck.base.errors import SpecError, listed
from stribeck.report.names import model_names
from stribeck.report.style import COLOURS, MEASURED, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from stribeck.fitting.result import Fit

#: Column widths of most journals, mm.
WIDTHS = {"single": 88.0, "double": 180.0}
#: Narrowest and widest figure, mm.
NARROWEST, WIDEST = 40.0, 400.0
_MM = 1.0 / 25.4
#: Tallest panel, mm.
_TALLEST = 70.0
#: Sizes of type, points, as journals ask for in print.
LABEL, TICKS = 8.0, 7.0
_DPI = 300
#: Line styles, so that models differ without colour too.
_STYLES = ("-", "--", "-.", ":")
#: Longest name in the legend.
_LONGEST = 44


def width_in_mm(width: str | float) -> float:
    """A width in mm: ``"single"``, ``"double"``, or a number.

    Raises
    ------
    SpecError
        It is neither, or too narrow or wide to draw.

    Examples
    --------
    >>> width_in_mm("double"), width_in_mm("120")
    (180.0, 120.0)
    """
    if isinstance(width, str) and width in WIDTHS:
        return WIDTHS[width]
    try:
        number = float(width)
    except (TypeError, ValueError):
        number = math.nan
    if not NARROWEST <= number <= WIDEST:
        raise SpecError(
            f"the width {width!r} is unknown: give {listed(WIDTHS)}, or {NARROWEST:g} to "
            f"{WIDEST:g} mm"
        )
    return number


@dataclass(frozen=True)
class Page:
    """A figure of one width.

    Attributes
    ----------
    width
        mm.
    fits
        The models on the recording, in the order of their colours.
    """

    width: float
    fits: Sequence[Fit]

    def panels(self, count: int, *, stacked: bool = False, height: float = 0.68) -> list[Axes]:
        """Axes of a new figure: side by side where there is room, else one below the other.

        Parameters
        ----------
        stacked
            One below the other with one x axis, whatever the width.
        height
            Of a panel, as a share of its width.
        """
        beside = count > 1 and not stacked and self.width >= 1.5 * WIDTHS["single"]
        columns, rows = (count, 1) if beside else (1, count)
        each = min(self.width / columns * (height if not stacked else height * 0.7), _TALLEST)
        legend = 4.5 * (1 + math.ceil((1 + len(self.fits)) / self._legend_columns))
        figure = new_figure(self.width * _MM, (each * rows + legend) * _MM, dpi=_DPI)
        grid = figure.subplots(rows, columns, squeeze=False, sharex=stacked)
        made: list[Axes] = list(grid.ravel())
        for axes in made:
            style(axes)
            axes.tick_params(labelsize=TICKS, length=2.5, pad=2)
        return made

    @property
    def _legend_columns(self) -> int:
        """Columns of the legend: as many names beside each other as the width holds."""
        longest = max(len(self.name(fit)) for fit in self.fits)
        return max(1, int(self.width // (12.0 + 1.35 * max(longest, 9))))

    def colour(self, index: int) -> str:
        """Colour of a model."""
        return COLOURS[index % len(COLOURS)]

    def name(self, fit: Fit) -> str:
        """Name of a model in the legend; of two alike, which one was not fitted here."""
        spec, name = fit.model.spec, model_names(self.fits)[list(self.fits).index(fit)]
        return f"{short(spec)}{name.removeprefix(spec)}"

    def line(self, index: int) -> dict[str, object]:
        """Colour, style and width of a model's line."""
        return {
            "color": self.colour(index),
            "linestyle": _STYLES[index % len(_STYLES)],
            "linewidth": 1.1,
        }

    def finished(
        self,
        axes: Sequence[Axes],
        *,
        measured: str | None = "measured",
        as_line: bool = False,
        dotted: Collection[int] = (),
    ) -> Figure:
        """The figure with labels in the page's type, and its legend.

        Parameters
        ----------
        measured
            What the legend calls the measured samples; None: there are none.
        as_line
            Whether they are a line, not dots.
        dotted
            The models that are drawn as dots, not lines.
        """
        figure: Figure = axes[0].figure  # type: ignore[assignment]
        for panel in figure.axes:
            panel.xaxis.label.set_fontsize(LABEL)
            panel.yaxis.label.set_fontsize(LABEL)
        handles = [] if measured is None else [_measured(measured, as_line)]
        handles += [self._handle(k, fit, k in dotted) for k, fit in enumerate(self.fits)]
        figure.legend(
            handles=handles,
            loc="outside upper left",
            ncols=min(self._legend_columns, len(handles)),
            frameon=False,
            fontsize=TICKS,
            handlelength=2.2,
            columnspacing=1.0,
            borderaxespad=0.2,
        )
        return figure

    def _handle(self, index: int, fit: Fit, dotted: bool) -> Line2D:
        from matplotlib.lines import Line2D

        drawn = self.line(index)
        if dotted:
            drawn |= {"linestyle": "none", "marker": ".", "markersize": 4}
        return Line2D([], [], label=self.name(fit), **drawn)  # type: ignore[arg-type]


def _measured(label: str, as_line: bool) -> Line2D:
    from matplotlib.lines import Line2D

    if as_line:
        return Line2D([], [], color=MEASURED, linewidth=0.8, alpha=0.6, label=label)
    return Line2D([], [], color=MEASURED, linestyle="none", marker=".", markersize=4, label=label)


def short(text: str) -> str:
    """A name that fits into a legend."""
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def centred(axes: Axes, values: np.ndarray, room: float = 0.06) -> None:
    """Show 99.8 % of the values, with room above and below."""
    finite = values[np.isfinite(values)]
    if finite.size:
        low, high = np.quantile(finite, [0.001, 0.999])
        span = (high - low) or 1.0
        axes.set_ylim(float(low - room * span), float(high + room * span))
