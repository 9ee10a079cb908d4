"""Models: values by name and symbol, torque, gradient, units, steps of a state."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import stribeck as sb
from numpy.typing import NDArray
from stribeck.base.errors import SpecError
from stribeck.models.catalog import constants_of

Array = NDArray[np.float64]

V = np.array([-1.5, -0.2, -0.01, 0.0, 0.01, 0.2, 1.5])
#: Constants that hold a stroke and middle values for every effect.
CONSTANTS = {
    "reference_temperature": 30.0,
    "reference_load": 4.0,
    "reference_velocity": 2.0,
    "position_start": -1.0,
    "position_length": 2.0,
    "position_periodic": 0.0,
    "ripple_period": 0.3,
    "duration": 2.0,
    "reference_torque": 10.0,
}


def channels(rows: int, rate: float = 200.0) -> dict[str, Array]:
    """Smooth columns for every channel a model can need, reversals included."""
    t = np.arange(rows) / rate
    w = 2.0 * np.pi * 0.8
    return {
        "velocity": 0.7 * w * np.cos(w * t),
        "position": 0.7 * np.sin(w * t),
        "acceleration": -0.7 * w**2 * np.sin(w * t),
        "temperature": 25.0 + 10.0 * t,
        "temperature_rate": np.full(rows, 10.0),
        "load_torque": 5.0 * np.sin(0.6 * w * t + 0.3),
        "load_torque_curvature": -5.0 * (0.6 * w) ** 2 * np.sin(0.6 * w * t + 0.3),
        "motor_torque": 5.0 * np.sin(0.6 * w * t + 0.1),
        "time": t,
        "dt": np.full(rows, 1.0 / rate),
    }


def filled(spec: str, seed: int = 3) -> sb.Model:
    """A model with plausible values: each in its range, none on a bound."""
    rng = np.random.default_rng(seed)
    law, *effects = spec.split("+")
    read = constants_of(law, effects)
    empty = sb.model(spec, constants={name: CONSTANTS[name] for name in read if name in CONSTANTS})
    values = []
    for p in empty.parameters:
        if p.lower > 0:
            values.append(np.exp(rng.uniform(*np.log([max(p.lower, 0.05), min(p.upper, 3.0)]))))
        else:
            values.append(rng.uniform(0.1, 0.5) * (0.02 if p.scale == "sample_period" else 1.0))
    return empty.with_values(values)


def test_values_by_name_by_symbol_and_mixed() -> None:
    by_name = sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5)
    by_symbol = sb.model("coulomb", a1=0.5, a2=2.0)
    mixed = sb.model("coulomb", a1=0.5, coulomb_friction=2.0)
    for m in (by_name, by_symbol, mixed):
        assert m.value("coulomb_friction") == 2.0 and m.value("viscous_friction") == 0.5
    assert [(p.name, p.symbol) for p in by_name.parameters] == [
        ("viscous_friction", "a1"),
        ("coulomb_friction", "a2"),
    ]


def test_a_constant_that_is_not_read_is_refused() -> None:
    """`hao_b` has a base temperature; a reference temperature would change nothing."""
    with pytest.raises(sb.SpecError, match="'reference_temperature'; it reads base_temperature"):
        sb.model("hao_b", constants={"reference_temperature": 20.0})
    with pytest.raises(sb.SpecError, match="it reads none"):
        sb.model("coulomb", constants={"reference_temperature": 20.0})


def test_torque_is_the_formula_of_each_law() -> None:
    """Formulas of the literature, written out here."""
    fc, fs, vs, al, fv = 2.0, 1.5, 0.1, 1.3, 0.6
    s, size = np.sign(V), np.abs(V)
    curve = np.exp(-((size / vs) ** al))
    np.testing.assert_allclose(sb.model("coulomb", a1=fv, a2=fc).torque(V), fv * V + fc * s)
    bittencourt = sb.model("bittencourt_a", a1=fc, a2=fs, a3=vs, a4=al, a5=fv)
    np.testing.assert_allclose(bittencourt.torque(V), (fc + fs * curve) * s + fv * V, rtol=1e-13)
    gantry = sb.model(
        "gantry_map",
        coulomb_friction=fc,
        static_friction=fs + fc,
        stribeck_velocity=vs,
        viscous_friction_forward=fv,
        viscous_friction_backward=2 * fv,
    )
    slope = np.where(V > 0, fv, 2 * fv)
    dry = fc + fs * np.exp(-((V / vs) ** 2))
    np.testing.assert_allclose(gantry.torque(V), dry * s + slope * V, rtol=1e-13)


def test_at_rest_a_static_law_gives_nothing() -> None:
    """sgn(0) = 0."""
    for law in ("coulomb", "bittencourt_a", "gantry_map"):
        assert filled(law).torque([0.0]) == [0.0]


def test_torque_of_effects_is_their_formula() -> None:
    """Load, direction, offset and inertia on top of Coulomb friction."""
    rows = channels(200)
    v, tl = rows["velocity"], rows["load_torque"]
    m = sb.model(
        "coulomb+inertia+offset+direction+load",
        constants={"reference_load": 4.0},
        coulomb_friction=2.0,
        viscous_friction=0.5,
        load_coulomb=0.1,
        load_exponent=1.5,
        direction_viscous=0.2,
        offset=-0.7,
        inertia=0.3,
    )
    dry = 2.0 + 0.1 * 4.0 * np.abs(tl / 4.0) ** 1.5
    expected = dry * np.sign(v) + 0.5 * v + 0.2 * np.abs(v) - 0.7 + 0.3 * rows["acceleration"]
    given = {k: rows[k] for k in ("velocity", "load_torque", "acceleration")}
    np.testing.assert_allclose(m.torque(**given), expected, rtol=1e-12)


def test_order_of_effects_does_not_matter() -> None:
    assert sb.model("coulomb+load+stribeck").spec == sb.model("coulomb+stribeck+load").spec


def specs() -> list[str]:
    """Every law alone, every effect that coulomb can take, and some together."""
    effects = [e for e in sb.effects()["id"] if e != "delay"]
    return [
        *sb.laws()["id"],
        *(f"coulomb+{effect}" for effect in effects),
        "bittencourt_a+load+temperature_dry+presliding",
        "coulomb+stribeck+load+position+offset+gravity",
    ]


@pytest.mark.parametrize("spec", specs())
def test_gradient_is_the_slope_of_the_torque(spec: str) -> None:
    """Against central differences, states included."""
    m, rows = filled(spec), channels(160)
    gradient = m.gradient(**rows)
    assert gradient.shape == (160, len(m.names))
    for k, value in enumerate(m.values):
        step = 1e-6 * max(abs(value), 1e-3)
        up, down = m.values.copy(), m.values.copy()
        up[k] += step
        down[k] -= step
        slope = (m.with_values(up).torque(**rows) - m.with_values(down).torque(**rows)) / (2 * step)
        size = np.abs(slope).max() + 1e-9
        # A difference cannot see less than the rounding of the torques it is taken of.
        rounding = 4.0 * np.finfo(float).eps * np.abs(m.torque(**rows)).max() / step
        np.testing.assert_allclose(
            gradient[:, k], slope, atol=2e-5 * size + rounding, err_msg=m.names[k]
        )


def test_a_state_is_stepped_to_the_end_of_each_step() -> None:
    """z = 0 at first; sample i ends a step with velocity[i] held, solved here in closed form."""
    stiffness, damping, fv, fc = 800.0, 3.0, 0.4, 2.0
    m = sb.model("lugre", a1=stiffness, a2=damping, a3=fv, a4=fc, a5=fc, a6=0.1, a7=2.0)
    v = np.array([0.1, 0.1, -0.05, 0.0, 0.3])
    dt = np.array([0.01, 0.02, 0.01, 0.5, 0.001])
    z, expected = 0.0, []
    for speed, step in zip(v, dt, strict=True):
        r = stiffness * abs(speed) / fc
        steady = np.sign(speed) * fc / stiffness
        z = steady + (z - steady) * np.exp(-r * step) if speed else z
        expected.append(stiffness * z + damping * (speed - r * z) + fv * speed)
    np.testing.assert_allclose(m.torque(v, dt=dt), expected, rtol=1e-12)


def test_state_says_where_to_start() -> None:
    m = sb.model("lugre", a1=500.0, a2=0.0, a3=0.0, a4=2.0, a5=2.0, a6=0.1, a7=2.0)
    # At rest the deflection holds, so the torque is the spring's.
    assert m.torque([0.0], dt=0.01, state=1e-3) == pytest.approx([0.5])
    assert m.torque([0.0], dt=0.01) == [0.0]
    assert m.has_state and not m.memoryless and not sb.model("coulomb").has_state
    # Halves of a step reach where the whole step does.
    whole = m.torque([0.2], dt=0.02)[-1]
    assert m.torque([0.2, 0.2], dt=0.01)[-1] == pytest.approx(whole, rel=1e-12)


def test_laws_of_several_elements_start_from_several_forces() -> None:
    m = sb.model(
        "gms:2", dFs=0.0, vs=0.1, alpha=2.0, C=50.0, s2=0.0, F1=2.0, k1=100.0, F2=1.0, k2=900.0
    )
    assert m.torque([0.0], dt=0.01, state=[0.5, -0.2]) == pytest.approx([0.3])
    # Both stick, the first up to its 2 N m.
    assert m.torque([0.1], dt=0.01, state=[1.95, -0.2]) == pytest.approx([2.0 - 0.2 + 0.9])
    assert m.torque([0.0], dt=0.01, state=0.0) == [0.0]
    for given in (0.3, [0.3], [0.1, 0.2, 0.3]):
        with pytest.raises(ValueError, match="the model needs 2, one force per element"):
            m.torque([0.0], dt=0.01, state=given)
    with pytest.raises(ValueError, match="the model has no memory"):
        sb.model("coulomb", a1=1.0, a2=2.0).torque([0.1], state=[1e-3])
    with pytest.raises(ValueError, match="not finite"):
        m.torque([0.0], dt=0.01, state=[np.nan, 0.0])


def test_scalars_are_spread_over_the_rows() -> None:
    m = filled("coulomb+load+temperature_dry")
    spread = m.torque(V, load_torque=3.0, temperature=40.0)
    full = np.full_like(V, 3.0)
    np.testing.assert_array_equal(m.torque(V, load_torque=full, temperature=full + 37.0), spread)


@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ("colomb", "coulomb"),
        ("coulomb+laod", "load"),
        ("coulomb+temperature_dri", "temperature_dry"),
        ("coulomb+load+load", "twice"),
        ("bittencourt_a+stribeck", "stribeck"),
        ("lugre+presliding", "presliding"),
        ("", "unknown"),
    ],
)
def test_unusable_specs_name_what_may_be_meant(spec: str, said: str) -> None:
    with pytest.raises(sb.SpecError, match=said):
        _ = sb.model(spec).parameters


def test_unknown_and_unusable_values() -> None:
    with pytest.raises(sb.SpecError, match="did you mean 'coulomb_friction'"):
        sb.model("coulomb", coulom_friction=1.0)
    with pytest.raises(sb.SpecError, match="finite"):
        sb.model("coulomb", coulomb_friction=np.nan)
    with pytest.raises(sb.SpecError, match="viscous_friction"):
        sb.model("coulomb", coulomb_friction=1.0).torque(V)
    with pytest.raises(ValueError, match="load_torque"):
        filled("coulomb+load").torque(V)


@pytest.mark.parametrize(
    ("torque_unit", "position_unit", "units"),
    [
        (
            "N m",
            "rad",
            {
                "coulomb_friction": "N m",
                "viscous_friction": "N m s/rad",
                "stribeck_velocity": "rad/s",
                "inertia": "kg m2",
            },
        ),
        (
            "N",
            "m",
            {
                "coulomb_friction": "N",
                "viscous_friction": "N s/m",
                "stribeck_velocity": "m/s",
                "inertia": "kg",
            },
        ),
        (
            "V",
            "rad",
            {
                "coulomb_friction": "V",
                "viscous_friction": "V s/rad",
                "stribeck_velocity": "rad/s",
                "inertia": "V s2/rad",
            },
        ),
    ],
)
def test_units_are_those_of_the_joint(
    torque_unit: str, position_unit: str, units: dict[str, str]
) -> None:
    m = replace(
        sb.model("coulomb+stribeck+inertia"), torque_unit=torque_unit, position_unit=position_unit
    )
    said = {p.name: p.unit for p in m.parameters}
    assert {name: said[name] for name in units} == units


def test_effects_come_and_go_and_values_stay() -> None:
    m = sb.model("coulomb", a1=0.5, a2=2.0)
    wider = m.with_effect("load", {"reference_load": 4.0})
    assert wider.spec == "coulomb+load" and wider.value("coulomb_friction") == 2.0
    assert np.isnan(wider.value("load_coulomb"))
    np.testing.assert_array_equal(wider.without_effect("load").values, m.values)
    with pytest.raises(sb.SpecError, match="already"):
        wider.with_effect("load", {})


def test_split_adds_up_to_the_torque() -> None:
    m = filled("bittencourt_a+offset+direction")
    parts = m.split(V)
    total = parts["dry"] * np.sign(V) + parts["rate"] + parts["additive"]
    np.testing.assert_allclose(total, m.torque(V), rtol=1e-12)


def test_catalogs_are_frames() -> None:
    assert {"coulomb", "lugre", "bittencourt_a", "gantry_map"} <= set(sb.laws()["id"])
    assert {"load", "stribeck", "delay"} <= set(sb.effects()["id"])


@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ("coulomb+coulomb", "'coulomb' is the law of this model already: leave the second one out"),
        ("gms:4+gms:3", "'gms:3' is the law of this model already"),
        ("coulomb+lugre", "'lugre' is a law, and a model has one law; an effect is needed"),
        ("coulomb+viscous", "law 'coulomb' includes viscous friction (parameter viscous_friction)"),
        ("stribeck", "'stribeck' is an effect, which is added to a law: write coulomb+stribeck"),
        ("stribeck+lugre+load", "is an effect, which is added to a law: write lugre+stribeck+load"),
        ("viscous", "is unknown; law 'coulomb' includes viscous friction"),
        ("coulmb", "law 'coulmb' is unknown; did you mean 'coulomb'?"),
        ("coulomb+lod", "effect 'lod' is unknown; did you mean 'load'?"),
    ],
)
def test_a_spec_of_the_wrong_words_says_what_to_write(spec: str, said: str) -> None:
    with pytest.raises(SpecError) as refused:
        sb.model(spec)
    assert said in str(refused.value)


def test_the_spec_that_a_refusal_proposes_is_one() -> None:
    """An effect alone, with a law after it, with another effect: the proposal can be used."""
    for spec in ("stribeck", "load+lugre", "stribeck+load"):
        with pytest.raises(SpecError, match="write ") as refused:
            sb.model(spec)
        assert sb.model(str(refused.value).partition("write ")[2]).law in ("coulomb", "lugre")


def test_values_of_another_number_are_refused() -> None:
    model = sb.model("coulomb", a1=1.0, a2=2.0)
    for given in ([1.0], [1.0, 2.0, 3.0], 1.0):
        with pytest.raises(SpecError, match="the model has 2 parameters"):
            model.with_values(given)


def test_a_channel_that_no_model_reads_is_refused() -> None:
    model = sb.model("coulomb", a1=1.0, a2=2.0)
    with pytest.raises(SpecError, match="there is no channel `load`: give some of position"):
        model.split([1.0], load=[3.0])
    with pytest.raises(SpecError, match="did you mean 'temperature'"):
        model.split([1.0], temperatur=[30.0])


def test_models_and_fits_can_be_compared_and_kept_in_sets() -> None:
    """By identity: their arrays have no single truth value."""
    one, other = (sb.model("coulomb", a1=1.0, a2=2.0) for _ in range(2))
    assert one == one and one != other and len({one, other, one}) == 2
