//! A step terminates and gives finite numbers for any input.

mod common;

use stribeck::joint::{self, ElasticJoint, ElasticPosture, Joint, Posture, Push, Transmission};
use stribeck::{Scalar, Spec, State};

/// A pseudo-random generator (xorshift64*).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// With both signs, from `2^low` to `2^high`, uniform over the powers of two; one in eight is
    /// 0.
    fn spread(&mut self, low: i64, high: i64) -> f64 {
        let power = low + ((self.bits() >> 32) % high.abs_diff(low)) as i64;
        let size = f64::from_bits(((1023 + power) as u64) << 52 | self.bits() >> 12);
        match self.bits() >> 60 {
            0 | 1 => 0.0,
            n if n % 2 == 0 => -size,
            _ => size,
        }
    }
}

fn stays_finite<P: Scalar<Plain = P> + PartialOrd>(spec: &Spec, random: &mut Random, steps: u32) {
    let number = P::from_f64;
    let values: Vec<P> = common::values(spec).into_iter().map(number).collect();
    let friction = spec.with(&values).unwrap();
    let mut state = State::default();
    let mut posture = Posture { position: number(0.0), velocity: number(0.0) };
    for k in 0..steps {
        let joint = Joint {
            stiffness: number(random.spread(-10, 12).abs()),
            ..Joint::revolute(
                number(random.spread(-10, 10).abs() + 1e-4),
                number(random.spread(-4, 6)),
                number(random.spread(-4, 6)),
            )
        };
        let dt = number(random.spread(-18, 3).abs() + 1e-6);
        let push = Push {
            external: number(random.spread(-20, 8)),
            temperature: number(30.0),
            time: number(f64::from(k)),
            ..Push::by_motor(number(random.spread(-20, 12)))
        };
        let mut body = joint.moving(posture, &push);
        let result = joint::step(&friction, &mut state, &mut body, dt);
        let numbers = [body.posture.position, body.posture.velocity, result.friction, result.load];
        assert!(numbers.iter().all(|x| x.value().is_finite()), "{spec} at step {k}: {numbers:?}");
        posture = body.posture;
        // Far away nothing new happens, and single precision has few digits.
        if posture.position.abs() > number(1e3) || posture.velocity.abs() > number(1e3) {
            posture = Posture { position: number(0.0), velocity: number(random.spread(-20, 4)) };
        }
    }
}

#[test]
fn every_model_stays_finite_for_any_input() {
    let mut random = Random(11);
    for spec in common::every_model() {
        stays_finite::<f64>(&spec, &mut random, 300);
        stays_finite::<f32>(&spec, &mut random, 100);
    }
}

#[test]
fn a_transmission_stays_finite_for_any_input() {
    let mut random = Random(12);
    for law in ["coulomb", "bittencourt_a", "lugre", "gms"] {
        let spec = Spec::new(law, []).unwrap();
        let friction = spec.with(&common::values(&spec)).unwrap();
        let mut state = State::default();
        let mut posture = ElasticPosture::aligned(Posture { position: 0.0, velocity: 0.0 });
        for k in 0..1000 {
            let joint = ElasticJoint {
                motor_inertia: random.spread(-10, 6).abs() + 1e-4,
                transmission: Transmission {
                    stiffness: random.spread(0, 24).abs(),
                    damping: random.spread(-10, 10).abs(),
                    backlash: random.spread(-16, 0).abs(),
                },
                load: Joint::revolute(random.spread(-10, 6).abs() + 1e-4, 1.0, -2.0),
            };
            let push = Push::by_motor(random.spread(-20, 10));
            let mut body = joint.moving(posture, &push);
            let result =
                joint::step(&friction, &mut state, &mut body, random.spread(-18, 0).abs() + 1e-6);
            posture = body.posture();
            let at = [posture.motor, posture.load];
            let finite = at.iter().all(|at| at.position.is_finite() && at.velocity.is_finite());
            assert!(finite && result.friction.is_finite(), "{law} at step {k}: {posture:?}");
            if at.iter().any(|at| at.position.abs() > 1e3 || at.velocity.abs() > 1e3) {
                posture = ElasticPosture::aligned(Posture { position: 0.0, velocity: 1.0 });
            }
        }
    }
}
