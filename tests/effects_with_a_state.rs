//! Effects with a state: against their equations in small steps, and their properties.
#![allow(clippy::disallowed_methods)]

use crate::common::close;
use stribeck::{Composed, Interval, Sample, Spec, State};

/// Viscous and Coulomb friction, Stribeck curve.
const DRY: [f64; 5] = [0.8, 3.0, 1.5, 0.2, 1.6];

fn model(effects: &[&str], own: &[f64]) -> Composed<f64> {
    let spec = Spec::new("coulomb", effects.iter().copied()).unwrap();
    let dry = if effects.contains(&"stribeck") { &DRY[..] } else { &DRY[..2] };
    let values: Vec<f64> = dry.iter().chain(own).copied().collect();
    spec.with(&values).unwrap()
}

fn lagging(time: f64) -> Composed<f64> {
    model(&["stribeck", "frictional_lag"], &[time])
}

fn curve(v: f64) -> f64 {
    (-(v.abs() / 0.2).powf(1.6)).exp()
}

/// Speeds with reversals and rests.
fn speed(i: u32) -> f64 {
    let pick = f64::from((i * 7919) % 401) / 400.0 - 0.5;
    if i.is_multiple_of(13) { 0.0 } else { pick }
}

fn held(velocity: f64, load_torque: f64, dt: f64) -> Interval<f64> {
    let sample = Sample { load_torque, ..Sample::at(velocity) };
    Interval { sample, mean_velocity: None, dt, mean: false }
}

#[test]
fn a_lag_follows_a_constant_speed_exponentially() {
    let (tau, dt) = (0.07, 0.03);
    let (model, mut state) = (lagging(tau), State::default());
    let mut e = curve(speed(0));
    for i in 0..60 {
        let v = speed(i);
        e = curve(v) + (e - curve(v)) * (-dt / tau).exp();
        let expected = (3.0 + 1.5 * e) * v.signum() + 0.8 * v;
        let torque = model.step_over(&mut state, &held(v, 0.0, dt)).torque;
        close(torque, if v == 0.0 { 0.0 } else { expected }, 1e-13);
    }
}

/// With a mean velocity the curve changes linearly within the step, as in many small steps.
#[test]
fn a_lag_follows_a_linearly_changing_curve() {
    let (tau, dt, parts) = (0.07, 0.03, 20_000_u32);
    let (model, mut state) = (lagging(tau), State::default());
    let mut e = curve(speed(1));
    let mut before = curve(speed(1));
    for i in 1..12 {
        let v = speed(i);
        for k in 0..parts {
            let along = (f64::from(k) + 0.5) / f64::from(parts);
            let steady = before + (curve(v) - before) * along;
            e += (steady - e) * -(-dt / tau / f64::from(parts)).exp_m1();
        }
        before = curve(v);
        let interval = Interval { mean_velocity: Some(v), ..held(v, 0.0, dt) };
        let torque = model.step_over(&mut state, &interval).torque;
        if i > 1 && v != 0.0 {
            close(torque, (3.0 + 1.5 * e) * v.signum() + 0.8 * v, 1e-7);
        } else {
            // The first sample starts on the static curve.
            e = before;
        }
    }
}

#[test]
fn zero_lag_gives_the_bits_of_the_static_curve() {
    let plain = model(&["stribeck", "load"], &[0.1, 1.2, 0.05, 1.3]);
    let late = model(&["stribeck", "frictional_lag", "load"], &[0.0, 0.1, 1.2, 0.05, 1.3]);
    for mean in [false, true] {
        let mut state = State::default();
        for i in 0..200 {
            let interval = Interval {
                mean_velocity: mean.then_some(speed(i) * 0.9),
                ..held(speed(i), 3.0, 0.01)
            };
            let torque = late.step_over(&mut state, &interval).torque;
            assert_eq!(torque, plain.static_torque(&interval.sample));
        }
    }
}

#[test]
fn a_lag_stays_within_the_curve_and_dissipates() {
    for tau in [1e-6, 0.02, 3.0, 1e6] {
        let mut state = State::default();
        for i in 0..500 {
            let v = speed(i);
            let interval =
                Interval { mean_velocity: (i % 2 == 0).then_some(v), ..held(v, 0.0, 0.01) };
            let torque = lagging(tau).step_over(&mut state, &interval).torque;
            let height = (torque - 0.8 * v) * v.signum() - 3.0;
            assert!(v == 0.0 || (-1e-12..=1.5 + 1e-12).contains(&height), "{tau}: {height}");
        }
    }
}

#[test]
fn a_stiff_bristle_has_the_lag_of_the_static_law() {
    let bristle = model(&["stribeck", "frictional_lag", "presliding"], &[0.07, 1e9, 0.0]);
    let (mut there, mut here) = (State::default(), State::default());
    for i in 0..100 {
        let interval = held(speed(i), 0.0, 0.01);
        let rough = bristle.step_over(&mut there, &interval).torque;
        let sharp = lagging(0.07).step_over(&mut here, &interval).torque;
        assert!(speed(i) == 0.0 || (rough - sharp).abs() < 1e-6);
    }
}

#[test]
fn a_steady_speed_and_a_settled_state_have_no_lag() {
    let sample = Sample::at(0.15);
    let model = lagging(0.4);
    let mut state = model.settled(&sample);
    let torque = model.step_over(&mut state, &held(0.15, 0.0, 0.0)).torque;
    assert_eq!(torque, model.static_torque(&sample));
}

/// A load torque that changes its sign at constant velocity: the momentum lost is restored.
#[test]
fn a_gap_restores_the_momentum_that_it_takes() {
    let dt = 1e-4;
    for returned in [0.0, 0.6, 1.0] {
        let model = model(&["backlash"], &[0.05, 0.7, returned]);
        let mut state = State::default();
        let (mut lost, mut given) = (0.0, 0.0);
        for i in 0..20_000 {
            let load = 5.0 * (f64::from(i) * dt - 0.4);
            let torque = model.step_over(&mut state, &held(0.5, load, dt)).torque;
            let taken = torque - model.static_torque(&Sample::at(0.5));
            let way = f64::from(i - 4000) * dt * 0.5_f64.powf(0.7);
            let open = if i > 4000 { load * (-(way / 0.05) * (way / 0.05)).exp() } else { 0.0 };
            lost += open * dt;
            given += (taken + open) * dt;
        }
        assert!(lost > 0.005);
        assert!((given - returned * lost).abs() < 5e-3 * lost, "{given} {lost}");
    }
}

#[test]
fn a_gap_of_zero_width_changes_nothing() {
    let closed = model(&["backlash"], &[1e-12, 0.7, 0.5]);
    let mut state = State::default();
    for i in 0..200 {
        let load = (f64::from(i) * 0.37).sin();
        let interval = held(0.3, load, 0.01);
        let torque = closed.step_over(&mut state, &interval).torque;
        close(torque, closed.static_torque(&interval.sample), 1e-12);
    }
}

#[test]
fn flanks_touch_until_the_load_torque_first_changes_sign() {
    let model = model(&["backlash"], &[0.3, 1.0, 0.0]);
    let mut state = State::default();
    let mut at = |load| model.step_over(&mut state, &held(0.3, load, 0.01)).torque;
    let whole = 0.8 * 0.3 + 3.0;
    assert_eq!(at(2.0), whole);
    // A load torque of 0 is not a change of sign, a negative one is: half a step after the change.
    assert_eq!(at(0.0), whole);
    assert_eq!(at(1.0), whole);
    let way: f64 = 0.5 * 0.3 * 0.01;
    close(at(-1.0), whole + (-(way / 0.3) * (way / 0.3)).exp(), 1e-14);
}

#[test]
fn single_precision_agrees_with_double() {
    let effects = ["stribeck", "frictional_lag", "backlash", "presliding"];
    let values = [0.8, 3.0, 1.5, 0.2, 1.6, 0.05, 0.04, 0.6, 0.7, 900.0, 1.0];
    let spec = Spec::new("coulomb", effects).unwrap();
    let double = spec.with(&values).unwrap();
    let single = spec.with(&values.map(|x| x as f32)).unwrap();
    let (mut fine, mut rough) = (State::default(), State::default());
    for i in 0..300 {
        let (v, load) = (speed(i), (f64::from(i) * 0.11).sin());
        let expected = double.step_over(&mut fine, &held(v, load, 0.01)).torque;
        let sample = Sample { load_torque: load as f32, ..Sample::at(v as f32) };
        let interval = Interval { sample, mean_velocity: None, dt: 0.01_f32, mean: false };
        let torque = single.step_over(&mut rough, &interval).torque;
        assert!((f64::from(torque) - expected).abs() < 2e-3, "{i}: {torque} {expected}");
    }
}
