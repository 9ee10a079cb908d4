"""What the effects of a model explain in a more flexible form."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import stribeck as sb
from stribeck.diagnosis.trials.evidence import evidence
from stribeck.diagnosis.trials.flexible_refit import FlexibleRefit
from stribeck.diagnosis.trials.trial import TIE, Trial
from synthetic import joint, motion, record


def test_a_form_explains_what_it_contains_unless_it_predicts_worse(tmp_path: Path) -> None:
    """A dependence on load, beside columns that have it and columns that do not."""
    v = motion()[2]
    load = joint()["load_torque"].to_numpy()
    extra = np.abs(load) * np.sign(v)
    fitted = sb.fit("coulomb", record(tmp_path, joint(0.15 * extra)), starts=1)
    after = sb.add(fitted, "load", starts=1)
    trial = Trial("load", after, evidence(fitted, after))
    holds = FlexibleRefit.beside(fitted, extra[fitted.rows, None])
    assert holds.explains(trial, 20, 0.01) and holds.advantage(trial) < TIE
    lacks = FlexibleRefit.beside(fitted, load[fitted.rows, None])
    assert not lacks.explains(trial, 20, 0.01) and lacks.advantage(trial) > TIE
    # Columns that only follow the samples they are fitted to explain nothing.
    follows = replace(holds, held_out=3.0 * holds.held_out)
    assert not follows.explains(trial, 20, 0.01)


def test_a_form_does_not_extrapolate(tmp_path: Path) -> None:
    """A column that grows in one block alone, as a temperature does in the only cold one."""
    fitted = sb.fit("coulomb", record(tmp_path, joint()), starts=1)
    block = fitted.recording.block[fitted.rows]
    column = np.sign(fitted.recording.velocity[fitted.rows]) * np.where(block == 0, 50.0, 1.0)
    column += np.random.default_rng(0).standard_normal(column.size)
    refit = FlexibleRefit.beside(fitted, column[:, None])
    plain = fitted.held_out_residual[fitted.rows]
    per_block = [np.bincount(block, x**2) for x in (refit.held_out, plain)]
    assert np.all(per_block[0] <= per_block[1])
    assert np.array_equal(refit.held_out[block == 0], plain[block == 0])
    assert not np.array_equal(refit.held_out, plain)
