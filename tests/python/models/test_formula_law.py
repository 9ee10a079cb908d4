"""Laws and effects by formula: parsed, fitted, saved and diagnosed like those of the catalog."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from stribeck.models.channels import OTHER_CHANNELS, columns
from stribeck.models.formula_law import UNSTATED, Declaration, FormulaTerms, declarations
from synthetic import Array, joint, motion, record

STRIBECK = "a1*v + (a2 + a3*exp(-abs(v/a4)^a5))*sgn(v)"


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with viscous, Coulomb and Stribeck friction, and with load."""
    v = motion()[2]
    extra = 1.5 * np.sign(v) * np.exp(-((np.abs(v) / 0.1) ** 2))
    return record(tmp_path_factory.mktemp("formula"), joint(extra))


def test_a_law_written_out_is_the_catalogs_law() -> None:
    values = {"a1": 0.3, "a2": 0.8, "a3": 0.5, "a4": 0.07, "a5": 1.4}
    own = sb.law(STRIBECK, **values)
    known = sb.model("bittencourt_a", a1=0.8, a2=0.5, a3=0.07, a4=1.4, a5=0.3)
    v = np.linspace(-2.0, 2.0, 101)
    np.testing.assert_allclose(own.torque(v), known.torque(v), rtol=1e-14)
    np.testing.assert_allclose(own.gradient(v)[:, [1, 2, 3, 4, 0]], known.gradient(v), rtol=1e-12)
    np.testing.assert_allclose(own.split(v)["rate"], known.split(v)["rate"], rtol=1e-15)
    np.testing.assert_allclose(own.split(v)["dry"], known.split(v)["dry"], rtol=1e-14)
    single = own.torque(v, precision="single")
    np.testing.assert_allclose(single, own.torque(v), rtol=1e-5)


def test_every_channel_reaches_the_formula() -> None:
    own = sb.law("c*(v + 10*q + 100*a + 1000*T + 1e4*load + 1e5*tm + 1e6*te)", c=1.0)
    torque = own.torque(
        1.0,
        position=2.0,
        acceleration=3.0,
        temperature=4.0,
        load_torque=5.0,
        motor_torque=6.0,
        external_torque=7.0,
    )
    assert torque == 7654321.0


def _beyond_numbers(own: sb.Model, position: Array, acceleration: Array) -> Array:
    """The torque at rest, infinite where it is: `Model.torque` would refuse that."""
    others = [position, acceleration, *[None] * (len(OTHER_CHANNELS) - 2)]
    given = columns(own.core, 0.0 * position, None, others)
    return own.core.torque(own.values, **given, state=0.0, single=False)


def test_powers_whose_exponent_changes_from_row_to_row() -> None:
    """Exponents with a value of their own beside others, in one block of rows and in several."""
    bases = np.array([0.0, 5e-324, 1e-310, 1e-3, 0.5, 1.0 - 2**-53, 1.0, 1.5, 7e150, 1.7e308])
    exponents = np.array([0.0, 0.5, 1.0, 1.0 + 2**-52, 2.0, 3.0, 17.3, 1e19, 2e20, 1e300])
    base, exponent = (grid.ravel() for grid in np.meshgrid(bases, exponents))
    base, exponent = np.tile(base, 3), np.tile(exponent, 3)
    own = sb.law("c*abs(q)^abs(a)", c=1.0)
    with np.errstate(over="ignore", under="ignore"):
        expected = base**exponent
    finite = np.isfinite(expected)
    torque = _beyond_numbers(own, base, exponent)
    np.testing.assert_allclose(torque[finite], expected[finite], rtol=1e-15, atol=5e-324)
    for row in range(bases.size * exponents.size):
        one = slice(row, row + 1)
        alone = _beyond_numbers(own, base[one], exponent[one])
        np.testing.assert_array_equal(torque[one], alone)


def test_units_follow_from_the_formula() -> None:
    """A torque, plain arguments, and the channels' units fix what they can."""
    cases = {
        "c1*v + c2*tanh(v/c3)*abs(load)": ("N m s/rad", "1", "rad/s"),
        STRIBECK: ("N m s/rad", "N m", "N m", "rad/s", "1"),
        "c1*(1 + c2*(T - 25))*v": ("N m s/rad", "1/K"),
        "c1*sqrt(abs(v))*sgn(v) + c2*a": ("N m s^(1/2)/rad^(1/2)", "N m s2/rad"),
        "c1*sin(q + c2) + c3*q^2": ("N m", "rad", "N m/rad2"),
        "c1*abs(v)^c2*sgn(v)": (UNSTATED, "1"),
        "c1*c2*v": (UNSTATED, UNSTATED),
        "c1*v + c1*q": (UNSTATED,),
    }
    for text, units in cases.items():
        assert FormulaTerms("own", text).units("N m", "rad") == units, text
    assert FormulaTerms("own", "c1*v").units("N", "m") == ("N s/m",)


def test_parameters_may_be_declared() -> None:
    said = declarations(["c3: mm/s, 0.001..10, start 0.1", "c2: ..5", "c1: start -2, 1e-3.."])
    assert dict(said) == {
        "c3": Declaration("mm/s", 0.001, 10.0, 0.1),
        "c2": Declaration(None, -math.inf, 5.0, None),
        "c1": Declaration(None, 1e-3, math.inf, -2.0),
    }
    made = sb.law("c1*v + c2*tanh(v/c3)", parameters=["c3: mm/s, 0.001..10, start 0.1"])
    rows = {p.name: p for p in made.parameters}
    assert (rows["c3"].unit, rows["c3"].lower, rows["c3"].upper) == ("mm/s", 0.001, 10.0)
    assert rows["c1"].lower == -math.inf and rows["c1"].upper == math.inf


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("c1*velocty", "'velocty' is unknown (did you mean 'velocity'?"),
        ("c1*(v", "the bracket '(' is never closed, at position 4 of 'c1*(v'"),
        ("c1*tan h(v)", "tan' is a function"),
        ("__import__('os').system('true')", "'__import__' is not a function"),
        ("c1.__class__*v", "'.' is not a number, at position 3"),
        ("c1*v; c2", "';' is not allowed in a formula, at position 5"),
        ("v*2", "has no parameter to identify"),
        ("", "the formula is empty"),
        ("c1*v + stribeck", "'stribeck' in 'c1*v + stribeck' is a law or an effect"),
        ("lugre = c1*v", "'lugre' is already in the catalog"),
        ("my law = c1*v", "cannot be the name of a law"),
        ("+".join(f"c{i}*v" for i in range(40)), "at most 16 parameters"),
        ("(" * 500 + "c1" + ")" * 500, "nested brackets"),
    ],
)
def test_what_is_no_formula_is_refused_with_its_place(text: str, sentence: str) -> None:
    with pytest.raises(sb.SpecError) as refusal:
        sb.law(text)
    assert sentence in str(refusal.value) and "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("declared", "sentence"),
    [
        ("c4: rad/s", "has no parameter 'c4'; it has c1, c2, c3"),
        ("c3: 2..1", "the bounds of c3 are empty"),
        ("c3", "write NAME: UNIT, LOW..HIGH, start VALUE"),
        ("c3: start fast", "start of c3 is 'fast': give a number"),
        ("c3: start inf", "start of c3 is inf: give a finite number"),
        ("c3: nan..1", "lower bound of c3 is nan"),
    ],
)
def test_declarations_that_cannot_be(declared: str, sentence: str) -> None:
    with pytest.raises(sb.SpecError, match=r"\w") as refusal:
        sb.law("c1*v + c2*tanh(v/c3)", parameters=[declared])
    assert sentence in str(refusal.value)


def test_a_fit_finds_what_the_catalogs_law_finds(recording: sb.Recording) -> None:
    known = sb.fit("coulomb+stribeck", recording)
    own = sb.fit(STRIBECK, recording)
    assert own.model.spec == "formula" and own.converged
    assert own.rmse == pytest.approx(known.rmse, rel=1e-9)
    assert own.rmse_held_out == pytest.approx(known.rmse_held_out, rel=1e-6)
    for name, like in zip(known.model.names, ("a1", "a2", "a3", "a4", "a5"), strict=True):
        one, other = known.estimates[name], own.estimates[like]
        assert other.value == pytest.approx(one.value, rel=1e-6)
        assert other.stderr == pytest.approx(one.stderr, rel=1e-4)
        assert other.unit == one.unit


def test_the_same_bits_again(recording: sb.Recording) -> None:
    one, other = sb.fit(STRIBECK, recording), sb.fit(STRIBECK, recording)
    assert one.model.values.tobytes() == other.model.values.tobytes()


def test_starts_bounds_and_held_values(recording: sb.Recording) -> None:
    bounded = sb.fit(STRIBECK, recording, bounds={"a4": (0.01, 0.05)}, start={"a4": 0.02})
    assert bounded.estimates["a4"].value == 0.05 and bounded.estimates["a4"].at_bound
    held = sb.fit(STRIBECK, recording, fix={"a5": 2.0, "a1": 1.0})
    for name, value in (("a5", 2.0), ("a1", 1.0)):
        estimate = held.estimates[name]
        assert (estimate.value, estimate.held, estimate.stderr) == (value, True, None)
    assert "fixed, not identified: a1 = 1, a5 = 2" in held.notes
    catalog = sb.fit("coulomb+stribeck", recording, fix={"alpha": 2.0})
    assert catalog.model.value("stribeck_exponent") == 2.0
    # What is held stays held when effects are added.
    assert sb.add(catalog, "offset", recording).model.value("stribeck_exponent") == 2.0


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ({"fix": {"a9": 1.0}}, "formula has no parameter 'a9'; it has a1"),
        ({"fix": {"a5": math.nan}}, "parameter a5 is nan"),
        ({"fix": {"a5": 2.0}, "start": {"a5": 1.0}}, "parameter a5 is held"),
        ({"bounds": {"a5": (3.0, 1.0)}}, "the bounds of a5 are empty: 3 .. 1"),
        ({"bounds": {"a5": (1.0, 3.0)}, "start": {"a5": 4.0}}, "a5 starts at 4, outside"),
    ],
)
def test_choices_that_cannot_be(
    recording: sb.Recording, said: dict[str, dict[str, float]], sentence: str
) -> None:
    with pytest.raises(sb.SpecError, match=r"\w") as refusal:
        sb.fit(STRIBECK, recording, **said)
    assert sentence in str(refusal.value)


def test_a_formula_without_a_finite_torque_is_refused(recording: sb.Recording) -> None:
    with pytest.raises(sb.FitError, match=r"predicts no finite torque .* give other starts"):
        sb.fit("c1*log(c2*v)", recording, start={"c2": 1.0})
    with pytest.raises(sb.FitError, match="needs the torque of the environment"):
        sb.fit("c1*v*te", recording)


def test_model_file_round_trip_with_the_same_bits(recording: sb.Recording, tmp_path: Path) -> None:
    fitted = sb.fit(
        sb.law(f"mine = {STRIBECK}", "offset", parameters=["a4: rad/s, 0.001..10", "a3: N m, 0.."]),
        recording,
        fix={"a5": 2.0},
    )
    fitted = sb.add(fitted, "creep = c*abs(v)^d*sgn(v)", recording)
    assert fitted.model.spec == "mine+creep+offset"
    path = tmp_path / "own.toml"
    fitted.model.save(str(path))
    again = sb.load(path)
    assert again.spec == fitted.model.spec and again.names == fitted.model.names
    assert again.values.tobytes() == fitted.model.values.tobytes()
    assert [p.unit for p in again.parameters] == [p.unit for p in fitted.model.parameters]
    assert again.bounds["a4"] == (0.001, 10.0) and again.bounds["a3"] == (0.0, math.inf)
    v = np.linspace(-1.0, 1.0, 11)
    assert again.torque(v).tobytes() == fitted.model.torque(v).tobytes()
    again.save(str(tmp_path / "twice.toml"))
    assert (tmp_path / "twice.toml").read_text() == path.read_text()
    # Bounds and what is held serve the next fit too.
    refitted = sb.fit(again, recording)
    assert refitted.model.value("a5") == 2.0 and refitted.estimates["a4"].upper == 10.0


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("c1*v + c2*sgn(v)", "c1*v + c2*sgn(v"), "line 10: the bracket '(' is never closed"),
        (("c1*v + c2*sgn(v)", "c1*v + c9*sgn(v)"), "has no parameter 'c2'"),
        (('law = "formula"', 'law = "formal"'), "law 'formal' is unknown"),
        (("value = 2.0", "value = 2.0\nbounds = [3.0, 1.0]"), "two numbers in order are needed"),
    ],
)
def test_a_changed_model_file_is_refused_with_the_line(
    tmp_path: Path, change: tuple[str, str], sentence: str
) -> None:
    path = tmp_path / "own.toml"
    sb.law("c1*v + c2*sgn(v)", c1=0.5, c2=2.0).save(str(path))
    path.write_text(path.read_text().replace(*change))
    with pytest.raises(sb.ModelFileError) as refusal:
        sb.load(path)
    assert sentence in str(refusal.value)


def test_diagnosis_finds_what_a_formula_lacks(recording: sb.Recording) -> None:
    fitted = sb.fit("c1*v + c2*sgn(v)", recording)
    found = sb.diagnose(fitted)
    assert [f.effect for f in found.findings][:1] == ["stribeck"]
    own = "fall = c*exp(-abs(v/d))*sgn(v)"
    tried = sb.diagnose(fitted, candidates=[own])
    names = {f.effect: f for f in tried.findings}
    assert {"stribeck", "fall"} <= set(names)
    assert names["fall"].where.startswith("c*exp(-abs(v/d))*sgn(v) fits with fall_c = ")
    beyond = sb.diagnose(names["stribeck"].fit, candidates=[own])
    assert "fall" not in {f.effect for f in beyond.findings}
    with pytest.raises(sb.FitError, match="needs the torque of the environment"):
        sb.diagnose(fitted, candidates=["pushed = c*te*sgn(v)"])


def test_an_effect_by_formula_joins_any_law(recording: sb.Recording) -> None:
    fitted = sb.fit("coulomb", recording)
    wider = sb.add(fitted, "fall = c*exp(-(v/d)^2)*sgn(v)", recording)
    assert wider.model.spec == "coulomb+fall"
    assert wider.model.names[-2:] == ("fall_c", "fall_d")
    known = sb.fit("coulomb+stribeck", recording, fix={"stribeck_exponent": 2.0})
    assert wider.rmse == pytest.approx(known.rmse, rel=1e-9)
    narrower = wider.model.without_effect("fall")
    assert narrower.spec == "coulomb" and narrower.values.shape == (2,)
    for text, sentence in (
        ("fall = c*v", "effect 'fall' is already in coulomb\\+fall"),
        ("stribeck = c*v", "'stribeck' is already in the catalog"),
        ("viscous_friction = c*v", "two parameters of .* are called 'viscous_friction'"),
    ):
        with pytest.raises(sb.SpecError, match=sentence):
            sb.add(wider, text, recording)


def test_a_bristle_takes_the_place_of_a_smoothed_sign(tmp_path: Path) -> None:
    """Tadese et al., eq 16: g = Fc (2/pi) atan(k v)."""
    recording = record(tmp_path, joint())
    smoothed = sb.law("2/pi*Fc*atan(k*v) + s2*v", "presliding")
    fitted = sb.fit(smoothed, recording, starts=2)
    steady = fitted.model.with_values([8.0, 50.0, 2.0, *fitted.model.values[3:]])
    assert steady.split([-1.0, 1e-9, 1.0])["dry"] == pytest.approx(8.0)
    with pytest.raises(sb.FitError, match=r"a smoothed sign is a factor atan\(k\*v\)"):
        sb.fit(sb.law("Fc*atan(k*abs(v))*sgn(v) + s2*v", "presliding"), recording, starts=2)
