//! Properties of all laws with memory, for any stiffness and any step.
#![allow(clippy::disallowed_methods)]

use crate::common::close;
use stribeck::{Composed, Interval, Memory, Sample, Spec, State};

/// Dry friction of the test models at rest (T): no elastic torque exceeds it.
const MOST: f64 = 9.0;

/// Models whose stiffness is a multiple of a common one.
fn models(stiffness: f64) -> Vec<(&'static str, Composed<f64>)> {
    let s0 = 1e3 * stiffness;
    let gms = |law, own: [f64; 5]| {
        let elements = [2.0, 0.2 * s0, 1.0, 3.0 * s0, 1.5, 0.5 * s0, 0.5, 0.01 * s0];
        (law, own.into_iter().chain(elements).collect::<Vec<f64>>())
    };
    let mut full = vec![s0, 2.0, 0.1, 5.0, 4.0];
    full.extend([3.0, -0.02, 0.5, 0.01, 2.5, -0.01, 0.7, 0.02]);
    full.extend([0.3, 2.0, 0.1, 0.05, 0.01, -0.2, 3.0, -0.1, -0.02, 0.01]);
    full.extend([-0.3, 1.0, -0.1, 0.06, 0.01, 0.2, 4.0, 0.1, -0.03, 0.01]);
    [
        ("dahl", vec![s0, 5.0, 1.0]),
        ("dahl", vec![s0, 5.0, 2.0]),
        ("dahl", vec![s0, 5.0, 0.6]),
        ("dahl", vec![s0, 5.0, 25.43]),
        ("lugre", vec![s0, 1.3, 0.4, 5.0, 8.0, 0.1, 1.7]),
        ("indri_b", vec![s0, 1.3, 0.8, 0.2, 300.0, 5.0, 1.0, 2.0, 0.4, 0.1]),
        ("tadese_t", vec![s0, 1.3, 5.0, 8.0, 0.1, 1.0, 0.01, 2.0, 0.05, 0.9, 0.01]),
        ("tadese_full", full),
        ("xiao", vec![s0, 1.3, 0.4, 5.0, 8.0, 0.1, 0.1, 0.2, 0.3, 0.4]),
        ("bliman_sorine", vec![5.0, 0.4, 8.0 / s0, 0.2]),
        ("elastoplastic", vec![s0, 1.3, 0.4, 5.0, 8.0, 0.1, 0.6]),
        gms("leuven", [1.3, 0.4, 3.0, 0.1, 1.7]),
        gms("gms", [3.0, 0.1, 1.7, 50.0 * stiffness, 0.4]),
    ]
    .into_iter()
    .map(|(law, values)| (law, Spec::new(law, []).unwrap().with(&values).unwrap()))
    .collect()
}

fn sample(velocity: f64) -> Sample<f64> {
    Sample { temperature: 31.0, load_torque: 2.0, acceleration: 0.7, ..Sample::at(velocity) }
}

/// A slow and fast velocity in both directions, with rests.
fn velocity(i: u32) -> f64 {
    let pick = f64::from((i * 7919) % 401) / 200.0 - 1.0;
    if i.is_multiple_of(17) { 0.0 } else { pick * pick * pick }
}

/// The numbers of a state.
fn forces(model: &Composed<f64>, state: &State<f64>) -> Vec<f64> {
    match model.memory() {
        Memory::Forces(count) => state.forces()[..count].to_vec(),
        _ => vec![state.deflection()],
    }
}

/// The factor that converts them into torques.
fn unit(model: &Composed<f64>, stiffness: f64) -> f64 {
    if matches!(model.memory(), Memory::Deflection) { 1e3 * stiffness } else { 1.0 }
}

#[test]
fn every_law_with_a_memory_is_tested() {
    let tested: Vec<&str> = models(1.0).iter().map(|(law, _)| *law).collect();
    for law in stribeck::catalog::LawId::ALL {
        if law.info().captures.contains(&"presliding") {
            assert!(tested.contains(&law.info().id), "{}", law.info().id);
        }
    }
}

#[test]
fn two_half_steps_are_one_step() {
    for stiffness in [0.01, 1.0, 1e4] {
        for (law, model) in models(stiffness) {
            let tolerance = if law == "elastoplastic" { 1e-5 } else { 1e-11 };
            let mut once = State::default();
            for i in 0..400 {
                let (sample, dt) = (sample(velocity(i)), 0.01);
                let mut twice = once;
                let whole = model.step(&mut once, &sample, dt);
                let first = model.step(&mut twice, &sample, 0.5 * dt);
                let second = model.step(&mut twice, &sample, 0.5 * dt);
                let mean = 0.5 * (first.mean_torque + second.mean_torque);
                let near = |a: f64, b: f64, what| {
                    assert!((a - b).abs() < tolerance * MOST, "{law}, {i}, {what}: {a} {b}");
                };
                near(whole.torque, second.torque, "end");
                near(whole.mean_torque, mean, "mean");
                for (a, b) in forces(&model, &once).into_iter().zip(forces(&model, &twice)) {
                    let unit = unit(&model, stiffness);
                    near(a * unit, b * unit, "state");
                }
            }
        }
    }
}

#[test]
fn the_mean_is_that_of_many_small_steps() {
    for stiffness in [0.1, 30.0] {
        for (law, model) in models(stiffness) {
            let (mut once, mut often) = (State::default(), State::default());
            for v in [0.3, 0.02, -0.001, -0.4, 0.4] {
                let pieces = 4000;
                let mean = model.step(&mut once, &sample(v), 0.02).mean_torque;
                let mut sum = 0.0;
                let mut last = None;
                for _ in 0..pieces {
                    let step = model.step(&mut often, &sample(v), 0.02 / f64::from(pieces));
                    // The trapezoidal rule with the torque at the ends, from the second piece on.
                    sum += last.map_or(step.mean_torque, |last: f64| 0.5 * (last + step.torque));
                    last = Some(step.torque);
                }
                let sum = sum / f64::from(pieces);
                assert!((mean - sum).abs() < 2e-4 * MOST, "{law} at {v}: {mean} {sum}");
            }
        }
    }
}

/// A torque that depends on no motion adds to the friction at the end and to the mean alike.
#[test]
fn an_offset_adds_to_every_torque() {
    let bases: [(&str, &[f64]); 4] = [
        ("dahl", &[50.0, 5.0, 1.0]),
        ("lugre", &[50.0, 1.3, 0.4, 5.0, 8.0, 0.1, 1.7]),
        ("bliman_sorine", &[5.0, 0.4, 0.16, 0.2]),
        ("elastoplastic", &[50.0, 1.3, 0.4, 5.0, 8.0, 0.1, 0.6]),
    ];
    let made = |law, effects: &[&str], values: &[f64]| {
        let mut spec = Spec::new(law, effects.iter().copied()).unwrap();
        spec.set_constant("reference_velocity", 0.7).unwrap();
        spec.with(values).unwrap()
    };
    for (law, values) in bases {
        // With viscous friction in every law, so that there are both a rate and an additive part.
        let values = [values, &[0.4, 1.5, 10.0]].concat();
        let without = made(law, &["nonlinear_viscous"], &values);
        let with = made(law, &["nonlinear_viscous", "offset"], &[&values[..], &[0.7]].concat());
        let (mut a, mut b) = (State::default(), State::default());
        for v in [0.3, 0.02, -0.001, -0.4] {
            let plain = without.step(&mut a, &sample(v), 0.01);
            let shifted = with.step(&mut b, &sample(v), 0.01);
            close(shifted.torque, plain.torque + 0.7, 1e-13);
            close(shifted.mean_torque, plain.mean_torque + 0.7, 1e-13);
        }
    }
}

/// A bristle that is not bent yet resists by its damping and the viscous friction alone.
#[test]
fn a_bristle_without_deflection_is_a_damper() {
    let damped = |law: &str| ["lugre", "elastoplastic", "leuven"].contains(&law);
    for (_, model) in models(1.0).into_iter().filter(|&(law, _)| damped(law)) {
        for v in [0.02, -0.3] {
            let torque = model.step(&mut State::default(), &sample(v), 1e-12).torque;
            close(torque, (1.3 + 0.4) * v, 1e-6);
        }
    }
}

#[test]
fn states_stay_bounded_and_finite() {
    for stiffness in [1e-3, 1.0, 1e6, 1e12] {
        for (law, model) in models(stiffness) {
            let mut state = State::default();
            for i in 0..3000 {
                let step = model.step(&mut state, &sample(4.0 * velocity(i)), 0.002);
                assert!(step.torque.is_finite() && step.mean_torque.is_finite(), "{law}");
                let unit = if matches!(model.memory(), Memory::Deflection) {
                    1e3 * stiffness
                } else {
                    1.0
                };
                for force in forces(&model, &state) {
                    assert!((force * unit).abs() < MOST, "{law}: {force}");
                }
            }
        }
    }
}

#[test]
fn rest_and_no_time_change_nothing() {
    for (law, model) in models(1.0) {
        let mut state = State::default();
        for i in 0..50 {
            let _ = model.step(&mut state, &sample(velocity(i)), 0.003);
        }
        let before = forces(&model, &state);
        for (v, dt) in [(0.0, 1.0), (0.3, 0.0), (-0.3, 0.0), (0.0, 0.0)] {
            let step = model.step(&mut state, &sample(v), dt);
            assert!(step.torque.is_finite() && step.mean_torque.is_finite(), "{law}");
            assert_eq!(forces(&model, &state), before, "{law} at {v} for {dt}");
        }
    }
}

/// From a relaxed state no passive law returns more energy than it received.
#[test]
fn work_is_never_gained() {
    for stiffness in [0.1, 1.0, 100.0] {
        for (law, model) in models(stiffness) {
            // Indri's smoothed sign prevents the bristle from unloading; Bliman's peak needs a
            // bound.
            if law == "indri_b" || law == "bliman_sorine" {
                continue;
            }
            let (mut state, mut work, dt) = (State::default(), 0.0, 0.004);
            for i in 0..5000 {
                let v = velocity(i);
                let at = Sample { load_torque: 0.0, ..sample(v) };
                work += model.step(&mut state, &at, dt).mean_torque * v * dt;
                assert!(work >= -1e-12, "{law}: {work}");
            }
        }
    }
}

/// Steps with a mean velocity are second order for slow and for stiff states.
#[test]
fn step_means_are_second_order() {
    let speed = |t: f64| 0.02 + 0.4 * (1.0 - (-t).exp());
    let travel = |t: f64| 0.42 * t + 0.4 * ((-t).exp() - 1.0);
    for stiffness in [0.02, 1.0, 50.0] {
        for (law, model) in models(stiffness) {
            let run = |steps: u32| {
                let dt = 0.5 / f64::from(steps);
                let mut state = State::default();
                let mut torque = model.step(&mut state, &sample(speed(0.0)), 0.0).torque;
                for i in 1..=steps {
                    let (from, to) = (f64::from(i - 1) * dt, f64::from(i) * dt);
                    let mean_velocity = Some((travel(to) - travel(from)) / dt);
                    let sample = sample(speed(to));
                    let interval = Interval { sample, mean_velocity, dt, mean: false };
                    torque = model.step_over(&mut state, &interval).torque;
                }
                torque
            };
            let exact = run(25_600);
            let error = |steps| (run(steps) - exact).abs() + 1e-7 * MOST;
            let (coarse, fine) = (error(100), error(400));
            assert!(fine < coarse / 8.0 || fine < 2e-6 * MOST, "{law}: {coarse:e} {fine:e}");
            assert!(coarse < 4e-3 * MOST, "{law}: {coarse:e}");
        }
    }
}

#[test]
fn dahl_has_known_solutions() {
    let (s0, dry, v, dt) = (2e3_f64, 4.0_f64, -0.3_f64, 0.004_f64);
    let k = s0 * v.abs() * dt / dry;
    for (exponent, u) in [(1.0, (-k).exp()), (2.0, 1.0 / (1.0 + k)), (0.5, (1.0 - 0.5 * k).powi(2))]
    {
        let model = Spec::new("dahl", []).unwrap().with(&[s0, dry, exponent]).unwrap();
        let step = model.step(&mut State::default(), &Sample::at(v), dt);
        close(step.torque, -dry * (1.0 - u), 1e-14);
    }
    // The mean of 1/(1 + k t) over 0 .. 1.
    let model = Spec::new("dahl", []).unwrap().with(&[s0, dry, 2.0]).unwrap();
    let step = model.step(&mut State::default(), &Sample::at(v), dt);
    close(step.mean_torque, -dry * (1.0 - k.ln_1p() / k), 1e-13);
}

#[test]
fn order_of_elements_does_not_matter() {
    for law in ["gms:3", "leuven:3"] {
        let spec = Spec::new(law, []).unwrap();
        let own = [3.0, 0.1, 1.7, 50.0, 0.4];
        let with = |order: [usize; 3]| {
            let elements = [[2.0, 200.0], [1.0, 3e3], [0.5, 30.0]];
            let elements = order.into_iter().flat_map(|k| elements[k]);
            spec.with(&own.into_iter().chain(elements).collect::<Vec<f64>>()).unwrap()
        };
        let (a, b) = (with([0, 1, 2]), with([2, 0, 1]));
        let (mut of_a, mut of_b) = (State::default(), State::default());
        for i in 0..200 {
            let step = a.step(&mut of_a, &sample(velocity(i)), 0.005);
            let other = b.step(&mut of_b, &sample(velocity(i)), 0.005);
            assert!((step.torque - other.torque).abs() < 1e-12, "{law}");
        }
    }
}

/// A small hysteresis loop inside a large one closes, and the large one continues as without it.
#[test]
fn elements_remember_more_than_one_reversal() {
    let values = [0.0, 0.1, 2.0, 1e6, 0.0, 2.0, 1e4, 1.0, 3e3, 1.5, 1e3, 0.5, 300.0];
    let model = Spec::new("gms", []).unwrap().with(&values).unwrap();
    let run = |moves: &[f64]| {
        let mut state = State::default();
        let go = |v| model.step(&mut state, &Sample::at(v), 0.01).torque;
        moves.iter().copied().map(go).last().unwrap()
    };
    let plain = run(&[0.06, -0.04, 0.01, 0.01]);
    close(run(&[0.06, -0.04, 0.01, -0.005, 0.005, 0.01]), plain, 1e-12);
    // A loop larger than the previous reversal erases it.
    assert!((run(&[0.06, -0.04, 0.01, -0.03, 0.03, 0.01]) - plain).abs() > 1e-3);
}
