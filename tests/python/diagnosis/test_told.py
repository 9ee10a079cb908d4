"""What is told while candidates are fitted."""

from __future__ import annotations

import numpy as np
import stribeck as sb
from stribeck.diagnosis.trials.screening import screened
from stribeck.diagnosis.trials.told import Told
from stribeck.diagnosis.trials.trial import try_effect
from synthetic import joint, motion, record


def test_count_best_and_time_left(tmp_path: object) -> None:
    v = motion()[2]
    recording = record(tmp_path, joint(0.5 + 0.3 * np.sign(v) * v**2))  # type: ignore[arg-type]
    before = sb.fit("coulomb", recording, starts=1)
    trials = []
    for effect in ("offset", "nonlinear_viscous"):
        found = screened(before, effect)
        assert found is not None
        trials.append(try_effect(before, found))
    offset, viscous = trials
    assert offset is not None and viscous is not None and offset.rank < viscous.rank
    said: list[str] = []
    seconds = iter([0.0, 10.0, 20.0, 24.0, 26.0])
    told = Told(said.append, 4, lambda: next(seconds))
    told.fitted("delay", None)
    told.fitted("nonlinear_viscous", viscous)
    told.fitted("offset", offset)
    told.fitted("gravity", None)
    first, second, third, last = said
    assert first == "  fitted 1 of 4: delay; about 30 s left for the others"
    assert "fitted 2 of 4: nonlinear_viscous; best so far: nonlinear_viscous" in second
    assert second.endswith("about 20 s left for the others")
    assert "best so far: offset, held-out error" in third and "about 8 s left" in third
    assert "best so far: offset" in last and "left" not in last
