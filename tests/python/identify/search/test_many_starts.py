"""Many starts: where searches set out and end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import stribeck as sb
from searched import problem_of
from stribeck.identify.search.effort import QUICK, THOROUGH
from stribeck.identify.search.finish import finished
from stribeck.identify.search.many_starts import _searched, multi_start
from stribeck.identify.search.separable import Search
from synthetic import joint_with_stribeck_curve, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve."""
    return record(tmp_path_factory.mktemp("search"), joint_with_stribeck_curve())


def test_a_start_whose_curve_is_lost_begins_anew(recording: sb.Recording) -> None:
    problem, space, start = problem_of(recording, "coulomb+stribeck")
    names = problem.model.names
    speed, height = names.index("stribeck_velocity"), names.index("stribeck_height")
    # Far above the velocity of the curve, and as steep as it may be: the best height is none there.
    far = start.copy()
    far[speed], far[names.index("stribeck_exponent")] = space.upper[speed], 4.0
    alone = _searched(problem, far[None, :], space, THOROUGH)[0]
    assert alone.values[height] == 0.0 and alone.blind
    first, other = _searched(problem, np.stack([start, far]), space, THOROUGH)
    assert other.values[height] > 1.0
    assert other.square == pytest.approx(first.square, rel=1e-6)


def test_further_on_stays_between_bounds_and_is_never_the_same(recording: sb.Recording) -> None:
    problem, space, start = problem_of(recording, "coulomb+stribeck")
    speed = problem.model.names.index("stribeck_velocity")
    seen = [start]
    for _ in range(8):
        seen.append(space.further(seen[-1], [speed]))
    speeds = np.array([values[speed] for values in seen])
    assert np.all(speeds >= space.lower[speed]) and np.all(speeds <= space.upper[speed])
    assert np.unique(speeds).size == speeds.size
    others = np.delete(np.stack(seen), speed, axis=1)
    np.testing.assert_allclose(others, np.tile(others[0], (9, 1)), rtol=1e-12)


@pytest.mark.parametrize("law", ["bittencourt_a", "lugre"])
def test_every_start_has_an_end_and_the_best_is_the_least(
    recording: sb.Recording, law: str
) -> None:
    problem, space, start = problem_of(recording, law)
    every = np.ones(start.size, dtype=bool)
    found = multi_start(problem, space.lower, space.upper, start, every, 12, 0, THOROUGH)
    assert len(found.ends) == 12 and 1 <= found.report.at_minimum <= 12
    finished = [end.search.square for end in found.ends if end.finished]
    assert found.search.square <= min(finished) * (1.0 + 1e-9)
    new = found.report.new_place
    assert new is not None and 0.0 <= new <= 1.0
    assert all(found.ends[end.leader].leader == end.leader for end in found.ends)
    assert found.evaluations == sum(end.evaluations for end in found.ends)


def test_a_search_from_nearby_has_one_end(recording: sb.Recording) -> None:
    problem, space, start = problem_of(recording, "bittencourt_a")
    every = np.ones(start.size, dtype=bool)
    found = multi_start(problem, space.lower, space.upper, start, every, 1, 0, QUICK)
    assert len(found.ends) == 1 and found.report.new_place is None and found.report.at_minimum == 1


def test_ends_of_a_model_with_a_state_are_compared_on_all_samples(recording: sb.Recording) -> None:
    """The end that is best on few samples has lost its curve, which all samples show."""
    problem, space, start = problem_of(recording, "coulomb+stribeck+presliding")
    names = problem.model.names
    lost = start.copy()
    lost[names.index("stribeck_velocity")] = space.upper[names.index("stribeck_velocity")]
    lost[names.index("stribeck_exponent")] = space.upper[names.index("stribeck_exponent")]
    tried = [Search(lost, 1.0, True, "", 1), Search(start, 2.0, True, "", 1)]
    found = finished(problem, space, tried, replace(THOROUGH, finished=1))
    assert found.search is found.ends[1].search and not found.ends[0].finished
    assert found.search.values[names.index("stribeck_height")] > 0.1
    assert found.evaluations == sum(end.evaluations for end in found.ends)
