"""Bounds, starts and constants follow the recording's size."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from stribeck.effect.constants import effect_constants
from stribeck.effect.describe import base_of
from stribeck.identify.scaling import (
    bounds,
    law_constants,
    model_for,
    rigid_body_terms,
)
from stribeck.models.catalog import catalog
from synthetic import joint, record


def test_bounds_hold_the_start_and_scale_with_the_machine(
    tmp_path: Path, plain: sb.Recording
) -> None:
    frame = joint()
    larger = record(
        tmp_path,
        frame.with_columns(torque=frame["torque"] * 50.0, load_torque=frame["load_torque"] * 50.0),
    )
    for effect in catalog()["effects"]:
        spec = "+".join(["coulomb", *base_of(effect), effect])
        m = model_for(spec, plain)
        lower, upper, start = bounds(m, plain)
        assert np.all(lower <= start) and np.all(start <= upper) and np.all(lower < upper), spec
        assert np.all(np.isfinite([*lower, *upper])), spec
        big_lower, big_upper, _ = bounds(model_for(spec, larger), larger)
        factor = np.array(
            [50.0 if "N m" in p.unit or p.unit == "kg m2" else 1.0 for p in m.parameters]
        )
        np.testing.assert_allclose(big_upper, factor * upper, rtol=1e-9, err_msg=spec)
        np.testing.assert_allclose(big_lower, factor * lower, rtol=1e-9, err_msg=spec)


def test_constants_are_those_of_the_moving_rows(plain: sb.Recording) -> None:
    moving = plain.moving
    assert plain.temperature is not None and plain.position is not None
    mean = effect_constants("temperature_dry", plain)["reference_temperature"]
    assert mean == pytest.approx(plain.temperature[moving].mean())
    tl = plain.load_torque[moving]
    assert effect_constants("load", plain)["reference_load"] == pytest.approx(
        np.sqrt(np.mean(tl**2))
    )
    q = plain.position[moving]
    stroke = effect_constants("position", plain)
    assert stroke["position_start"] == q.min() and stroke["position_periodic"] == 0.0
    assert stroke["position_length"] == pytest.approx(np.ptp(q))


def test_friction_of_many_turns_repeats_with_the_turn(tmp_path: Path) -> None:
    frame = joint()
    far = record(tmp_path, frame.with_columns(position=frame["position"] * 20.0))
    stroke = effect_constants("position", far)
    assert stroke["position_periodic"] == 1.0
    assert stroke["position_length"] == pytest.approx(2.0 * np.pi)


def test_rigid_body_is_identified_only_where_it_is_not_given(
    tmp_path: Path, plain: sb.Recording
) -> None:
    assert rigid_body_terms(plain) == ()
    unknown = record(tmp_path, joint().drop("load_torque"))
    assert rigid_body_terms(unknown) == ("inertia", "gravity")


def test_an_inertia_in_a_model_is_that_of_the_rigid_body_or_beside_a_known_load(
    tmp_path: Path, plain: sb.Recording
) -> None:
    unknown = record(tmp_path, joint().drop("load_torque"))
    made = model_for("coulomb+stribeck+inertia+gravity", unknown)
    assert made.effects == ("stribeck",) and made.rigid_body == ("inertia", "gravity")
    given = model_for(sb.model("coulomb+inertia", inertia=0.7), unknown)
    assert given.spec == "coulomb" and given.value("inertia") == 0.7
    assert model_for("coulomb+inertia", plain).effects == ("inertia",)


def test_missing_channels_are_named(tmp_path: Path) -> None:
    cold = record(tmp_path, joint(rows=400).drop("temperature"))
    with pytest.raises(sb.FitError, match='map="temperature='):
        model_for("coulomb+temperature_viscous", cold)


def test_laws_get_the_constants_they_name(plain: sb.Recording) -> None:
    """All but the exponent of laws that do not identify it, and the number of elements."""
    for law, row in catalog()["laws"].items():
        given = law_constants(law, plain)
        assert set(given) == set(row["constants"]) - {"stribeck_exponent", "elements"}, law
        assert all(np.isfinite(x) for x in given.values())


def test_base_temperature_is_the_mean_but_far_below_for_a_law_without_limit_there(
    plain: sb.Recording,
) -> None:
    assert plain.temperature is not None
    mean = plain.temperature[plain.moving].mean()
    assert law_constants("hao_b", plain)["base_temperature"] == pytest.approx(mean)
    below = law_constants("madsen", plain)["base_temperature"]
    assert below == pytest.approx(plain.temperature.min() - 20.0)


def test_constants_of_known_values_stay(plain: sb.Recording) -> None:
    """`hao_b` with values counts from its own base temperature, here the default."""
    known = sb.model("hao_b", a1=3.0, a2=1.0, a3=0.0, a4=0.0, a5=-0.01)
    assert "base_temperature" not in model_for(known, plain).constants
    unknown = sb.model("hao_b")
    assert model_for(unknown, plain).constants["base_temperature"] > 20.0


def test_no_limit_within_the_data_is_refused(tmp_path: Path) -> None:
    frame = joint(rows=600)
    cold = record(tmp_path, frame.with_columns(temperature=frame["temperature"] - 30.0))
    with pytest.raises(sb.FitError, match=r"no limit at 0 degC.*-12 to 12"):
        sb.fit("li", cold)


def test_a_held_parameter_keeps_its_start(plain: sb.Recording) -> None:
    made = model_for("simoni", plain)
    lower, upper, start = bounds(made, plain)
    k = made.names.index("scale")
    assert lower[k] == upper[k] == start[k] == 1.0
    scale = sb.fit("simoni", plain, starts=2).estimates["scale"]
    assert scale.value == 1.0 and scale.stderr is None and not scale.at_bound


def test_what_the_catalog_holds_is_held_and_said(plain: sb.Recording) -> None:
    """Simoni's a5 scales all other parameters: it stays 1, or what is said."""
    fitted = sb.fit("simoni", plain, starts=1)
    assert fitted.estimates["scale"].held and fitted.model.value("scale") == 1.0
    assert "fixed, not identified: scale = 1" in fitted.notes
    twice = sb.fit("simoni", plain, starts=1, fix={"a5": 2.0})
    assert twice.rmse == pytest.approx(fitted.rmse, rel=1e-9)
    assert twice.model.value("viscous_friction") == pytest.approx(
        fitted.model.value("viscous_friction") / 2.0, rel=1e-6
    )
    free = sb.fit("simoni", plain, starts=1, bounds={"a5": (0.5, 2.0)})
    assert not free.estimates["scale"].held and not free.estimates["scale"].identifiable


@pytest.mark.parametrize("effect", ["gain", "saturation"])
def test_effects_of_the_whole_torque_need_a_known_load(effect: str, tmp_path: Path) -> None:
    unknown = record(tmp_path, joint(rows=400).drop("load_torque"))
    with pytest.raises(sb.FitError, match="load_torque=COLUMN"):
        model_for(f"coulomb+{effect}", unknown)


def test_time_goes_on_over_runs(tmp_path: Path) -> None:
    frame = joint(rows=400)
    both = pl.concat([frame.with_columns(run=pl.lit(k)) for k in (1, 2)])
    elapsed = record(tmp_path, both).elapsed
    assert np.all(np.diff(elapsed) > 0.0)
    assert elapsed[0] == 0.0 and elapsed[-1] == pytest.approx(7.99)


def test_the_inertia_of_a_joint_is_not_negative(tmp_path: Path) -> None:
    """Where no load torque is known, the inertia is all of it; beside one it is a correction."""
    frame = joint()
    less = frame.with_columns(torque=pl.col("torque") - 0.5 * pl.col("acceleration"))
    beside = sb.fit("coulomb+inertia", record(tmp_path, less), starts=1)
    assert beside.model.value("inertia") == pytest.approx(-0.5, abs=0.01)
    alone = record(tmp_path, less.drop("load_torque"), "alone")
    whole = sb.fit("coulomb", alone, starts=1)
    assert whole.model.value("inertia") == 0.0 and whole.estimates["inertia"].at_bound
    asked = sb.fit("coulomb", alone, starts=1, bounds={"inertia": (-5.0, 5.0)})
    assert asked.model.value("inertia") < 0.0
