//! A step terminates and gives finite numbers for any input.

use crate::common;
use crate::common::random::{hold, spread};
use proptest::collection::vec;
use proptest::prelude::*;
use stribeck::joint::{self, ElasticJoint, ElasticPosture, Joint, Posture, Push, Transmission};
use stribeck::{Composed, Scalar, Spec, State};

/// What acts on a joint over a step, uniform over many powers of two.
#[derive(Clone, Debug)]
struct Acting {
    stiffness: f64,
    inertia: f64,
    gravity: [f64; 2],
    external: f64,
    motor: f64,
    dt: f64,
    /// Velocity with which the joint restarts at the origin after it has gone far away.
    velocity: f64,
}

fn acting() -> impl Strategy<Value = Acting> {
    let gravity = (spread(-4, 6), spread(-4, 6));
    let torques = (spread(-20, 8), spread(-20, 12));
    let others = (spread(-10, 12), spread(-10, 10), spread(-18, 3), spread(-20, 4));
    (gravity, torques, others).prop_map(|(gravity, (external, motor), others)| {
        let (stiffness, inertia, dt, velocity) = others;
        Acting {
            stiffness: stiffness.abs(),
            inertia: inertia.abs() + 1e-4,
            gravity: gravity.into(),
            external,
            motor,
            dt: dt.abs() + 1e-6,
            velocity,
        }
    })
}

fn stays_finite<P: Scalar<Plain = P> + PartialOrd>(
    friction: &Composed<P>,
    motion: &[Acting],
) -> Result<(), TestCaseError> {
    let number = P::from_f64;
    let mut state = State::default();
    let mut posture = Posture { position: number(0.0), velocity: number(0.0) };
    for (k, acting) in motion.iter().enumerate() {
        let [cos, sin] = acting.gravity.map(number);
        let joint = Joint {
            stiffness: number(acting.stiffness),
            ..Joint::revolute(number(acting.inertia), cos, sin)
        };
        let push = Push {
            external: number(acting.external),
            temperature: number(30.0),
            time: number(k as f64),
            ..Push::by_motor(number(acting.motor))
        };
        let mut body = joint.moving(posture, &push);
        let result = joint::step(friction, &mut state, &mut body, number(acting.dt));
        let numbers = [body.posture.position, body.posture.velocity, result.friction, result.load];
        prop_assert!(numbers.iter().all(|x| x.value().is_finite()), "step {k}: {numbers:?}");
        posture = body.posture;
        // Far away nothing new happens, and single precision has few digits.
        if posture.position.abs() > number(1e3) || posture.velocity.abs() > number(1e3) {
            posture = Posture { position: number(0.0), velocity: number(acting.velocity) };
        }
    }
    Ok(())
}

#[test]
fn every_model_stays_finite_for_any_input() {
    let motions = vec(acting(), 100);
    for spec in common::every_model() {
        let values = common::values(&spec);
        let single: Vec<f32> = values.iter().map(|&x| x as f32).collect();
        let (double, single) = (spec.with(&values).unwrap(), spec.with(&single).unwrap());
        hold(2, &motions, |motion| {
            stays_finite(&double, &motion)?;
            stays_finite(&single, &motion)
        });
    }
}

/// An elastic joint, the motor's torque and the length of a step.
fn elastic() -> impl Strategy<Value = (ElasticJoint<f64>, f64, f64)> {
    let transmission = (spread(0, 24), spread(-10, 10), spread(-16, 0));
    let inertias = (spread(-10, 6), spread(-10, 6));
    (transmission, inertias, spread(-20, 10), spread(-18, 0)).prop_map(
        |((stiffness, damping, backlash), (motor, load), torque, dt)| {
            let joint = ElasticJoint {
                motor_inertia: motor.abs() + 1e-4,
                transmission: Transmission {
                    stiffness: stiffness.abs(),
                    damping: damping.abs(),
                    backlash: backlash.abs(),
                },
                load: Joint::revolute(load.abs() + 1e-4, 1.0, -2.0),
            };
            (joint, torque, dt.abs() + 1e-6)
        },
    )
}

#[test]
fn a_transmission_stays_finite_for_any_input() {
    for law in ["coulomb", "bittencourt_a", "lugre", "gms"] {
        let spec = Spec::new(law, []).unwrap();
        let friction = spec.with(&common::values(&spec)).unwrap();
        hold(10, &vec(elastic(), 100), |motion| {
            let mut state = State::default();
            let mut posture = ElasticPosture::aligned(Posture { position: 0.0, velocity: 0.0 });
            for (k, (joint, torque, dt)) in motion.into_iter().enumerate() {
                let push = Push::by_motor(torque);
                let mut body = joint.moving(posture, &push);
                let result = joint::step(&friction, &mut state, &mut body, dt);
                posture = body.posture();
                let at = [posture.motor, posture.load];
                let finite = at.iter().all(|at| at.position.is_finite() && at.velocity.is_finite());
                prop_assert!(
                    finite && result.friction.is_finite(),
                    "{law} at step {k}: {posture:?}"
                );
                if at.iter().any(|at| at.position.abs() > 1e3 || at.velocity.abs() > 1e3) {
                    posture = ElasticPosture::aligned(Posture { position: 0.0, velocity: 1.0 });
                }
            }
            Ok(())
        });
    }
}
