"""An effect that may not be claimed is an alternative all the same: it lowers the confidence."""

from __future__ import annotations

from pathlib import Path

import pytest
import stribeck as sb
from stribeck.diagnosis.residual.noise_floor import noise_floor
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.ranking import OUTSIDE_THE_BAND, ranked
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import TIE, Trial, tie_statistic
from synthetic import joint, motion, record


@pytest.mark.parametrize("how", ["demoted", "refused", "rivals"])
def test_an_effect_that_predicts_as_well_lowers_the_confidence(tmp_path: Path, how: str) -> None:
    before = sb.fit("coulomb", record(tmp_path, joint(0.5)), starts=1)
    after = sb.add(before, "offset", starts=1)
    trial = Trial("offset", after, evidence(before, after))
    # Another effect with the same torque, and one more parameter, that breaks a rule or gains
    # outside the band of the motion alone.
    wider = sb.add(before, "direction", starts=1)
    rival = Trial("direction", wider, evidence(before, wider))
    other = rival if how == "rivals" else Doubted(rival, "a reason")
    floor = noise_floor(after)

    def confidence(sift: Sifted) -> tuple[float, tuple[str, ...]]:
        (first,) = ranked(before, sift, 20, 0.01, floor, 0).findings
        return first.confidence, first.indistinguishable_from

    assert confidence(Sifted((trial,))) == (pytest.approx(1.0, abs=1e-3), ())
    value, names = confidence(Sifted((trial,), **{how: (other,)}))
    assert 0.45 < value < 0.9 and names == ("direction",)


def test_an_impossible_effect_with_the_same_torque_is_no_alternative(tmp_path: Path) -> None:
    """Friction of 100 N m more in one direction would be negative in the other."""
    before = sb.fit("coulomb", record(tmp_path, joint(100.0)), starts=1)
    (first,) = sb.diagnose(before).findings
    assert first.effect == "offset" and first.confidence > 0.99
    assert first.indistinguishable_from == ()


def test_what_a_torque_contains_comes_first_where_it_explains_nearly_as_much(
    tmp_path: Path,
) -> None:
    """A spring has a mean, which is an offset: most of its torque here."""
    position = motion()[1]
    recording = record(tmp_path, joint(20.0 + 0.3 * position**3))
    assert sb.diagnose(sb.fit("coulomb", recording, starts=1)).findings[0].effect == "offset"
    found = sb.improve("coulomb", recording)
    assert [step.finding.effect for step in found.steps] == ["offset", "spring"]


def test_a_much_worse_rival_is_not_named(tmp_path: Path) -> None:
    before = sb.fit("coulomb", record(tmp_path, joint(0.5)), starts=1)
    after = sb.add(before, "offset", starts=1)
    trial = Trial("offset", after, evidence(before, after))
    other = sb.add(before, "position", starts=1)
    rival = Trial("position", other, evidence(before, other))
    assert tie_statistic(trial, rival) > TIE
    sift = Sifted((trial,), demoted=(Doubted(rival, "a reason"),))
    (first,) = ranked(before, sift, 20, 0.01, noise_floor(after), 0).findings
    assert first.indistinguishable_from == ()


@pytest.mark.parametrize("stands", [False, True])
def test_what_gains_outside_the_band_is_named_where_nothing_stands(
    tmp_path: Path, stands: bool
) -> None:
    before = sb.fit("coulomb", record(tmp_path, joint(0.5)), starts=1)
    after = sb.add(before, "offset", starts=1)
    trial = Trial("offset", after, evidence(before, after))
    sift = Sifted((trial,) if stands else (), rivals=(trial,))
    found = ranked(before, sift, 20, 0.01, noise_floor(after), 0)
    reasons = [(row.effect, row.demoted) for row in found.demoted]
    assert reasons == ([] if stands else [("offset", OUTSIDE_THE_BAND)])
    assert bool(found.findings) == stands
