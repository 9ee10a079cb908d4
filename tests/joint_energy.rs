//! The energy balance of motor, environment, joint and friction.

use crate::common;
use stribeck::joint::{self, Joint, Posture, Push};
use stribeck::{Sample, Scalar, Spec, State};

/// A pendulum driven back and forth: the balance per step of kinetic energy, potential energy,
/// dissipation and the work of the motor, relative to the largest of them.
fn largest_imbalance<P: Scalar<Plain = P> + PartialOrd>(spec: &Spec, dt: f64, steps: u32) -> f64 {
    let values: Vec<P> = common::values(spec).into_iter().map(P::from_f64).collect();
    let friction = spec.with(&values).unwrap();
    let joint = Joint::revolute(P::from_f64(0.7), P::from_f64(3.0), P::from_f64(-2.0));
    let mut posture = Posture { position: P::from_f64(0.2), velocity: P::from_f64(0.3) };
    let mut state = State::default();
    let mut largest = 0.0_f64;
    for k in 0..steps {
        let phase = f64::from(k) * dt;
        #[allow(clippy::disallowed_methods)]
        let torque = 14.0 * (1.3 * phase).sin() + 6.0 * (7.1 * phase).cos();
        let push = Push {
            temperature: P::from_f64(31.0),
            time: P::from_f64(phase),
            ..Push::by_motor(P::from_f64(torque))
        };
        let mut body = joint.moving(posture, &push);
        let result = joint::step(&friction, &mut state, &mut body, P::from_f64(dt));
        let support = P::zero();
        let (before, after) =
            (joint.energy(&posture, support), joint.energy(&body.posture, support));
        let imbalance = result.motor_work - result.friction_work - (after - before);
        let size = [before, after, result.motor_work, result.friction_work]
            .into_iter()
            .fold(0.0, |most: f64, x| most.max(x.value().abs()));
        largest = largest.max(imbalance.value().abs() / size);
        posture = body.posture;
        assert!(posture.velocity.value().is_finite(), "{spec} at step {k}");
    }
    largest
}

#[test]
fn energy_balances_over_every_step_with_every_model() {
    for spec in common::every_model() {
        for dt in [1e-4, 1e-3, 2e-2] {
            let imbalance = largest_imbalance::<f64>(&spec, dt, 400);
            assert!(imbalance < 1e-12, "{spec} at {dt} s: {imbalance:e}");
        }
    }
}

#[test]
fn energy_balances_in_single_precision() {
    for spec in common::every_model() {
        let imbalance = largest_imbalance::<f32>(&spec, 1e-3, 400);
        assert!(imbalance < 2e-6, "{spec}: {imbalance:e}");
    }
}

/// The friction of a step is the mean of the model's exact step at the mean velocity.
#[test]
fn friction_equals_that_of_the_model() {
    for law in ["lugre", "dahl", "gms", "leuven", "elastoplastic", "bliman_sorine", "indri_b"] {
        let spec = Spec::new(law, []).unwrap();
        let friction = spec.with(&common::values(&spec)).unwrap();
        let joint = Joint::free(0.02);
        let mut posture = Posture { position: 0.0, velocity: 0.0 };
        let mut state = State::default();
        for k in 0..2000_u32 {
            #[allow(clippy::disallowed_methods)]
            let push = Push::by_motor(9.0 * (f64::from(k) * 0.01).sin());
            let (mut own, mut body) = (state, joint.moving(posture, &push));
            let result = joint::step(&friction, &mut state, &mut body, 2e-3);
            let velocity = (body.posture.position - posture.position) / 2e-3;
            let acceleration = (body.posture.velocity - posture.velocity) / 2e-3;
            let sample = Sample { acceleration, ..Sample::at(velocity) };
            let mean = friction.step(&mut own, &sample, 2e-3).mean_torque;
            let size = result.friction.abs().max(push.motor.abs());
            assert!((mean - result.friction).abs() <= 1e-10 * size, "{spec} at step {k}");
            posture = body.posture;
        }
    }
}

/// A bristle with a known storage function: the dissipated energy is never negative, and at most
/// the stored energy returns.
#[test]
fn a_passive_joint_only_loses_energy() {
    let spec = Spec::new("lugre", []).unwrap();
    // Passive at any speed: no damping, and D falls with speed only.
    let values = [5e3, 0.0, 0.4, 1.0, 1.5, 0.05, 2.0];
    let friction = spec.with(&values).unwrap();
    let joint = Joint { stiffness: 40.0, ..Joint::revolute(0.2, 1.0, 0.5) };
    let mut posture = Posture { position: 0.9, velocity: -2.0 };
    let mut state = State::default();
    let push = Push::by_motor(0.0);
    let stored = |state: &State<f64>| 0.5 * values[0] * state.deflection() * state.deflection();
    let mut before = joint.energy(&posture, 0.0) + stored(&state);
    for _ in 0..20_000 {
        let mut body = joint.moving(posture, &push);
        joint::step(&friction, &mut state, &mut body, 1e-3);
        posture = body.posture;
        let after = joint.energy(&posture, 0.0) + stored(&state);
        assert!(after <= before + 1e-14, "gained {:e} J", after - before);
        before = after;
    }
    assert!(posture.velocity.abs() < 1e-6);
}

/// Only the inputs matter: equal bits, whatever was computed before.
#[test]
fn the_same_inputs_give_the_same_bits() {
    let spec = Spec::new("gms", []).unwrap();
    let runs = [0, 1].map(|_| largest_imbalance::<f64>(&spec, 1e-3, 500).to_bits());
    assert_eq!(runs[0], runs[1]);
}
