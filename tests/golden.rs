//! Formulas against values computed with mpmath at 50 digits, written out from the papers'
//! equations and not from this code.

// All the digits that mpmath printed.
#![allow(clippy::excessive_precision)]

mod common;

use common::close;
use stribeck::composed::Spec;
use stribeck::dynamics::{Bristle, BristleState, State};
use stribeck::sample::{Sample, Split, StribeckCurve};
use stribeck::scalar::Real;

fn at(law: &str, effects: &[&str], values: &[f64], sample: &Sample<f64>) -> f64 {
    let spec = Spec::new(law, effects.iter().copied()).unwrap();
    spec.with(values).unwrap().static_torque(sample)
}

#[test]
fn laws_with_published_parameters() {
    // UR5e review, table 7, at 0.3 rad/s; bittencourt_a's vs is negative in print.
    close(at("coulomb", &[], &[12.35, 10.30], &Sample::at(0.3)), 14.005, 1e-15);
    let printed = [-1388.0, 1395.0, -12.62, 1.12, 96.30];
    close(at("bittencourt_a", &[], &printed, &Sample::at(0.3)), 14.877775406978362, 1e-13);
    let gantry = [20.0, 35.0, 0.1, 100.0, 120.0];
    close(at("gantry_map", &[], &gantry, &Sample::at(-0.05)), -37.682011746071073, 1e-15);
}

#[test]
fn static_amplitude_of_lugre_is_the_total() {
    let lugre = [1e5, 0.0, 0.0, 1.0, 1.5, 0.1, 2.0];
    close(at("lugre", &[], &lugre, &Sample::at(1e-9)), 1.5, 1e-15);
    let bittencourt = [1.0, 1.5, 0.1, 2.0, 0.0];
    close(at("bittencourt_a", &[], &bittencourt, &Sample::at(1e-9)), 2.5, 1e-8);
}

#[test]
fn all_static_effects_together() {
    let sample = Sample {
        velocity: -0.25,
        position: 0.9,
        acceleration: 1.3,
        temperature: 40.0,
        load_torque: -7.5,
        motor_torque: 0.0,
        external_torque: 0.0,
    };
    let effects = [
        "gravity",
        "inertia",
        "temperature_viscous",
        "nonlinear_viscous",
        "direction",
        "load",
        "temperature_dry",
        "stribeck",
    ];
    let values = [
        2.0, 5.0, // viscous, Coulomb
        3.0, 0.1, 1.5, // Stribeck
        0.05, 1.3, 0.02, 1.4, // load
        0.4, 0.3, // direction
        0.01, 0.02, 0.03, 0.05, 0.3, // temperature of the dry part
        1.5, 0.7, 2.0, // nonlinear viscous
        0.02, 0.03, // temperature of the viscous part
        0.8, 1.1, -0.6, // inertia, gravity
    ];
    close(at("coulomb", &effects, &values, &sample), -4.839884568237191, 1e-14);
}

#[test]
fn position_over_a_stroke_and_over_a_period() {
    let values: Vec<f64> =
        [0.0, 0.0].into_iter().chain((1..=8).map(|j| f64::from(j) / 10.0)).collect();
    let sample = Sample { position: 0.37, ..Sample::at(1.0) };
    for (periodic, expected) in [(0.0, 0.16176663163036918), (1.0, 0.40697646000051008)] {
        let mut spec = Spec::new("coulomb", ["position"]).unwrap();
        spec.set_constant("position_start", 0.1).unwrap();
        spec.set_constant("position_length", 0.8).unwrap();
        spec.set_constant("position_periodic", periodic).unwrap();
        close(spec.with(&values).unwrap().static_torque(&sample), expected, 1e-13);
    }
}

#[test]
fn temperature_factor_at_and_near_zero_curvature() {
    let sample = Sample { temperature: 40.0, ..Sample::at(1.0) };
    let factor = |k| at("coulomb", &["temperature_dry"], &[0.0, 1.0, 0.02, k], &sample);
    close(factor(0.03), 0.75841876774784886, 1e-15);
    close(factor(1e-9), 0.70000000224999999, 1e-15);
    close(factor(0.0), 0.7, 1e-15);
}

#[test]
fn weights_of_an_exponential_step() {
    let expected = [
        (-0.5, [0.78693868057473315, 0.42612263885053369, 0.14775472229893261]),
        (-1e-8, [0.99999999500000002, 0.49999999833333334, 0.16666666625]),
        (-3.0, [0.31673764387737869, 0.22775411870754044, 0.090748627097486521]),
        (-40.0, [0.025, 0.024375, 0.011890625]),
        (0.3, [1.1661960252533437, 0.55398675084447893, 0.17995583614826311]),
    ];
    for (x, phi) in expected {
        for (order, phi) in (1..).zip(phi) {
            close(Real::phi(x, order), phi, 2e-15);
        }
    }
    assert_eq!(Real::phi(f64::NEG_INFINITY, 1), 0.0);
}

#[test]
fn lugre_of_the_1995_paper() {
    // s0 = 1e5, s1 = 316.2, s2 = 0.4, Fc = 1, Fs = 1.5, vs = 1e-3, held at 1 mm/s for 5 ms.
    let spec = Spec::new("lugre", []).unwrap();
    let model = spec.with(&[1e5, 316.2, 0.4, 1.0, 1.5, 1e-3, 2.0]).unwrap();
    let mut state = State::deflected(2e-6);
    let step = model.step(&mut state, &Sample::at(1e-3), 5e-3);
    close(step.torque, 0.71160483134668455, 1e-14);
    close(step.mean_torque, 0.59611178951080239, 1e-14);
}

#[test]
fn bristle_approaches_the_static_law() {
    let bristle = Bristle { stiffness: 1e4, damping: 30.0 };
    let split = Split {
        coulomb: 2.0,
        height: 1.0,
        shape: StribeckCurve { value: 0.25, ..StribeckCurve::flat() },
        rate: -0.3,
        additive: 0.1,
        ..Split::zero()
    };
    let mut state = BristleState::default();
    let step = bristle.step(&mut state, &split, -0.5, 10.0);
    close(step.torque, split.torque(-1.0), 1e-14);
}
