"""Order and confidence of findings, against their definitions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.plausibility.rules import DEMOTED
from stribeck.diagnosis.residual.noise_floor import NoiseFloor
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.ranking import MATERIAL, ranked, share_of_unexplained
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import Trial, tie_statistic, tie_weight
from synthetic import joint, motion, record

TRIED, LEAST = 20, 0.02


@dataclass(frozen=True)
class Error:
    """A result with a held-out error alone."""

    rmse_held_out: float | None


@pytest.mark.parametrize(
    ("before", "after", "floor", "expected"),
    [
        (5.0, 4.0, 3.0, 9.0 / 16.0),
        (5.0, 3.0, 3.0, 1.0),
        (5.0, 2.0, 3.0, 1.0),
        (5.0, 6.0, 3.0, 0.0),
        (3.0, 2.0, 3.0, 0.0),
        (2.0, 1.0, 3.0, 0.0),
        (5.0, 4.0, None, None),
        (None, 4.0, 3.0, None),
        (5.0, None, 3.0, None),
    ],
)
def test_share_of_what_is_above_the_floor(
    before: float | None, after: float | None, floor: float | None, expected: float | None
) -> None:
    found = share_of_unexplained(Error(before), Error(after), NoiseFloor(floor))
    assert found == (None if expected is None else pytest.approx(expected))


def test_weight_of_a_tie_is_its_two_sided_probability() -> None:
    assert tie_weight(0.0) == 1.0
    assert tie_weight(1.959964) == tie_weight(-1.959964) == pytest.approx(0.05, rel=1e-6)


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> tuple[sb.Fit, dict[str, Trial]]:
    """An offset of 0.3 N m and a friction that grows with the load."""
    load, v = joint()["load_torque"].to_numpy(), motion()[2]
    folder: Path = tmp_path_factory.mktemp("ranking")
    before = sb.fit("coulomb", record(folder, joint(0.3 + 0.05 * np.abs(load) * np.sign(v))))
    made = {}
    for effect in ("offset", "load", "direction", "temperature_dry"):
        after = sb.fit(f"coulomb+{effect}", before.recording)
        made[effect] = Trial(effect, after, evidence(before, after))
    return before, made


def floor_of(before: sb.Fit, share: float) -> NoiseFloor:
    """A noise floor at this share of the squared held-out error."""
    assert before.rmse_held_out is not None
    return NoiseFloor(before.rmse_held_out * share**0.5)


def test_the_best_comes_first_with_its_confidence(case: tuple[sb.Fit, dict[str, Trial]]) -> None:
    before, trials = case
    best, second = trials["offset"], trials["load"]
    assert best.evidence.fall > second.evidence.fall > 0.0
    floor = floor_of(before, 0.1)
    found = ranked(before, Sifted((best, second)), TRIED, LEAST, floor, 0)
    assert [f.effect for f in found.findings] == ["offset", "load"]
    first, other = found.findings
    # The second explains something else: it is no tie, and weighs by its distance.
    assert first.indistinguishable_from == () and other.indistinguishable_from == ()
    assert first.confidence == pytest.approx(1.0 - min(1.0, TRIED * best.evidence.p_value))
    weight = tie_weight(tie_statistic(best, second))
    chance = min(1.0, TRIED * second.evidence.p_value)
    assert other.confidence == pytest.approx((1.0 - chance) * weight / (1.0 + weight), abs=1e-12)
    for finding, trial in ((first, best), (other, second)):
        assert finding.rmse_held_out_before == before.rmse_held_out
        assert finding.rmse_held_out_after == pytest.approx(trial.fit.rmse_held_out)
        expected = share_of_unexplained(before, trial.fit, floor)
        assert finding.share_of_unexplained == pytest.approx(expected)
        assert finding.before is before and finding.where
    assert found.demoted == () and found.not_claimed == ()


def test_what_the_thorough_fit_does_not_confirm_is_dropped(
    case: tuple[sb.Fit, dict[str, Trial]],
) -> None:
    """The first falls by less than is asked: the next is asked, and so on."""
    before, trials = case
    sift, floor = Sifted((trials["load"], trials["offset"])), floor_of(before, 0.1)
    between = 0.5 * (trials["load"].evidence.fall + trials["offset"].evidence.fall)
    found = ranked(before, sift, TRIED, between, floor, 0)
    assert [finding.effect for finding in found.findings] == ["offset"]
    assert ranked(before, sift, TRIED, 0.999, floor, 0).findings == ()


def test_nothing_is_told_that_explains_next_to_nothing(
    case: tuple[sb.Fit, dict[str, Trial]],
) -> None:
    """Where the floor is far below the error, an effect that is not there is not even demoted."""
    before, trials = case
    absent = trials["temperature_dry"]
    assert before.rmse_held_out is not None and absent.fit.rmse_held_out is not None
    assert 1.0 - (absent.fit.rmse_held_out / before.rmse_held_out) ** 2 < MATERIAL
    sift = Sifted((), (Doubted(absent, "narrow"), Doubted(trials["load"], "narrow")))
    told = ranked(before, sift, TRIED, LEAST, NoiseFloor(0.0), 0).demoted
    assert [finding.effect for finding in told] == ["load"]
    # Where the floor is unknown, so is the share.
    told = ranked(before, sift, TRIED, LEAST, NoiseFloor(None), 0).demoted
    assert [finding.effect for finding in told] == ["temperature_dry", "load"]
    assert told[0].confidence == 0.0 and told[0].share_of_unexplained is None


def test_an_effect_beside_vibration_is_material_in_the_band_of_the_motion(
    case: tuple[sb.Fit, dict[str, Trial]],
) -> None:
    """Two per cent of the whole error, but ten of the error where friction acts, and not four."""
    before, trials = case
    assert before.rmse_held_out is not None
    slight = replace(trials["load"].fit, rmse_held_out=0.99 * before.rmse_held_out)

    def told(in_band: float) -> list[str]:
        seen = replace(trials["load"].evidence, fall_in_band=1.0 - (1.0 - in_band) ** 0.5)
        doubted = Doubted(Trial("load", slight, seen), "weak")
        made = ranked(before, Sifted((), (doubted,)), TRIED, LEAST, NoiseFloor(0.0), 0)
        return [finding.effect for finding in made.demoted]

    assert told(0.1) == ["load"]
    assert told(0.04) == []


def test_what_is_demoted_is_told_with_its_reason(case: tuple[sb.Fit, dict[str, Trial]]) -> None:
    before, trials = case
    offset, load = trials["offset"], trials["load"]
    floor = floor_of(before, 0.1)
    alone = ranked(before, Sifted((), (Doubted(offset, "too few"),)), TRIED, LEAST, floor, 0)
    assert alone.findings == ()
    (told,) = alone.demoted
    assert told.effect == "offset" and told.demoted == "too few"
    assert 0.0 < told.confidence <= 0.5 and told.indistinguishable_from == ()
    beside = ranked(before, Sifted((offset,), (Doubted(load, "weak"),)), TRIED, LEAST, floor, 0)
    assert [f.effect for f in beside.findings] == ["offset"]
    (told,) = beside.demoted
    weight = tie_weight(tie_statistic(offset, load))
    assert told.effect == "load" and told.confidence == pytest.approx(
        min(0.5, weight / (1.0 + weight)), abs=1e-12
    )


def test_sifted_trials_keep_their_order(case: tuple[sb.Fit, dict[str, Trial]]) -> None:
    before, trials = case
    every = Sifted.of(before, [trials["offset"], trials["load"]], LEAST)
    assert every.stand == (trials["offset"], trials["load"]) and every.demoted == ()
    weak = Doubted(trials["direction"], "weak")
    known = Sifted(every.stand, (weak,))
    assert known.with_stand([trials["load"]]) == Sifted((trials["load"],), (weak,))
    again = Doubted(trials["offset"], "few events")
    rest = known.instead(trials["offset"], Sifted((), (again,)))
    assert rest == Sifted((trials["load"],), (weak, again))


def test_a_wider_effect_is_as_likely_as_the_simpler_one_that_does_nearly_as_much(
    tmp_path: Path,
) -> None:
    """A load dependence that hardly differs between motoring and generating."""
    load, v = joint()["load_torque"].to_numpy(), motion()[2]
    extra = 0.2 * np.abs(load) * np.sign(v) * (1.0 + 0.3 * (v * load > 0.0))
    before = sb.fit("coulomb", record(tmp_path, joint(extra)))
    trials = []
    for effect, spec in (("quadrant", "coulomb+load+quadrant"), ("load", "coulomb+load")):
        after = sb.fit(spec, before.recording)
        trials.append(Trial(effect, after, evidence(before, after)))
    wider, simpler = trials
    assert tie_statistic(wider, simpler) > 3.0
    found = ranked(before, Sifted((wider, simpler)), TRIED, LEAST, floor_of(before, 0.1), 0)
    first = next(f for f in found.findings if f.effect == "quadrant")
    assert first.indistinguishable_from == ("load",)
    assert first.confidence == DEMOTED
