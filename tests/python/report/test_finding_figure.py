"""The figure behind a finding shows what was hidden, and that it is gone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from matplotlib.axes import Axes
from numpy.typing import NDArray
from stribeck.effect.describe import where
from stribeck.effect.registry import effects
from stribeck.motion.generate.hidden import generate
from stribeck.report.channels import channel
from stribeck.report.finding import finding_figure
from stribeck.report.style import binned_quartiles

Array = NDArray[np.float64]

#: Hidden effects, the base in which they are missing, and what the residual does without them,
#: from the left of the channel to its right.
SHAPES = {
    "load": ("coulomb", "rises"),
    "temperature_viscous": ("coulomb", "falls"),
    "drift": ("coulomb", "falls"),
    "inertia": ("coulomb", "rises"),
    "quadrant": ("coulomb", "rises"),
    "frictional_lag": ("coulomb+stribeck", "rises"),
}


def curves(axes: Axes) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """The medians without and with the effect: where and how high."""
    lines = [line for line in axes.get_lines() if line.get_marker() == "o"]
    found = [(np.asarray(x), np.asarray(y)) for x, y in (line.get_data() for line in lines)]
    return found[0], found[1]


@pytest.mark.parametrize("effect", SHAPES)
def test_the_figure_shows_the_effect_and_that_it_is_gone(effect: str, tmp_path: Path) -> None:
    base, shape = SHAPES[effect]
    hidden = [*base.split("+")[1:], effect]
    frame, _ = generate(hidden, seed=2, seconds=30.0, rate=100.0)
    frame.write_parquet(tmp_path / "made.parquet")
    recording = sb.read(tmp_path / "made.parquet", joint_kind="revolute")
    before = sb.fit(base, recording, starts=2)
    after = sb.add(before, effect, starts=2)
    finding = sb.Finding(
        effect,
        0.9,
        1.0,
        before.rmse_held_out or 0.0,
        after.rmse_held_out or 0.0,
        None,
        where(effect, before, after),
        (),
        after,
        before,
    )
    axes = finding.plot().axes[0]
    (x, without), (_, with_it) = curves(axes)
    third = max(x.size // 3, 1)
    rise = np.median(without[-third:]) - np.median(without[:third])
    assert (rise > 0) == (shape == "rises")
    assert np.std(with_it) < 0.35 * np.std(without)
    assert "[" in axes.get_xlabel() and "[N m]" in axes.get_ylabel()


def test_the_figure_gives_the_reason_and_the_held_out_errors(improvement: sb.Improvement) -> None:
    finding = improvement.steps[0].finding
    figure = finding.plot()
    said = " ".join(figure.get_suptitle().split())
    assert said.startswith("load: ") and finding.where[1:] in said
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels[0].startswith("without load: held-out error") and "N m" in labels[0]
    assert labels[1].startswith("with load:") and "%" in labels[1]
    assert finding_figure(finding, headed=False).get_suptitle() == ""


def test_few_rows_are_drawn_one_by_one(improvement: sb.Improvement, steady: sb.Fit) -> None:
    offset = sb.add(steady, "offset", starts=1)
    finding = replace(improvement.steps[0].finding, effect="offset", before=steady, fit=offset)
    axes = finding.plot().axes[0]
    dots = [line for line in axes.get_lines() if line.get_marker() == "."]
    assert len(dots) == 2 and len(dots[0].get_xdata()) == steady.rows.size


def test_an_effect_by_formula_is_drawn_against_velocity(improvement: sb.Improvement) -> None:
    before = improvement.final
    after = sb.add(before, "creep = c*v^3", starts=1)
    finding = replace(improvement.steps[0].finding, effect="creep", before=before, fit=after)
    assert "velocity" in finding.plot().axes[0].get_xlabel()


def test_every_channel_is_of_the_recordings_length_or_absent(
    improvement: sb.Improvement, steady: sb.Fit
) -> None:
    for effect in effects().values():
        made = channel(improvement.final, effect.view.channel)
        assert made is None or made.values.shape == improvement.final.residual.shape
        assert made is None or np.all(np.isfinite(made.values))
        made = channel(steady, effect.view.channel)
        assert made is None or made.values.shape == steady.residual.shape


def test_quartiles_of_bins_of_equal_ratio() -> None:
    x = np.geomspace(1e-3, 1.0, 4000)
    y = np.random.default_rng(0).uniform(0.0, 4.0, x.size)
    at, lower, median, upper = binned_quartiles(x, y, 10, log=True)
    np.testing.assert_allclose(np.diff(np.log(at)), np.diff(np.log(at))[0], rtol=0.02)
    for quartile, share in ((lower, 1.0), (median, 2.0), (upper, 3.0)):
        np.testing.assert_allclose(quartile, share, atol=0.4)
    assert binned_quartiles(np.zeros(500), np.zeros(500))[0].size == 0
