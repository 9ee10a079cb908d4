"""Many starts: where searches set out and end."""

from __future__ import annotations

import numpy as np
import pytest
import stribeck as sb
from stribeck.identify.problem import Problem
from stribeck.identify.scaling import bounds, model_for
from stribeck.identify.search import THOROUGH, search_each
from stribeck.identify.space import SearchSpace
from synthetic import joint, motion, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve."""
    v = motion()[2]
    extra = 1.5 * np.sign(v) * np.exp(-((np.abs(v) / 0.1) ** 2))
    return record(tmp_path_factory.mktemp("search"), joint(extra))


def test_a_start_whose_curve_is_lost_begins_anew(recording: sb.Recording) -> None:
    model = model_for("coulomb+stribeck", recording)
    lower, upper, start = bounds(model, recording)
    problem = Problem(recording, model, np.flatnonzero(recording.moving))
    names = model.names
    speed, height = names.index("stribeck_velocity"), names.index("stribeck_height")
    # Far above the velocity of the curve, and as steep as it may be: the best height is none there.
    far = start.copy()
    far[speed], far[names.index("stribeck_exponent")] = upper[speed], 4.0
    alone = search_each(problem, lower, upper, far[None, :], THOROUGH)[0].search
    assert alone.values[height] == 0.0 and alone.blind
    first, other = search_each(problem, lower, upper, np.stack([start, far]), THOROUGH)
    assert other.search.values[height] > 1.0
    assert other.search.square == pytest.approx(first.search.square, rel=1e-9)


def test_further_on_stays_between_bounds_and_is_never_the_same(recording: sb.Recording) -> None:
    model = model_for("coulomb+stribeck", recording)
    lower, upper, start = bounds(model, recording)
    space = SearchSpace(model, lower, upper)
    speed = model.names.index("stribeck_velocity")
    seen = [start]
    for _ in range(8):
        seen.append(space.further(seen[-1], [speed]))
    speeds = np.array([values[speed] for values in seen])
    assert np.all(speeds >= lower[speed]) and np.all(speeds <= upper[speed])
    assert np.unique(speeds).size == speeds.size
    others = np.delete(np.stack(seen), speed, axis=1)
    np.testing.assert_allclose(others, np.tile(others[0], (9, 1)), rtol=1e-12)
