"""What an effect in doubt explains is not claimed of another friction effect."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.diagnosis.trials import outshone
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.outshone import without_outshone, without_unresolved
from stribeck.diagnosis.trials.sifting import Doubted, Sifted
from stribeck.diagnosis.trials.trial import Trial
from synthetic import joint, motion, record

ROWS = 4000


def demoted(folder: Path, by_position: float) -> list[str]:
    """What is demoted of position, where friction depends on load and the load is in doubt."""
    _, q, v, _ = motion(ROWS)
    load = joint(rows=ROWS)["load_torque"].to_numpy()
    extra = (0.3 * np.abs(load) + by_position * np.cos(2.0 * q)) * np.sign(v)
    before = sb.fit("coulomb", record(folder, joint(extra, rows=ROWS)))
    trials = {}
    for effect in ("load", "position"):
        after = sb.fit(f"coulomb+{effect}", before.recording, starts=2)
        trials[effect] = Trial(effect, after, evidence(before, after))
    stood = Sifted((trials["load"], trials["position"]))
    sift = Sifted((trials["position"],), (Doubted(trials["load"], "a torque on a wrong scale"),))
    left = without_outshone(stood, sift, 20, 0.01, 0)
    assert [t.effect for t in left.stand] == [] or left == sift
    return [row.reason for row in left.demoted if row.trial.effect == "position"]


@pytest.mark.parametrize(("by_position", "leaves"), [(0.0, "nothing"), (0.1, "something")])
def test_friction_that_adds_nothing_to_what_predicts_better(
    tmp_path: Path, by_position: float, leaves: str
) -> None:
    reasons = demoted(tmp_path, by_position)
    wanted = ["load predicts better, and leaves nothing to it"] if leaves == "nothing" else []
    assert reasons == wanted


@pytest.mark.parametrize(
    ("lag", "slow", "demotes"), [(0.05, 0.3, False), (1e-3, 0.3, True), (0.05, 30.0, False)]
)
def test_what_acts_beyond_reach_outshines_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lag: float, slow: float, demotes: bool
) -> None:
    """A lag below a sample shows that something acts there; a speed never reached shows nothing."""
    before = sb.fit("coulomb", record(tmp_path, joint(0.2 * motion(ROWS)[3], rows=ROWS)))
    inertia = sb.fit("coulomb+inertia", before.recording, starts=1)
    late = sb.fit("coulomb+stribeck+frictional_lag", before.recording, starts=1)
    values = {
        **dict(zip(late.model.names, late.model.values, strict=True)),
        "frictional_lag": lag,
        "stribeck_velocity": slow,
        "stribeck_exponent": 1.0,
    }
    late = replace(late, model=late.model.with_values(list(values.values())))
    right, better = (
        Trial(effect, fit, evidence(before, inertia))
        for effect, fit in (("inertia", inertia), ("frictional_lag", late))
    )
    monkeypatch.setattr(outshone, "tie_statistic", lambda *_: 99.0)
    monkeypatch.setattr(outshone, "adds_to", lambda *_: False)
    sift = Sifted((right,), refused=(Doubted(better, "impossible"),))
    left = without_unresolved(before, sift, 20, 0.01, 0)
    assert [row.trial.effect for row in left.demoted] == (["inertia"] if demotes else [])
