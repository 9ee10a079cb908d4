//! Friction compensation with a model, and the observer for the remaining torque.
#![allow(clippy::disallowed_methods)]

use stribeck::joint::{self, Compensator, Joint, Observer, Posture, Push};
use stribeck::{Composed, Sample, Spec, State};

const DT: f64 = 1e-3;

fn lugre() -> Composed<f64> {
    let spec = Spec::new("lugre", []).unwrap();
    let value = |name| match name {
        "bristle_stiffness" => 2e4,
        "bristle_damping" => 20.0,
        "viscous_friction" => 0.5,
        "coulomb_friction" => 2.0,
        "static_friction" => 3.0,
        "stribeck_velocity" => 0.05,
        _ => 2.0,
    };
    let values: Vec<f64> = spec.parameters().map(|parameter| value(parameter.name)).collect();
    spec.with(&values).unwrap()
}

#[test]
fn a_compensator_gives_its_share_and_has_a_separate_state() {
    let friction = lugre();
    let (mut half, mut state) = (Compensator::new(&friction, 0.5), State::default());
    for k in 0..2000 {
        let sample = Sample::at(0.3 * (0.01 * f64::from(k)).sin());
        let whole = friction.step(&mut state, &sample, DT).torque;
        assert_eq!(half.torque(&sample, DT), 0.5 * whole);
    }
}

#[test]
fn the_observer_follows_friction_with_its_bandwidth() {
    let friction = Spec::new("coulomb", []).unwrap().with(&[0.5, 2.0]).unwrap();
    let (joint, bandwidth) = (Joint::free(0.7), 30.0);
    let (mut observer, mut state) = (Observer::new(0.7, bandwidth), State::default());
    let mut posture = Posture { position: 0.0, velocity: 1.0 };
    // The torque that keeps this speed: friction is constant from the first step on.
    let push = Push::by_motor(2.5);
    for k in 1..=500 {
        let mut body = joint.moving(posture, &push);
        joint::step(&friction, &mut state, &mut body, DT);
        observer.update(push.motor, (posture.velocity, body.posture.velocity), DT);
        posture = body.posture;
        let expected = 2.5 * (1.0 - (-bandwidth * DT * f64::from(k)).exp());
        assert!((observer.estimate - expected).abs() < 1e-9, "{k}: {}", observer.estimate);
    }
}
