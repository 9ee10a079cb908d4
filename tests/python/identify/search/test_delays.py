"""A delay has a minimum near each sample: a fit finds the least of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy
import stribeck as sb
from stribeck.identify.search.delays import error_across_minima
from stribeck.identify.search.separable import Search
from stribeck.motion.generate.hidden import generate

RATE, TIME_CONSTANT = 250.0, 0.005


@pytest.fixture(scope="module")
def recording() -> sb.Recording:
    """A joint with an unknown inertia whose torque is behind a filter of first order."""
    frame, _ = generate(["inertia"], seconds=40.0, rate=RATE, seed=2)
    torque = frame["torque"].to_numpy()
    share = 1.0 - np.exp(-1.0 / (TIME_CONSTANT * RATE))
    behind = scipy.signal.lfilter([share], [1.0, share - 1.0], torque - torque[0]) + torque[0]
    return sb.read(frame.with_columns(torque=behind))


def error(found: sb.Fit) -> float:
    """The error over the samples fitted to, N m."""
    return float(np.sqrt(np.mean(found.residual[found.rows] ** 2)))


def test_the_minimum_does_not_depend_on_the_start(recording: sb.Recording) -> None:
    found = [
        sb.fit("coulomb+inertia+delay", recording, starts=1, start={"delay": start})
        for start in (0.0, 0.008, 0.016)
    ]
    errors = [error(one) for one in found]
    assert max(errors) == pytest.approx(min(errors), rel=1e-6)
    held = [
        error(sb.fit("coulomb+inertia+delay", recording, starts=1, fix={"delay": delay}))
        for delay in np.arange(0.0, 0.012, 0.001).tolist()
    ]
    assert min(errors) <= min(held)


def test_steady_points_show_no_delay() -> None:
    velocity = np.tile(np.linspace(-2.0, 2.0, 40), 6)
    points = sb.Recording.from_columns(
        velocity=velocity,
        torque=2.0 * np.sign(velocity) + 0.3 * velocity,
        joint_kind="revolute",
        average="row",
    )
    assert sb.fit("coulomb+delay", points, starts=2).rmse < 1e-9


def ended(delay: float, square: float) -> Search:
    return Search(np.array([1.0, delay]), square, True, "", 1)


@pytest.mark.parametrize(
    ("others", "error"),
    [
        ((), 0.1),
        # The same minimum.
        ((ended(0.51, 100.001),), 0.1),
        # Another one that fits as well, and one that is two standard errors worse.
        ((ended(1.5, 100.5),), 1.0),
        ((ended(1.5, 104.0),), 0.5),
        ((ended(1.5, 100.5), ended(4.5, 101.0)), 4.0),
    ],
)
def test_the_error_reaches_other_minima_that_fit_as_well(
    others: tuple[Search, ...], error: float
) -> None:
    found = replace(ended(0.5, 100.0), others=others)
    assert error_across_minima(1, found, found.values, 0.1, 1.0) == pytest.approx(error)
