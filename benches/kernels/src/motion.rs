//! Kernels that step sample by sample: a joint in motion, and friction in a controller.

use std::f64::consts::TAU;
use std::hint::black_box;

use stribeck::joint::{self, Joint, Posture, Push};
use stribeck::math;
use stribeck::{Sample, Spec, State};

use crate::{Kernel, Work};

const STEPS: usize = 1024;

pub const KERNELS: &[Kernel] = &[
    Kernel { name: "lugre step of a controller", rows: STEPS, prepare: controller },
    Kernel { name: "lugre joint, step", rows: STEPS, prepare: || joint("lugre", &LUGRE) },
    Kernel { name: "bam_m6 joint, step", rows: STEPS, prepare: || joint("bam_m6", &BAM_M6) },
];

const LUGRE: [f64; 7] = [4.0e3, 12.0, 0.5, 0.6, 0.9, 0.07, 1.7];
const BAM_M6: [f64; 11] = [0.1, 0.1, 0.02, 0.2, 0.09, 0.2, 7e-3, 5e-3, 0.7, 1.2, 0.05];

/// A motion that reverses four times.
fn turn(step: usize) -> f64 {
    math::f64::sin(2.0 * TAU * step as f64 / STEPS as f64)
}

fn controller() -> Work {
    let spec = Spec::new("lugre", []).expect("a law of the catalog");
    let model = spec.with(&LUGRE).expect("values of the law");
    let velocity: Vec<f64> = (0..STEPS).map(turn).collect();
    Box::new(move || {
        let mut state = State::default();
        for &velocity in black_box(&velocity) {
            black_box(model.step(&mut state, &Sample::at(velocity), 2.5e-4));
        }
    })
}

/// A pendulum that a motor drives through rest.
fn joint(law: &str, values: &'static [f64]) -> Work {
    let spec = Spec::new(law, []).expect("a law of the catalog");
    let friction = spec.with(values).expect("values of the law");
    let pendulum = Joint::revolute(0.02, 0.0, 0.5);
    let torque: Vec<f64> = (0..STEPS).map(|step| 2.5 * turn(step)).collect();
    Box::new(move || {
        let mut state = State::default();
        let mut posture = Posture { position: 0.0, velocity: 0.0 };
        for &torque in black_box(&torque) {
            let push = Push::by_motor(torque);
            let mut body = pendulum.moving(posture, &push);
            black_box(joint::step(&friction, &mut state, &mut body, 1e-3));
            posture = body.posture;
        }
    })
}
