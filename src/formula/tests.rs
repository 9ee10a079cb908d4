//! Formula laws: parsing, errors and values.

// Values with all digits printed by mpmath.
#![allow(clippy::excessive_precision)]

use core::cell::Cell;

use proptest::collection::vec;
use proptest::prop_assert;
use proptest::sample::select;

use super::{FormulaTerms, TermKind};
use crate::catalog::Role;
use crate::common::close;
use crate::common::random::hold;
use crate::{Channel, Dual, Expression, Formula, Real, Sample, Spec, State};

fn parse(text: &str) -> Formula {
    Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).0
}

fn torque(text: &str, parameters: &[f64], sample: &Sample<f64>) -> f64 {
    FormulaTerms::new(&parse(text), parameters).split(sample).torque(sample.velocity.sign())
}

/// The value of a formula of `c` at `v`.
fn at(text: &str, c: f64, v: f64) -> f64 {
    torque(text, &[c], &Sample::at(v))
}

fn refusal(text: &str) -> String {
    match Formula::parse(text) {
        Ok(_) => panic!("'{text}' was parsed as a formula"),
        Err(error) => error.to_string(),
    }
}

fn kinds(text: &str) -> Vec<TermKind> {
    parse(text).terms().map(|term| term.kind).collect()
}

fn roles(text: &str) -> Vec<Role> {
    let formula = parse(text);
    (0..formula.parameter_count()).map(|i| formula.role(i)).collect()
}

const SAMPLE: Sample<f64> = Sample {
    velocity: -0.3,
    position: 1.1,
    acceleration: 2.5,
    temperature: 31.0,
    load_torque: -4.0,
    load_torque_curvature: 0.0,
    temperature_rate: 0.0,
    motor_torque: 5.0,
    external_torque: 0.7,
    time: 0.0,
};

#[test]
fn operators_have_the_usual_precedence() {
    assert_eq!(at("c + 2*3^2", 1.0, 0.0), 19.0);
    assert_eq!(at("c - 2 - 3", 1.0, 0.0), -4.0);
    assert_eq!(at("c*max(v, 3, 2) + min(5, v, 4, 6)", 1.0, 0.0), 3.0);
    assert_eq!(at("c*1_000 + 0x10", 1.0, 0.0), 1016.0);
    assert_eq!(at("c*12/4/3", 1.0, 0.0), 1.0);
    assert_eq!(at("-c^2", 3.0, 0.0), -9.0);
    assert_eq!(at("c**2**3", 2.0, 0.0), 256.0);
    assert_eq!(at("2^-c", 2.0, 0.0), 0.25);
    assert_eq!(at("c*-v", 2.0, 3.0), -6.0);
    assert_eq!(at("+c - -v", 2.0, 3.0), 5.0);
    assert_eq!(at("c*[v + (1 - 2)]", 2.0, 3.0), 4.0);
    assert_eq!(at("c*1.5e-1 + .5 + 2.", 2.0, 3.0), 2.8);
}

#[test]
fn every_function_has_its_value() {
    let values = [
        ("sgn(c)*v", -1.0),
        ("sign(0*c)*v", 0.0),
        ("abs(c)*v", 0.7),
        ("exp(c)*v", 0.49658530379140954),
        ("expm1(c)*v", -0.50341469620859046),
        ("log(-c)*v", -0.35667494393873244),
        ("ln(-c)*v", -0.35667494393873244),
        ("log10(-c)*v", -0.1549019599857432),
        ("sqrt(-c)*v", 0.83666002653407552),
        ("cbrt(c)*v", -0.88790400174260069),
        ("sin(c)*v", -0.64421768723769102),
        ("cos(c)*v", 0.76484218728448845),
        ("tan(c)*v", -0.84228838046307937),
        ("atan(c)*v", -0.61072596438920859),
        ("arctan(c)*v", -0.61072596438920859),
        ("tanh(c)*v", -0.60436777711716347),
        ("pow(-c, 1.3)*v", 0.62896640925344777),
        ("min(c, 0.2)*v", -0.7),
        ("max(c, 0.2)*v", 0.2),
        ("cos(pi*c)*v", -0.58778525229247302),
    ];
    for (text, value) in values {
        close(at(text, -0.7, 1.0), value, 2e-15);
    }
}

#[test]
fn every_channel_has_its_names() {
    let names = [
        ("v", "velocity", -0.3),
        ("q", "position", 1.1),
        ("a", "acceleration", 2.5),
        ("T", "temperature", 31.0),
        ("tl", "load_torque", -4.0),
        ("load", "tl", -4.0),
        ("tm", "motor_torque", 5.0),
        ("te", "external_torque", 0.7),
    ];
    for (short, long, value) in names {
        for name in [short, long] {
            assert_eq!(torque(&format!("c*{name}"), &[1.0], &SAMPLE), value);
        }
    }
    let formula = parse("c*abs(load)*sgn(v)");
    let read = Channel::ALL.iter().filter(|&&channel| formula.reads(channel));
    assert!(read.eq([Channel::Velocity, Channel::LoadTorque].iter()));
}

#[test]
fn integer_powers_are_exact_for_any_base() {
    let x: f64 = -1.1;
    assert_eq!(at("c*v**2", 1.0, x), x * x);
    assert_eq!(at("c*v**3", 1.0, x), x * (x * x));
    assert_eq!(at("c*v**(-2)", 1.0, x), 1.0 / (x * x));
    assert_eq!(at("c*v^0", 1.0, x), 1.0);
    assert_eq!(at("(v - c)**2", 1.0, x), (x - 1.0) * (x - 1.0));
    assert_eq!(at("c*v**(4/2)", 1.0, x), x * x);
    assert!(at("c*v**2.5", 1.0, x).is_nan());
}

#[test]
fn names_come_in_the_order_of_the_text() {
    let (_, names) = Formula::parse("Fv*v + (Fc + Fs_1*exp(-abs(v/vs)))*sgn(v) + Fc*0").unwrap();
    assert_eq!(names.as_slice(), ["Fv", "Fc", "Fs_1", "vs"]);
}

#[test]
fn a_law_as_a_formula_equals_the_law() {
    let text = "(a1 + a2*exp(-abs(v/a3)^a4))*sgn(v) + a5*v";
    let values = [0.8, 0.5, 0.07, 1.4, 0.3];
    let law = Spec::new("bittencourt_a", []).unwrap().with(&values).unwrap();
    for v in [-2.0, -0.07, -1e-9, 0.0, 0.03, 0.9] {
        close(torque(text, &values, &Sample::at(v)), law.static_torque(&Sample::at(v)), 1e-15);
    }
}

#[test]
fn terms_are_dry_smoothed_rate_or_additive() {
    use TermKind::{Additive, Dry, Rate, Smoothed};
    assert_eq!(kinds("c1*sgn(v) + c2*v + c3"), [Dry, Rate, Additive]);
    assert_eq!(kinds("c1*abs(load)*sgn(velocity)/2 - (c2 + c3*T)*v"), [Dry, Rate]);
    assert_eq!(kinds("-(c1*tanh(v/c2) - c3*sin(q))"), [Smoothed, Additive]);
    assert_eq!(kinds("(2*c1/pi)*atan(c2*v)"), [Smoothed]);
    // Magnitudes that vanish at rest are not dry friction, however they are written.
    assert_eq!(kinds("c1*abs(v)**c2*sgn(v) + sgn(v)*(1 - exp(-c3*abs(v)))"), [Rate, Rate]);
    assert_eq!(kinds("c1*v*tanh(v) + c2*tanh(v**3)"), [Rate, Rate]);
    assert_eq!(kinds("c1*tanh(v - c2) + c3*sgn(q)"), [Additive, Additive]);
    assert_eq!(kinds("c1*exp(-c2*v)"), [Additive]);
}

#[test]
fn a_split_contains_what_a_bristle_needs() {
    let text = "c1*abs(load)*sgn(v) + c2*tanh(v/c3) + c4*v + c5";
    let split = FormulaTerms::new(&parse(text), &[0.5, 0.25, -0.1, 3.0, 0.7]).split(&SAMPLE);
    assert_eq!(split.coulomb, 2.0);
    // Amplitude along the motion: both signs are negative, so friction still opposes it.
    let turned = FormulaTerms::new(&parse(text), &[0.5, -0.25, -0.1, 3.0, 0.7]).split(&SAMPLE);
    assert_eq!((split.smoothed_amplitude, turned.smoothed_amplitude), (-0.25, 0.25));
    close(split.smoothed_torque, 0.25 * 0.99505475368673045, 1e-15);
    assert_eq!((split.rate, split.additive), (3.0 * -0.3, 0.7));
    let at_rest = Sample { velocity: 0.0, ..SAMPLE };
    let resting = FormulaTerms::new(&parse(text), &[0.5, 0.25, 0.1, 3.0, 0.7]).split(&at_rest);
    assert_eq!((resting.dry(), resting.torque(0.0)), (2.25, 0.7));
    let arctangent = FormulaTerms::new(&parse("2*c1/pi*atan(v/c2)"), &[0.5, 0.1]).split(&SAMPLE);
    close(arctangent.smoothed_amplitude, 0.5, 1e-15);
}

#[test]
fn linear_parameters_are_found_by_structure() {
    use Role::{Additive, Dry, Nonlinear, Rate};
    let stribeck = "c1*v + (c2 + c3*exp(-(v/c4)**2))*sgn(v) + c5";
    assert_eq!(roles(stribeck), [Rate, Dry, Dry, Nonlinear, Additive]);
    assert_eq!(roles("c1*tanh(v/c2)"), [Dry, Nonlinear]);
    assert_eq!(roles("b1*b2*v/(1 + b2*v)"), [Rate, Nonlinear]);
    // Jointly linear: the two inner parameters rather than the outer one.
    assert_eq!(roles("c1*(c2 + c3*v)"), [Nonlinear, Additive, Additive]);
    assert_eq!(roles("c1**2*v"), [Nonlinear]);
    assert_eq!(roles("c1**1*v + (c2 + 2)/3"), [Rate, Additive]);
    assert_eq!(roles("max(c1, c2)*v"), [Nonlinear, Nonlinear]);
}

#[test]
fn gradients_equal_those_of_the_formula() {
    let text = "c1*v + (c2 + c3*exp(-abs(v/c4)^c5))*sgn(v) + atan(c6/(T - c7))/pi \
                + min(c8*q, 2)*c2^(-1/c9) - sqrt(c1 + 3)/cbrt(c2) + 2^c3*tan(c4) + log(c5*tm)";
    let values = [1.2, 0.9, 0.4, 0.2, 1.6, 3.0, 12.0, 0.8, 1.9];
    let formula = parse(text);
    let plain = |values: &[f64]| {
        let split = FormulaTerms::new(&formula, values).split(&SAMPLE);
        split.torque(SAMPLE.velocity.sign())
    };
    let duals: Vec<Dual<f64, 9>> =
        values.iter().enumerate().map(|(i, &x)| Dual::variable(x, i)).collect();
    let dual = FormulaTerms::new(&formula, &duals).split(&SAMPLE).torque(SAMPLE.velocity.sign());
    assert_eq!(dual.value.to_bits(), plain(&values).to_bits());
    for (i, slope) in dual.derivative.iter().enumerate() {
        let mut beside = [values; 4];
        for (point, shift) in beside.iter_mut().zip([-2.0, -1.0, 1.0, 2.0]) {
            point[i] += shift * 1e-3;
        }
        let [a, b, c, d] = beside.map(|point| plain(&point));
        close(*slope, (8.0 * (c - b) - (d - a)) / 12e-3, 1e-7);
    }
}

#[test]
fn single_precision_is_the_same_formula() {
    let formula = parse("c1*tanh(v/c2) + c3*abs(v)^1.5*sgn(v)");
    let sample = Sample::<f32>::at(0.2);
    let single = FormulaTerms::new(&formula, &[2.0_f32, 0.1, 0.3]).split(&sample).torque(1.0);
    let double = FormulaTerms::new(&formula, &[2.0, 0.1, 0.3]).split(&Sample::at(0.2)).torque(1.0);
    close(f64::from(single), double, 3e-7);
}

#[test]
fn errors_state_what_and_where() {
    let refusals = [
        ("", "the formula is empty"),
        ("  ", "the formula is empty"),
        ("2*v", "the formula has no parameter to identify: every name in it is a channel"),
        ("c1*v + $", "'$' is not allowed in a formula, at position 8"),
        ("c1 = v", "'=' is not allowed in a formula, at position 4"),
        ("c1*1.2.3", "'1.2.3' is not a number, at position 4"),
        ("c1*2x", "'2x' is not a number, at position 4"),
        ("c1*", "a value is missing at the end, at position 4"),
        ("c1*/v", "a value is missing before '/' at position 4"),
        ("c1*()", "a value is missing before ')' at position 5"),
        ("c1 v", "an operator is missing before 'v' at position 4"),
        ("c1(v)", "'c1' is not a function, at position 1"),
        ("c1*(v + 2", "the bracket '(' is never closed, at position 4"),
        ("c1*v)", "')' has no opening bracket, at position 5"),
        ("c1*(v]", "']' has no opening bracket, at position 6"),
        ("c1, v", "',' has no opening bracket, at position 3"),
        ("c1*tanhh(v)", "'tanhh' is not a function (did you mean 'tanh'?), at position 4"),
        ("c1*tnah(v)", "'tnah' is not a function (did you mean 'tanh'?), at position 4"),
        (
            "c1*velocty",
            "'velocty' is unknown (did you mean 'velocity'? if it is a parameter, give it a \
                        more distinct name), at position 4",
        ),
        (
            "c1*Tanh",
            "'Tanh' is unknown (did you mean 'tanh'? if it is a parameter, give it a more \
                  distinct name), at position 4",
        ),
        (
            "c1*e",
            "'e' could be Euler's number or a parameter (write exp(1), or give the \
                  parameter another name), at position 4",
        ),
        (
            "c1*time",
            "'time' is not a channel: friction depends on v, q, a, T, tl, tm or te, not \
                     on time, at position 4",
        ),
        ("c1*exp", "'exp' is a function (write exp(...)), at position 4"),
        ("c1*exp(v, 2)", "exp takes 1 argument, not 2, at position 4"),
        ("c1*pow(v)", "pow takes 2 arguments, not 1, at position 4"),
        ("c1*min(v)", "min takes 2 or more arguments, not 1, at position 4"),
        ("c1*(v, 2)", "an operator is missing before ',' at position 6"),
        ("c1*(v < 2)", "'<' is not allowed in a formula, at position 7"),
        ("c1*`v`", "'`' is not allowed in a formula, at position 4"),
        ("c1*(1/0)", "the result is not a finite number, at position 6"),
        ("c1*1e999", "the result is not a finite number, at position 4"),
        ("c1*ä", "'ä' is not allowed in a formula, at position 4"),
    ];
    for (text, sentence) in refusals {
        assert_eq!(refusal(text), sentence, "{text}");
    }
}

#[test]
fn formulas_that_are_too_large_are_refused() {
    let sum =
        |n: usize, term: &dyn Fn(usize) -> String| (0..n).map(term).collect::<Vec<_>>().join(" + ");
    assert!(refusal(&sum(17, &|i| format!("c{i}*v"))).contains("at most 16 parameters"));
    assert!(refusal(&sum(25, &|_| "c*v".into())).contains("at most 24 terms"));
    assert!(refusal(&format!("c*({})", sum(41, &|_| "2*v".into()))).contains("at most 40 numbers"));
    assert!(refusal(&format!("c*({})", sum(99, &|_| "v".into()))).contains("160 operations"));
    assert!(refusal(&format!("{}c{}", "(".repeat(90), ")".repeat(90))).contains("nested"));
    assert!(refusal(&format!("{}c", "-".repeat(90))).contains("nested"));
    assert!(refusal(&format!("c{}", "^c".repeat(90))).contains("nested"));
    assert!(Formula::parse(&sum(16, &|i| format!("c{i}*v"))).is_ok());
}

/// Random texts give a formula or an error, and values without a panic.
#[test]
fn no_text_causes_a_panic() {
    const PIECES: &[&str] = &[
        "v", "q", "T", "c1", "c2", "12", ".5", "e", "+", "-", "*", "/", "^", "**", "(", ")", "[",
        "]", ",", "sgn(", "tanh(", "min(", "pow(", "log(", " ", "=", "€", "1e3", "abs(v)",
    ];
    let understood = Cell::new(0);
    hold(50_000, &vec(select(PIECES), 1..=12), |text| {
        let text = text.concat();
        match Formula::parse(&text) {
            Ok((formula, _)) => {
                understood.set(understood.get() + 1);
                let _ = FormulaTerms::new(&formula, &[0.3, -0.7]).split(&SAMPLE);
            }
            Err(error) => prop_assert!(!error.to_string().is_empty(), "{text}"),
        }
        Ok(())
    });
    let understood = understood.get();
    assert!(understood > 250, "only {understood} texts were formulas");
}

fn static_torque(spec: &Spec, values: &[f64]) -> f64 {
    spec.with(values).unwrap().static_torque(&SAMPLE)
}

#[test]
fn effects_act_on_a_formula_law() {
    let law = parse("c1*v + c2*tanh(v/c3)");
    let spec = Spec::by_formula(&law, ["offset", "temperature_dry"]).unwrap();
    assert_eq!(spec.to_string(), "formula+temperature_dry+offset");
    let names: Vec<_> = spec.parameters().map(|p| p.name).collect();
    let effects = ["temperature_dry_slope", "temperature_dry_curvature", "offset"];
    assert_eq!(names, [&["p1", "p2", "p3"], &effects[..]].concat());
    let cold = static_torque(&spec, &[3.0, 2.0, 0.01, 0.0, 0.01, 0.5]);
    assert_eq!(cold, 3.0 * -0.3 - 2.0 + 0.5);
    let warm = static_torque(&spec, &[3.0, 2.0, 0.01, 0.05, 0.0, 0.5]);
    close(warm, 3.0 * -0.3 - 2.0 * (1.0 - 0.05 * (31.0 - 25.0)) + 0.5, 1e-15);
    assert_eq!(
        Spec::by_formula(&law, ["offset", "offset"]).unwrap_err().to_string(),
        "effect 'offset' is named twice"
    );
}

#[test]
fn presliding_adds_a_bristle_to_a_formula_law() {
    let spec = Spec::by_formula(&parse("c1*v + c2*tanh(v/c3)"), ["presliding"]).unwrap();
    let linear: Vec<_> = spec.parameters().map(|p| spec.is_linear(p)).collect();
    assert_eq!(linear, [true, false, false, false, true]);
    let model = spec.with(&[3.0, 2.0, 0.01, 50.0, 0.0]).unwrap();
    let mut state = State::default();
    let first = model.step(&mut state, &Sample::at(0.1), 1e-4).torque;
    close(first, 50.0 * 0.1 * 1e-4 + 3.0 * 0.1, 1e-3);
    let sliding = model.step(&mut state, &Sample::at(0.1), 20.0).torque;
    close(sliding, 2.0 + 3.0 * 0.1, 1e-12);
}

#[test]
fn formula_terms_extend_any_law() {
    let mut spec = Spec::new("coulomb", ["offset"]).unwrap();
    spec.add_terms(&parse("c*abs(load)*sgn(v)")).unwrap();
    spec.add_terms(&parse("2*d*v^2*sgn(v)")).unwrap();
    assert_eq!(spec.to_string(), "coulomb+formula+offset");
    assert!(spec.channels().any(|channel| channel == Channel::LoadTorque));
    let values = [1.0, 2.0, 0.25, 0.5, 7.0];
    close(static_torque(&spec, &values), -0.3 - 2.0 - 1.0 - 0.09 + 7.0, 1e-15);
    let more = parse(&(0..15).map(|i| format!("c{i}*v")).collect::<Vec<_>>().join("+"));
    let refused = spec.add_terms(&more).unwrap_err().to_string();
    assert!(refused.starts_with("the formula is too long"), "{refused}");
}

#[test]
fn an_expression_is_a_condition_or_a_value_of_known_parameters() {
    let known = ["static_friction", "a2", "v", "T"];
    let (condition, names) = Expression::parse("static_friction >= 1.5*a2^2", &known).unwrap();
    assert_eq!(names.as_slice(), ["static_friction", "a2"]);
    assert!(condition.is_condition());
    let (value, slopes) = condition.evaluate(&[10.0, 2.0]);
    assert_eq!((value, &slopes[..2]), (4.0, &[1.0, -6.0][..]));
    let (turned, _) = Expression::parse("static_friction <= 1.5*a2^2", &known).unwrap();
    assert_eq!(turned.evaluate(&[10.0, 2.0]).0, -4.0);
    // A parameter may have the name of a channel.
    let (value, names) = Expression::parse("2*v + exp(T)", &known).unwrap();
    assert_eq!(names.as_slice(), ["v", "T"]);
    assert!(!value.is_condition());
    assert_eq!(value.evaluate(&[3.0, 0.0]).0, 7.0);
    for (text, position) in [
        ("a2 >= b", 7),
        ("a2 > v", 4),
        ("a2 >= v >= T", 12),
        ("(a2 >= v) + 1", 13),
        ("a2 >= v and T >= v", 13),
        ("not a2", 1),
        ("a2 >= 'x'", 7),
        ("a2 >=", 6),
        ("q", 1),
        ("", 1),
    ] {
        let error = Expression::parse(text, &known).unwrap_err();
        assert_eq!(error.position, position, "{text}: {error}");
    }
}
