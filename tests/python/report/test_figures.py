"""Figures are drawn, labelled with units, and written whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from matplotlib.figure import Figure
from matplotlib.image import imread
from stribeck.base import files
from stribeck.base.errors import StribeckError
from stribeck.report import style
from stribeck.report.fit import fit_figure
from stribeck.report.improvement_figure import improvement_figure, telling_window
from stribeck.report.residual import residual_figure


def drawn(improvement: sb.Improvement, steady: sb.Fit) -> dict[str, Figure]:
    base, final = improvement.base, improvement.final
    nothing = replace(improvement, steps=(), final=base)
    return {
        "improvement": improvement_figure(improvement),
        "nothing found": improvement_figure(nothing),
        "fit": fit_figure(final),
        "steady": fit_figure(steady),
        "residual": residual_figure([base, final]),
        "one residual": residual_figure([final]),
        "steady residual": residual_figure([steady]),
    }


def test_every_axis_has_its_unit(improvement: sb.Improvement, steady: sb.Fit) -> None:
    for name, figure in drawn(improvement, steady).items():
        for axes in figure.axes:
            if not axes.get_visible() or not axes.xaxis.label.get_text():
                continue
            assert "[" in axes.get_xlabel(), (name, axes.get_xlabel())
            assert "[" in axes.get_ylabel() or axes.get_yticklabels(), name


def test_models_of_one_spec_are_told_apart(improvement: sb.Improvement) -> None:
    (legend,) = residual_figure([improvement.base, improvement.base]).legends
    labels = [text.get_text() for text in legend.get_texts()]
    assert [label.split("  ")[0] for label in labels[:2]] == ["coulomb (1)", "coulomb (2)"]


@pytest.mark.slow
def test_legends_do_not_lie_over_the_data(improvement: sb.Improvement, steady: sb.Fit) -> None:
    for name, figure in drawn(improvement, steady).items():
        figure.canvas.draw()
        for axes in figure.axes:
            legend = axes.get_legend()
            if legend is not None:
                box = legend.get_window_extent()
                inside = axes.get_window_extent()
                overlap = min(box.y1, inside.y1) - max(box.y0, inside.y0)
                assert overlap < 2.0, (name, axes.get_title(loc="left"))


@pytest.mark.parametrize("kind", files.FORMATS)
def test_a_figure_is_written_whole(improvement: sb.Improvement, tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"made.{kind}"
    files.save_figure(fit_figure(improvement.final), path)
    assert path.stat().st_size > 10_000
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    if kind == "png":
        assert imread(path).shape[1] >= 1200


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda folder: folder / "made.txt", "png"),
        (lambda folder: folder / "absent" / "made.png", "cannot write"),
    ],
)
def test_what_cannot_be_written_is_refused(
    make: Callable[[Path], Path], word: str, tmp_path: Path
) -> None:
    with pytest.raises(StribeckError, match=word):
        files.save_figure(Figure(), make(tmp_path))


def test_medians_leave_out_bins_that_hold_little() -> None:
    x = np.concatenate([np.linspace(0, 1, 1000), [5.0]])
    at, median = style.binned_median(x, 2 * x)
    assert at.max() <= 1.0
    np.testing.assert_allclose(median, 2 * at)
    assert style.binned_median(np.zeros(500), np.zeros(500))[0].size == 0


def test_the_window_is_where_the_gain_is(improvement: sb.Improvement) -> None:
    window = telling_window(improvement)
    base, final = improvement.base, improvement.final
    gain = np.where(base.recording.moving, base.residual**2 - final.residual**2, 0.0)
    assert gain[window].mean() > gain.mean()
