"""`stribeck plot`: every figure, its width, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from as_user import answer, stribeck
from stribeck.report.plots.draw import FIGURES

MM = 25.4


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A warming joint that reverses often."""
    t = np.arange(6000) / 100.0
    v = 0.6 * np.sin(1.3 * t) * (1.0 + 0.4 * np.sin(0.21 * t))
    temperature = 25.0 + 15.0 * (1.0 - np.exp(-t / 20.0))
    friction = np.sign(v) * 4.0 + v * (3.0 - 0.05 * (temperature - 25.0))
    position = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1])) / 100.0])
    load = 5.0 * np.sin(position) + 0.3 * np.gradient(v, t)
    noise = 0.05 * np.random.default_rng(2).standard_normal(t.size)
    frame = pl.DataFrame(
        {
            "time": t,
            "position": position,
            "velocity": v,
            "temperature": temperature,
            "load_torque": load,
            "torque": friction + load + noise,
        }
    )
    made = tmp_path_factory.mktemp("plots") / "joint.parquet"
    frame.write_parquet(made)
    return made


@pytest.fixture(scope="module")
def fits(path: Path) -> list[sb.Fit]:
    recording = sb.read(path)
    return [sb.fit(spec, recording, starts=1) for spec in ("coulomb", "coulomb+presliding")]


@pytest.mark.parametrize("what", FIGURES)
@pytest.mark.parametrize(("width", "mm"), [("single", 88.0), ("double", 180.0), (120, 120.0)])
def test_each_figure_has_the_width_asked_for(fits, what, width, mm) -> None:
    figure = sb.plot(fits[0].recording, fits, what, width=width)
    assert figure.get_size_inches()[0] * MM == pytest.approx(mm)
    for axes in figure.axes:
        assert axes.get_ylabel().endswith("]"), "an axis without a unit"
        assert all(label.get_fontsize() >= 7.0 for label in axes.get_xticklabels())
    (legend,) = figure.legends
    named = [text.get_text() for text in legend.get_texts()]
    assert named[-2:] == ["coulomb", "coulomb+presliding"]


def test_friction_over_velocity_is_the_model_and_the_data(fits) -> None:
    """The curve is the law; the dots are torque minus load."""
    figure = sb.plot(fits[0].recording, fits[0])
    lines = figure.axes[0].lines
    curve = next(line for line in lines if np.isnan(np.asarray(line.get_xdata())).any())
    x, y = np.asarray(curve.get_xdata()), np.asarray(curve.get_ydata())
    known = np.isfinite(x)
    np.testing.assert_allclose(y[known], fits[0].model.torque(x[known]))
    dots = next(line for line in lines if len(line.get_xdata()) == 3000)
    r = fits[0].recording
    rows = np.searchsorted(np.sort(r.velocity), np.asarray(dots.get_xdata()))
    order = np.argsort(r.velocity)
    np.testing.assert_allclose(dots.get_ydata(), (r.torque - r.load_torque)[order][rows])


def test_an_identified_rigid_body_is_no_friction(path: Path) -> None:
    """Without a load in the recording, inertia and gravity are taken off the measured torque."""
    recording = sb.read(path, map=["load_torque=none"])
    fitted = sb.fit("coulomb", recording, starts=1)
    figure = sb.plot(recording, fitted, "time")
    assert len(figure.axes) == 2
    shown = np.asarray(figure.axes[1].lines[1].get_ydata())
    assert np.abs(recording.torque).max() > 8.0 > 7.0 > np.abs(shown).max()


def test_a_published_set_is_drawn_as_it_is(path: Path, tmp_path: Path) -> None:
    target = tmp_path / "figure.pdf"
    named = "published:ur5e_review/table_7/joint_1/coulomb"
    made = answer("plot", path, named, "--what", "time", "-o", target, "--width", "120")
    assert made["models"] == ["coulomb"] and made["width_mm"] == 120.0
    assert target.read_bytes().startswith(b"%PDF")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--what", "loops"), "'loops' is not one of"),
        (("--width", "3"), "single, double, or 40 to 400 mm"),
        (("-o", "figure.gif"), "its name must end in"),
    ],
)
def test_mistakes(path: Path, tmp_path: Path, words: tuple[str, ...], sentence: str) -> None:
    done = stribeck("plot", path, "coulomb", "-o", tmp_path / "a.png", *words)
    assert done.returncode == 2 and not done.stdout
    assert sentence in done.stderr


def test_a_channel_that_is_missing_is_named(path: Path) -> None:
    recording = sb.read(path, map=["temperature=none"])
    with pytest.raises(sb.SpecError, match="has no temperature that varies"):
        sb.plot(recording, "coulomb", "residual-temperature")


def test_steady_points_have_no_time(path: Path) -> None:
    points = sb.read(path, average="row", map=["time=none"])
    for what in ("time", "hysteresis", "warm-up", "spectrum"):
        with pytest.raises(sb.SpecError, match="steady-state points"):
            sb.plot(points, sb.model("coulomb", coulomb_friction=4.0, viscous_friction=2.0), what)


@pytest.mark.parametrize("effect", ["backlash", "delay", "position", "offset"])
def test_models_whose_friction_is_no_curve_are_drawn_as_dots(path: Path, effect: str) -> None:
    recording = sb.read(path)
    figure = sb.plot(recording, sb.fit(f"coulomb+{effect}", recording, starts=1))
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert named == ["measured", f"coulomb+{effect}"]


def test_of_two_models_alike_the_stored_one_is_named(fits) -> None:
    stored = sb.model("coulomb", coulomb_friction=4.0, viscous_friction=3.0)
    figure = sb.plot(fits[0].recording, [fits[0], stored], "residual-velocity")
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert named == ["coulomb", "coulomb, not refitted"]
    other = sb.model("coulomb", coulomb_friction=3.0, viscous_friction=3.0)
    figure = sb.plot(fits[0].recording, [stored, other], "residual-velocity")
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert named == ["coulomb, not refitted (1)", "coulomb, not refitted (2)"]
    recording = fits[0].recording
    text = str(sb.compare([sb.evaluate(m, recording) for m in (stored, other)], recording))
    assert "coulomb, not refitted (1)" in text and "coulomb, not refitted (2)" in text


def test_the_spectrum_is_that_of_the_scored_samples() -> None:
    """Its integral is the squared error of the model, though the torque at rest is not modelled."""
    t = np.arange(8000) / 100.0
    v = np.where(np.sin(2 * np.pi * t / 7) > 0.5, 0.0, np.sin(2 * np.pi * t))
    noise = 0.1 * np.random.default_rng(0).standard_normal(t.size)
    torque = np.where(v == 0.0, 20.0, 3.0 * np.sign(v) + v) + noise
    recording = sb.Recording.from_columns(time=t, velocity=v, torque=torque)
    fit = sb.fit("coulomb", recording, starts=1)
    _, line = sb.plot(recording, [fit], "spectrum").axes[0].get_lines()
    frequency, density = line.get_xdata(), line.get_ydata()
    square = float(np.sum(density**2) * (frequency[1] - frequency[0]))
    assert square == pytest.approx(fit.rmse**2, rel=0.2)
