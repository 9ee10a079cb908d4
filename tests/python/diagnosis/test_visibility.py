"""What is said of effects that were not found: how large they would have had to be."""

from __future__ import annotations

import json
import time
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from numpy.typing import NDArray
from scipy.stats import f as fisher
from stribeck.diagnosis.visibility.added_effect import AddedEffect
from stribeck.diagnosis.visibility.groups import cliques
from stribeck.diagnosis.visibility.held_out import held_out_balance
from stribeck.diagnosis.visibility.model_space import ModelSpace
from stribeck.diagnosis.visibility.power import Demand, ExpectedNoise, Noise, needed_factor
from stribeck.diagnosis.visibility.result import Visibility
from stribeck.diagnosis.visibility.smallest import smallest_visible
from stribeck.diagnosis.visibility.subspace import orthonormal, outside_span, sine_to_span
from stribeck.diagnosis.visibility.visibility import problem_of, visibility
from stribeck.models.catalog import effect_ids
from stribeck.motion.generate.files import sidecar_text
from stribeck.motion.generate.hidden import generate
from synthetic import ar1, joint, motion, record

Array = NDArray[np.float64]
#: Sizes of planted effects, as shares of the smallest visible one.
SMALL, LARGE = 0.5, 2.0
#: What is looked for only where the simpler effect that it goes beyond is there.
BEYOND = {"quadrant", "frictional_lag", "thermometer_lag", "spring"}


def seen(fit: sb.Fit, *effects: str) -> Visibility:
    """What the fit's recording shows of these effects (default: all that the model can take)."""
    return visibility(fit, effects or effect_ids(), tried=18)


def made(folder: Path, frame: pl.DataFrame, truth: dict[str, object]) -> sb.Recording:
    """Write a generated recording with its sidecar, and read it."""
    path = folder / "made.parquet"
    frame.write_parquet(path)
    path.with_name("made.parquet.sidecar.toml").write_text(sidecar_text(truth))
    return sb.read(path)


def planted(rec: sb.Recording, effect: str, size: float) -> Array:
    """Torque of an effect of this size, by hand, on the synthetic joint."""
    v, tl = rec.velocity, rec.load_torque
    assert rec.position is not None and rec.temperature is not None and tl is not None
    reference = float(np.sqrt(np.mean(tl[rec.moving] ** 2)))
    mean = float(np.mean(rec.temperature[rec.moving]))
    slow = 0.1 * rec.scales()["speed"]
    torque: Array = {
        "offset": size * np.ones_like(v),
        "inertia": size * rec.acceleration,
        "load": size * np.abs(tl / reference) * reference * np.sign(v),
        "stribeck": size * np.exp(-((v / slow) ** 2)) * np.sign(v),
        "temperature_dry": size * 3.0 * (mean - rec.temperature) * np.sign(v),
    }[effect]
    return torque


def hits(folder: Path, effect: str, seeds: range, shares: tuple[float, ...]) -> dict[float, int]:
    """How often a diagnosis finds or demotes an effect planted at these shares of its visible size.

    An answer that cannot be told from it counts.
    """
    count = dict.fromkeys(shares, 0)
    for seed in seeds:
        frame = joint(seed=seed, rho=0.5)
        rec = record(folder, frame)
        row = seen(sb.fit("coulomb", rec), effect).smallest[0]
        for share in shares:
            torque = frame["torque"].to_numpy() + planted(rec, effect, share * row.value)
            changed = record(folder, frame.with_columns(torque=pl.Series(torque)))
            diagnosis = sb.diagnose(sb.fit("coulomb", changed))
            found = (*diagnosis.findings, *diagnosis.demoted)
            count[share] += any(effect in (f.effect, *f.indistinguishable_from) for f in found)
    return count


@pytest.mark.slow
def test_twice_the_stated_size_is_found_and_half_of_it_seldom(tmp_path: Path) -> None:
    counts = [hits(tmp_path, effect, range(2), (SMALL, LARGE)) for effect in ("load", "stribeck")]
    assert [count[LARGE] for count in counts] == [2, 2]
    assert sum(count[SMALL] for count in counts) <= 1


@pytest.mark.long
@pytest.mark.parametrize("effect", ["offset", "inertia", "load", "stribeck", "temperature_dry"])
def test_the_stated_size_is_found_nineteen_times_in_twenty(effect: str, tmp_path: Path) -> None:
    """A binomial of 20 draws at 0.95 lies below 16 once in 400."""
    count = hits(tmp_path, effect, range(20), (SMALL, 1.0, LARGE))
    assert count[1.0] >= 16 and count[LARGE] == 20
    assert count[SMALL] <= 12


@pytest.mark.slow
@pytest.mark.parametrize("effect", ["offset", "inertia", "load"])
def test_the_stated_size_on_generated_recordings(effect: str, tmp_path: Path) -> None:
    """The same on a motion of passes, swings and rests, under payloads that change."""
    small = large = 0
    for seed in range(6):
        frame, truth = generate([], seed=seed, seconds=40.0, rate=100.0)
        rec = made(tmp_path, frame, truth)
        row = seen(sb.fit("coulomb", rec), effect).smallest[0]
        for share in (SMALL, LARGE):
            torque = frame["torque"].to_numpy() + planted(rec, effect, share * row.value)
            changed = made(tmp_path, frame.with_columns(torque=pl.Series(torque)), truth)
            found = sb.diagnose(sb.fit("coulomb", changed)).findings
            hit = any(effect in (f.effect, *f.indistinguishable_from) for f in found)
            small += hit and share == SMALL
            large += hit and share == LARGE
    assert large == 6 and small <= 4


def test_the_stated_torque_is_that_of_the_stated_size(plain: sb.Recording) -> None:
    fit = sb.fit("coulomb", plain)
    for effect in ("offset", "inertia", "load", "stribeck"):
        row = seen(fit, effect).smallest[0]
        torque = planted(plain, effect, row.value)[fit.rows]
        assert row.rms == pytest.approx(np.sqrt(np.mean(torque**2)), rel=1e-9)
        assert row.unit == "N m" and row.parameter.startswith(effect)


def test_more_data_shows_smaller_effects(tmp_path: Path) -> None:
    short, long = (
        seen(sb.fit("coulomb", record(tmp_path, joint(rows=rows, rho=0.9))), "inertia").smallest[0]
        for rows in (1500, 6000)
    )
    assert short.rms > 1.5 * long.rms


def test_memory_of_the_noise_hides_effects(tmp_path: Path) -> None:
    white, slow = (
        seen(sb.fit("coulomb", record(tmp_path, joint(rho=rho))), "inertia").smallest[0]
        for rho in (0.0, 0.98)
    )
    assert slow.rms > 2.0 * white.rms


def test_power_of_the_test_itself() -> None:
    """A regressor in slow noise: seen in 95 of 100 draws at the factor that is called for."""
    rng = np.random.default_rng(0)
    rows, draws, demand = 4000, 400, Demand(0.01, 0.0)
    torque = np.sin(0.01 * np.arange(rows))
    hits = 0
    for _ in range(draws):
        noise = Noise.of(ar1(rng, rows, 0.9, 1.0))
        square = float(torque @ torque)
        variance = noise.variance_along(torque)
        factor = needed_factor(square, variance, noise, 1, demand)
        statistic = (factor * square + torque @ noise.residual) ** 2 / variance
        hits += statistic > fisher.isf(demand.significance, 1, noise.count - 1)
    assert 0.90 < hits / draws < 0.99


def test_an_offset_looks_like_a_weight_over_a_small_range(tmp_path: Path) -> None:
    _, q, v, a = motion()
    frame = joint().with_columns(
        position=pl.Series(1.2 + 0.05 * q),
        velocity=pl.Series(0.05 * v),
        acceleration=pl.Series(0.05 * a),
    )
    fit = sb.fit("coulomb", record(tmp_path, frame))
    groups = [set(g.effects) for g in seen(fit, "offset", "gravity", "inertia").groups]
    assert {"offset", "gravity"} in groups
    assert not any("inertia" in g for g in groups)


def test_a_direction_that_differs_holds_an_offset(plain: sb.Recording) -> None:
    groups = seen(sb.fit("coulomb", plain)).groups
    assert any({"offset", "direction"} <= set(g.effects) for g in groups)
    assert not any({"load", "inertia"} <= set(g.effects) for g in groups)


def test_load_equals_position_where_one_pose_order_is_repeated(tmp_path: Path) -> None:
    frame, (_, q, v, _) = joint(), motion()
    load = 8.0 * np.sin(q + 0.4)
    torque = load + 3.0 * np.sign(v) + 1.2 * v
    noise = 0.03 * np.random.default_rng(5).standard_normal(v.size)
    same = frame.with_columns(load_torque=pl.Series(load), torque=pl.Series(torque + noise))
    for frame_, alike in ((same, True), (frame, False)):
        groups = seen(sb.fit("coulomb", record(tmp_path, frame_)), "load", "position").groups
        assert any({"load", "position"} <= set(g.effects) for g in groups) == alike


def test_what_the_model_takes_up_is_hidden(tmp_path: Path) -> None:
    """Inertia of a motion whose acceleration follows its speed is viscous friction."""
    frame = joint()
    v = frame["velocity"].to_numpy()
    frame = frame.with_columns(acceleration=pl.Series(2.0 * v))
    fit = sb.fit("coulomb", record(tmp_path, frame, trust=True))
    hidden = seen(fit, "inertia").hidden
    assert [row.effect for row in hidden] == ["inertia"]
    assert "viscous_friction" in hidden[0].why and hidden[0].do.startswith("record")


def test_a_diagnosis_says_all_that(plain: sb.Recording) -> None:
    diagnosis = sb.diagnose(sb.fit("coulomb", plain))
    answer = json.loads(json.dumps(diagnosis.to_dict(), allow_nan=False))
    stated = {row["effect"]: row for row in answer["smallest_visible"]}
    assert set(stated) == set(effect_ids()) - BEYOND
    assert all(row["rms"] > 0 and row["unit"] == "N m" for row in stated.values())
    assert ["direction", "offset"] in answer["indistinguishable_groups"] or any(
        {"direction", "offset"} <= set(g) for g in answer["indistinguishable_groups"]
    )
    text = repr(diagnosis)
    assert (
        "Smallest RMS torque that would have been significant" in text
        and "Indistinguishable" in text
    )
    assert max(map(len, text.splitlines())) <= 98


def test_the_load_of_an_identified_rigid_body_counts(tmp_path: Path) -> None:
    fit = sb.fit("coulomb", record(tmp_path, joint().drop("load_torque")))
    assert [row.effect for row in seen(fit, "load", "gain").smallest] == ["load"]


def test_an_effect_beyond_another_is_stated_where_that_is_in_the_model(plain: sb.Recording) -> None:
    for law, stated in (("coulomb", []), ("coulomb+load", ["quadrant"])):
        rows = seen(sb.fit(law, plain), "quadrant").smallest
        assert [row.effect for row in rows] == stated


@pytest.mark.parametrize("effect", ["presliding", "backlash", "frictional_lag"])
def test_effects_that_are_not_proportional_to_their_size(effect: str, tmp_path: Path) -> None:
    """The stated size lies within what was looked at, and more noise asks for a larger one."""
    v = motion()[2]
    curve = 1.5 * np.exp(-((v / 0.3) ** 2)) * np.sign(v)
    fit = sb.fit("coulomb+stribeck", record(tmp_path, joint(curve)))
    problem = problem_of(fit)
    widened = AddedEffect.of(problem, effect, fit.residual)
    base = (ModelSpace(problem), Demand(5e-4, 0.01))
    sizes = []
    for noise in (0.003, 0.03):
        loud = ExpectedNoise(noise, 1.0, problem.rows.size)
        sizes.append(smallest_visible(widened, [base], loud, fit.prediction[fit.rows]).size)
    first, *_, last = widened.sizes(3)
    assert min(first, last) <= min(sizes) and max(sizes) <= max(first, last)
    assert (sizes[0] > sizes[1]) == widened.is_inverse and sizes[0] != sizes[1]


def test_a_lag_without_a_stribeck_curve_is_seen_at_no_size(plain: sb.Recording) -> None:
    flat = sb.fit("coulomb+stribeck", plain)
    assert seen(flat, "frictional_lag").smallest == ()
    assert [row.effect for row in seen(flat, "frictional_lag").hidden] == ["frictional_lag"]


def test_what_was_found_is_not_called_invisible(tmp_path: Path) -> None:
    diagnosis = sb.diagnose(sb.fit("coulomb", record(tmp_path, joint(0.5))))
    assert diagnosis.findings[0].effect == "offset"
    assert "offset" not in {row.effect for row in diagnosis.smallest_visible}


def test_projections() -> None:
    rng = np.random.default_rng(1)
    columns = rng.standard_normal((50, 3))
    basis = orthonormal(np.column_stack([columns, 1e6 * columns.sum(axis=1)]))
    assert basis.shape == (50, 3)
    np.testing.assert_allclose(basis.T @ basis, np.eye(3), atol=1e-12)
    left = outside_span(basis, rng.standard_normal((50, 2)))
    np.testing.assert_allclose(columns.T @ left, 0.0, atol=1e-12)
    assert sine_to_span(columns[:, 0], basis) < 1e-12 and sine_to_span(
        left[:, 0], basis
    ) == pytest.approx(1.0)


def test_cost_and_gain_of_holding_out_are_those_of_refits() -> None:
    """Against least squares without each block, over many draws of the noise."""
    rng = np.random.default_rng(2)
    rows, draws = 400, 3000
    block = np.arange(rows) // 40
    x = np.linspace(-1.0, 1.0, rows)
    base, space = np.column_stack([np.ones(rows), x]), np.column_stack([x**2, x**3])
    torque, wide = x**2, np.column_stack([base, space])
    found = held_out_balance(orthonormal(base), torque, space, block)

    def left(columns: Array, values: Array) -> Array:
        made = values.copy()
        for b in range(10):
            kept = block != b
            shares = np.linalg.lstsq(columns[kept], values[kept], rcond=None)[0]
            made[~kept] -= columns[~kept] @ shares
        return made

    fitted = outside_span(orthonormal(base), torque[:, None])
    assert found.gain == pytest.approx(np.sum(left(base, torque) ** 2) / np.sum(fitted**2))
    noise = rng.standard_normal((rows, draws))
    added = np.sum(left(wide, noise) ** 2) - np.sum(left(base, noise) ** 2)
    assert found.cost == pytest.approx(added / draws, rel=0.1)


def test_groups_are_the_largest_sets_of_which_each_is_like_each() -> None:
    alike = {"a": {"b", "c"}, "b": {"a", "c"}, "c": {"a", "b", "d"}, "d": {"c"}, "e": set()}
    assert set(cliques(alike)) == {frozenset("abc"), frozenset("cd")}


def test_it_is_quick(tmp_path: Path) -> None:
    frame, truth = generate([], seed=1, seconds=300.0, rate=200.0)
    fit = sb.fit("coulomb", made(tmp_path, frame, truth))
    began = time.process_time()
    assert {row.effect for row in seen(fit).smallest} == set(effect_ids()) - BEYOND
    # Under 1 s on a machine of its own.
    assert time.process_time() - began < 3.0
