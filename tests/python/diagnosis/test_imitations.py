"""Friction is not claimed where a cause in the measurement explains as much."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.diagnosis.measurement.other_acceleration import OTHER_ACCELERATION
from stribeck.diagnosis.measurement.table import CAUSES, measurement_columns
from stribeck.diagnosis.plausibility.rules import DEMOTED
from stribeck.diagnosis.trials import imitations
from stribeck.diagnosis.trials.imitations import NARROW
from stribeck.diagnosis.trials.sifting import Sifted
from stribeck.diagnosis.trials.trial import TIE, Trial
from stribeck.effect.describe import is_friction
from synthetic import COULOMB, joint, motion, record

ROWS = 8000


def warmed_up(frame: pl.DataFrame) -> pl.DataFrame:
    """The same behind an amplifier whose gain and zero settle."""
    share = np.linspace(0.0, 1.0, frame.height)
    left = np.exp(-4.0 * share)
    return frame.with_columns(torque=pl.col("torque") * (1 - 0.06 * left) + 0.1 * left)


@pytest.mark.parametrize("seed", [1, 2])
def test_an_amplifier_that_warms_up_is_no_friction(tmp_path: Path, seed: int) -> None:
    recording = record(tmp_path, warmed_up(joint(rows=ROWS, seed=seed)))
    found = sb.diagnose(sb.fit("coulomb+gain", recording))
    assert found.findings[0].effect == "warm_up"
    assert not [f.effect for f in found.findings if is_friction(f.effect)]
    told = [row.reason for row in found.not_claimed] + [str(f.demoted) for f in found.demoted]
    assert any("an amplifier whose gain and zero settle" in reason for reason in told)


def test_drift_of_friction_is_still_found(tmp_path: Path) -> None:
    """Under a load that varies, friction that changes is not a gain that changes."""
    _, _, v, _ = motion(ROWS)
    share = np.linspace(0.0, 1.0, ROWS)
    extra = 0.15 * COULOMB * np.exp(-4.0 * share) * np.sign(v)
    found = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(extra, rows=ROWS))))
    assert found.findings[0].effect == "drift"
    assert found.findings[0].demoted is None


def test_causes_are_columns_on_the_samples_fitted_to(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb+load", plain, starts=1)
    columns = measurement_columns(fit)
    # Most of this load torque is gravity: it shows no acceleration that may be another one.
    present = [cause.what for cause in CAUSES if cause is not OTHER_ACCELERATION]
    assert list(columns) == present
    assert all(made.shape[0] == fit.rows.size for made in columns.values())
    assert all(np.all(np.isfinite(made)) for made in columns.values())


def test_steady_speeds_have_no_time(tmp_path: Path) -> None:
    frame = joint().with_columns(run=pl.Series(np.repeat(np.arange(30), 100)))
    points = record(tmp_path, frame, average="run")
    found = measurement_columns(sb.fit("coulomb", points))
    assert list(found) == ["a torque on a wrong scale", "a torque channel with a step at zero"]


@dataclass(frozen=True)
class Rival:
    """A cause in the measurement that leaves a larger error by so many standard errors.

    It explains a `share` of what an effect does.
    """

    better: float
    share: float = 0.0

    def only(self, what: str) -> Rival:
        return self

    def let_stand(self, *_: object) -> bool:
        """What is added to it is significant."""
        return True

    def advantage(self, trial: Trial) -> float:
        return self.better

    def share_of(self, trial: Trial) -> float:
        return self.share

    @property
    def largest(self) -> str:
        return "a filter"


@pytest.mark.parametrize(
    ("effect", "better", "stands", "most"),
    [
        ("inertia", 1.5, True, 1.0),
        ("inertia", 0.5, False, None),
        ("inertia", -4.0, False, None),
        ("elasticity", 1.5, True, 1.0),
        ("elasticity", 0.5, False, None),
        # A late torque is a cause in the measurement itself.
        ("delay", 0.5, True, 1.0),
    ],
)
def test_what_acts_in_the_joint_predicts_better_than_its_imitations(
    effect: str, better: float, stands: bool, most: float | None
) -> None:
    trial = cast("Trial", SimpleNamespace(effect=effect, is_beyond_band=False))
    sift = imitations._other_judged(Sifted((trial,)), trial, cast("Any", Rival(better)), 1, 0.01)
    assert (trial in sift.stand) is stands
    assert len(sift.demoted) == (0.0 < better < 1.0 and not stands)
    assert len(sift.refused) == (better < -TIE)
    if most is not None:
        assert sift.most.get(effect, 1.0) == most


@pytest.mark.parametrize(
    ("effect", "share", "stands"),
    [
        ("inertia", 0.4, True),
        ("inertia", 0.6, False),
        ("elasticity", 0.4, True),
        ("elasticity", 0.6, False),
        ("delay", 0.6, True),
    ],
)
def test_what_a_load_torque_of_another_acceleration_mostly_explains_is_in_doubt(
    effect: str, share: float, stands: bool
) -> None:
    trial = cast("Trial", SimpleNamespace(effect=effect, is_beyond_band=False))
    rival = cast("Any", Rival(3.0, share))
    sift = imitations._other_judged(Sifted((trial,)), trial, rival, 1, 0.01)
    assert (trial in sift.stand) is stands
    assert [row.trial for row in sift.demoted] == ([] if stands else [trial])


@pytest.mark.parametrize(
    ("better", "most"), [(1.5, 1.0), (0.5, NARROW), (-1.5, NARROW), (-2.5, DEMOTED)]
)
def test_a_drive_train_is_no_surer_than_all_causes_together_leave_it(
    better: float, most: float
) -> None:
    trial = SimpleNamespace(effect="elasticity", is_beyond_band=False)
    rival = cast("Any", Rival(better))
    assert imitations._most_certain(cast("Trial", trial), rival) == most
    trial.is_beyond_band = True
    assert imitations._most_certain(cast("Trial", trial), rival) == DEMOTED
