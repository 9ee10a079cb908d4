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


def test_a_form_that_predicts_better_explains_what_hardly_adds_to_it(tmp_path: Path) -> None:
    """A curve at low speed, which nonlinear viscous friction follows in part."""
    _, q, v, _ = motion()
    curve = 1.5 * np.exp(-np.abs(v) / 0.1) * np.sign(v)
    more = 0.06 * v * np.abs(v)
    fitted = sb.fit("coulomb", record(tmp_path, joint(curve + more)), starts=1)
    after = sb.add(fitted, "nonlinear_viscous", starts=4)
    trial = Trial("nonlinear_viscous", after, evidence(fitted, after))
    form = FlexibleRefit.beside(fitted, curve[fitted.rows, None])
    fall, p_value = form.beside_columns(trial)
    assert form.advantage(trial) < -TIE and fall > 0.01 and p_value < 1e-4
    assert form.explains(trial, 20, 0.01)
    # What the form leaves in full is not explained, though the form predicts better.
    place = 0.05 * np.sin(2.0 * q) * np.sign(v)
    fitted = sb.fit("coulomb", record(tmp_path, joint(curve + place), "place"), starts=1)
    after = sb.add(fitted, "position", starts=1)
    trial = Trial("position", after, evidence(fitted, after))
    form = FlexibleRefit.beside(fitted, curve[fitted.rows, None])
    assert form.advantage(trial) < -TIE and not form.explains(trial, 20, 0.01)
