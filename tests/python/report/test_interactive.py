"""The interactive figures: shared samples, exact extremes, units on every axis."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from bokeh.models import LinearAxis
from bokeh.plotting import figure
from stribeck.report.interactive.correlation import correlation
from stribeck.report.interactive.decimate import drawn_rows
from stribeck.report.interactive.falling_error import falling_error
from stribeck.report.interactive.findings import findings
from stribeck.report.interactive.friction_velocity import friction_velocity
from stribeck.report.interactive.hysteresis import hysteresis
from stribeck.report.interactive.intervals import intervals
from stribeck.report.interactive.residual_channel import residual_channel
from stribeck.report.interactive.samples import Samples, samples_of
from stribeck.report.interactive.time import residual_time, time
from stribeck.report.pages.account import of_improvement
from stribeck.report.pages.figures import account_plots


@pytest.fixture(scope="module")
def samples(improvement: sb.Improvement) -> Samples:
    return samples_of([improvement.base, improvement.final], most=600)


def of_samples(samples: Samples) -> list[figure]:
    against = [residual_channel(samples, name) for name in samples.labels]
    first = time(samples)
    return [
        first,
        residual_time(samples, x_range=first.x_range),
        friction_velocity(samples),
        hysteresis(samples),
        *against,
    ]


def test_figures_of_samples_share_one_source(samples: Samples) -> None:
    for plot in of_samples(samples):
        assert any(shown.data_source is samples.source for shown in plot.renderers)


def test_a_selection_is_marked_in_the_evidence(improvement: sb.Improvement) -> None:
    account = of_improvement(improvement)
    plots = account_plots(account)
    shared = plots["time"].renderers[0].data_source
    assert account.steps
    for k, step in enumerate(account.steps, 1):
        dots = [r for r in plots[f"step {k}"].renderers if r.data_source is shared]
        assert [r.glyph.fill_color for r in dots] == [None, None]
        assert len({r.selection_glyph.fill_color for r in dots} - {None}) == 2
        drawn, rows = shared.data[f"step {k} without"], shared.data["row"]
        known = np.isfinite(drawn)
        assert np.array_equal(np.unique(rows[known]), np.intersect1d(rows, step.before.rows))
        size = np.abs(step.before.residual[rows[known]])
        assert np.allclose(np.abs(drawn[known]), size, rtol=1e-5)


def test_every_axis_has_a_unit_or_names(samples: Samples, improvement: sb.Improvement) -> None:
    found = [step.finding for step in improvement.steps]
    others = [
        findings(found, improvement.noise_floor.value),
        falling_error(["coulomb", "+ load"], [0.5, 0.2], "N m", noise_floor=0.1),
        intervals(improvement.final.estimates.values()),
    ]
    for plot in (*of_samples(samples), *others):
        for axis in plot.select(LinearAxis):
            assert "[" in (axis.axis_label or "") or axis.major_label_overrides
    assert improvement.final.correlation is not None
    square = correlation(improvement.final.correlation)
    assert square.yaxis[0].major_label_overrides[0] == "viscous friction"


def test_drawn_samples_keep_the_extremes(samples: Samples) -> None:
    drawn = samples.source.data
    assert drawn["row"].size <= 600 < samples.rows
    residual = samples.columns["residual_1"]
    for extreme in (np.nanmin(residual), np.nanmax(residual)):
        assert np.nanmin(np.abs(drawn["residual_1"] - extreme)) < 1e-5 * abs(extreme)


def test_a_zoomed_window_is_exact(samples: Samples) -> None:
    start, stop = samples.within(10.0, 12.0)
    part = samples.data(start, stop, most=600)
    assert np.array_equal(part["row"], np.arange(start, stop))
    assert part["time"][0] <= 10.0 and part["time"][-1] >= 12.0


def test_no_sample_is_drawn_twice_or_lost_at_the_end() -> None:
    values = np.random.default_rng(0).standard_normal(10_007)
    values[3] = np.nan
    values[10_006] = 9.0
    rows = drawn_rows([values, -values], 1, 10_007, most=500)
    assert rows.size <= 500 and np.all(np.diff(rows) > 0)
    assert rows[0] == 1 and rows[-1] == 10_006


def test_steady_state_points_are_drawn(steady: sb.Fit) -> None:
    samples = samples_of([steady])
    assert time(samples).xaxis[0].axis_label == "velocity [rad/s]"
    assert friction_velocity(samples).renderers
