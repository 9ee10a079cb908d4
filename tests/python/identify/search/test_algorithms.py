"""nlopt's algorithms in place of Gauss-Newton steps."""

from __future__ import annotations

import pytest
import stribeck as sb
from stribeck.fitting.methods.grid import grid_fit
from stribeck.identify.search.algorithms import ALGORITHMS, GAUSS_NEWTON, GLOBAL, LOCAL
from synthetic import joint_with_stribeck_curve, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with a Stribeck curve."""
    return record(tmp_path_factory.mktemp("algorithms"), joint_with_stribeck_curve(2000))


@pytest.fixture(scope="module")
def expected(recording: sb.Recording) -> sb.Fit:
    return sb.fit("bittencourt_a", recording)


@pytest.mark.parametrize("name", [*LOCAL, *GLOBAL])
def test_every_algorithm_finds_the_minimum(
    recording: sb.Recording, expected: sb.Fit, name: str
) -> None:
    found = sb.fit("bittencourt_a", recording, algorithm=name, starts=6)
    assert found.rmse == pytest.approx(expected.rmse, rel=1e-9)
    assert found.to_dict()["algorithm"] == name
    assert ("by " + name) in repr(found) or found.starts == 1


def test_the_same_seed_gives_the_same_bits(recording: sb.Recording) -> None:
    for name in ("crs2", "slsqp"):
        one, other = (sb.fit("bittencourt_a", recording, algorithm=name, starts=4) for _ in "ab")
        assert one.model.values.tobytes() == other.model.values.tobytes()


def test_a_formula_without_bounds_is_searched(recording: sb.Recording) -> None:
    law = "c1*v + c2*tanh(v/c3)"
    expected = sb.fit(law, recording)
    found = sb.fit(law, recording, algorithm="slsqp", starts=4)
    assert found.rmse == pytest.approx(expected.rmse, rel=1e-6)


def test_an_unknown_algorithm_is_refused_by_name(recording: sb.Recording) -> None:
    with pytest.raises(sb.SpecError, match="unknown algorithm 'slsq'; did you mean 'slsqp'"):
        sb.fit("coulomb", recording, algorithm="slsq")


def test_an_algorithm_stays_in_force_when_effects_are_added(recording: sb.Recording) -> None:
    before = sb.fit("coulomb", recording, algorithm="lbfgs")
    after = sb.add(before, "stribeck", recording)
    assert after.to_dict()["algorithm"] == "lbfgs"
    assert after.rmse == pytest.approx(sb.fit("coulomb+stribeck", recording).rmse, rel=1e-6)


def test_a_method_without_a_search_takes_no_algorithm(recording: sb.Recording) -> None:
    model = sb.fit("bittencourt_a", recording, algorithm="slsqp", starts=1).model
    with pytest.raises(sb.SpecError, match="the method 'grid' does not search"):
        grid_fit(model, recording)


def test_the_report_of_the_starts(expected: sb.Fit) -> None:
    row = expected.to_dict()
    assert row["algorithm"] == GAUSS_NEWTON and GAUSS_NEWTON in ALGORITHMS
    assert 1 <= row["starts_at_minimum"] <= row["starts"] == 20
    assert 0.0 <= row["new_place_probability"] <= 1.0
