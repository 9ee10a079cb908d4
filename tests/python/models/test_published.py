"""Published parameter sets: read, listed, and used as models."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import stribeck as sb
from as_user import answer, stribeck
from stribeck.models.build import with_values
from stribeck.models.catalog import catalog
from stribeck.models.published.sets import every_set
from synthetic import joint

SPEEDS = np.concatenate([-np.geomspace(3.0, 1e-3, 12), [0.0], np.geomspace(1e-3, 3.0, 12)])
COMPLETE = [one.id for one in every_set().values() if not one.missing]


def torque(model: sb.Model, temperature: float, load: float) -> np.ndarray:
    return model.torque(
        SPEEDS,
        position=0.0 * SPEEDS,
        acceleration=0.1 + 0.0 * SPEEDS,
        temperature=temperature,
        load_torque=load,
        motor_torque=10.0 * SPEEDS,
        dt=1e-3,
    )


@pytest.mark.parametrize("id", COMPLETE)
def test_numbers_typed_in_as_printed_give_the_torque_of_the_set(id: str) -> None:
    one = every_set()[id]
    bare = sb.model(one.model.spec, constants=one.model.constants)
    typed = with_values(replace(bare, rigid_body=one.model.rigid_body), one.printed)
    for temperature, load in ((30.0, 0.0), (38.0, -0.5), (24.0, 20.0)):
        np.testing.assert_array_equal(
            torque(sb.published(id), temperature, load), torque(typed, temperature, load)
        )


def test_every_set_names_its_source_and_how_it_was_turned() -> None:
    for one in every_set().values():
        assert one.paper and one.where and one.machine and one.rule, one.id
        assert one.id.endswith(f"/{one.model.spec}")
    frame = sb.published_sets()
    assert frame["id"].to_list() == list(every_set())


def test_units_are_those_of_the_joint() -> None:
    gantry = sb.published("gantry/table_1/gantry_map")
    assert {p.symbol: p.unit for p in gantry.parameters}["s2_minus"] == "N s/m"


def test_a_set_with_values_missing_says_so() -> None:
    partial = sb.published("tadese/table_2/joint_2/tadese_full")
    assert partial.value("bristle_stiffness") == 12930.0
    with pytest.raises(sb.SpecError, match="has no value for coulomb_friction_forward"):
        partial.torque(1.0, temperature=30.0, load_torque=0.0, dt=1e-3)


def test_an_unknown_set_is_answered_with_the_nearest() -> None:
    with pytest.raises(sb.SpecError, match="did you mean 'gantry/table_1/gantry_map'"):
        sb.published("gantry/table_1/gantry")


@pytest.mark.slow
def test_the_command_lists_and_shows() -> None:
    listed = answer("published", "indri")["published"]
    assert listed[0]["id"] == "indri/table_1/joint_1/indri_static"
    shown = answer("published", "published:gantry/table_1/gantry_map")
    assert shown["parameters"]["static_friction"]["value"] == 12300.0
    assert "N s/m" in stribeck("published", "gantry/table_1/gantry_map").stdout


def test_a_set_stands_for_a_model_file(tmp_path) -> None:
    named = "published:ur5e_review/table_7/joint_1/coulomb"
    assert sb.load(named).value("viscous_friction") == 12.35
    checked = answer("check", named, "--box", "velocity=-3:3")
    assert checked["passive"] is True
    answer("export", named, "--to", "json", str(tmp_path / "made"), "--box", "velocity=-3:3")
    assert list((tmp_path / "made").iterdir())


PRINTED_SIGNS = {"s20_minus": -38.0, "s2T_minus": 0.35}


def test_a_sign_that_the_law_restores_is_refused_with_the_rule() -> None:
    """Tadese et al., eq 13: sigma_2,n(T) < 0 carries the sign of backward motion."""
    with pytest.raises(
        sb.SpecError, match=r"sigma_2,n\(T\) < 0.* s20_minus = 38, s2T_minus = -0.35"
    ):
        sb.model("tadese_full", **PRINTED_SIGNS)
    with pytest.raises(sb.SpecError, match=r"F_c,n < 0.* Fc_minus = 8.2"):
        sb.model("tadese_full", Fc_minus=-8.2)
    turned = {name: -value for name, value in PRINTED_SIGNS.items()}
    assert sb.model("tadese_full", **turned).value("viscous_level_backward") == 38.0


def test_a_file_of_m0_from_before_its_exponent_was_a_parameter_is_read(tmp_path) -> None:
    path = tmp_path / "m0.toml"
    sb.published("bittencourt/figure_3/m0").save(path)
    text = path.read_text()
    begin = text.index("[parameters.stribeck_exponent]")
    end = text.find("[", begin + 1)
    old = text[:begin] + (text[end:] if end > 0 else "")
    path.write_text(
        old.replace("[parameters.", "[constants]\nstribeck_exponent = 1.91\n\n[parameters.", 1)
    )
    assert sb.load(path).value("stribeck_exponent") == 1.91


def test_a_constant_that_the_law_does_not_read_is_refused(tmp_path) -> None:
    path = tmp_path / "joint.toml"
    sb.model("hao_b", constants={"base_temperature": 20.0}, a1=1, a2=1, a3=0, a4=0, a5=0).save(path)
    path.write_text(path.read_text().replace("base_temperature", "reference_temperature"))
    with pytest.raises(
        sb.ModelFileError, match="does not read the constant 'reference_temperature'"
    ):
        sb.load(path)


def test_a_set_of_another_kind_of_joint_is_refused(tmp_path) -> None:
    path = tmp_path / "turns.parquet"
    joint().write_parquet(path)
    done = stribeck("compare", path, "published:gantry/table_1/gantry_map")
    assert done.returncode == 2 and "a model of another kind of joint" in done.stderr


def test_a_value_beyond_the_bounds_of_a_fit_is_named_in_the_note() -> None:
    """Bounds without a unit hold for every machine; the others are multiples of a scale."""
    compared, beyond = 0, 0
    for one in every_set().values():
        table = {p["symbol"]: p for p in catalog()["laws"][one.model.law]["parameters"]}
        for symbol, printed in one.printed.items():
            known = table.get(symbol)
            if known is None or known["scale"] not in (None, "none"):
                continue
            compared += 1
            if not known["lower"] <= printed <= known["upper"]:
                beyond += 1
                assert f"{symbol} is beyond the bounds of a fit" in one.note, one.id
                ends = f"{known['lower']:g} to {known['upper']:g}"
                assert ends in one.note, one.id
    assert compared > 50 > beyond > 0
