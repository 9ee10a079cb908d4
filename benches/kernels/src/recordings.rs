//! Kernels over whole recordings: the work of a fit per step of its search.

use std::f64::consts::TAU;
use std::hint::black_box;

use stribeck::Spec;
use stribeck::batch::{self, Channels, Columns, TimeStep};
use stribeck::identify;
use stribeck::math;

use crate::{Kernel, Work};

const ROWS: usize = 4096;
/// Parameters of lugre, and so columns of its Jacobian.
const WIDTH: usize = 7;

pub const KERNELS: &[Kernel] = &[
    Kernel { name: "bittencourt_a torque", rows: ROWS, prepare: || torque("bittencourt_a") },
    Kernel { name: "bittencourt_a gradient", rows: ROWS, prepare: || gradient("bittencourt_a") },
    Kernel { name: "lugre torque", rows: ROWS, prepare: || torque("lugre") },
    Kernel { name: "lugre gradient", rows: ROWS, prepare: || gradient("lugre") },
    Kernel { name: "triangle of 7 columns", rows: ROWS, prepare: triangle },
];

fn spec(law: &str) -> (Spec, &'static [f64]) {
    let values: &[f64] = match law {
        "bittencourt_a" => &[6.1, 3.2, 0.07, 1.7, 4.9],
        _ => &[4.0e3, 12.0, 4.9, 6.1, 9.3, 0.07, 1.7],
    };
    (Spec::new(law, []).expect("a law of the catalog"), values)
}

/// A sine of varying speed, in both directions (rad/s).
fn velocity() -> Vec<f64> {
    (0..ROWS).map(|i| 0.9 * math::f64::sin(TAU * i as f64 / ROWS as f64)).collect()
}

fn columns(velocity: &[f64]) -> Columns<'_> {
    let channels = Channels { velocity, ..Channels::default() };
    Columns { dt: TimeStep::Uniform(0.002), channels, ..Columns::default() }
}

fn torque(law: &str) -> Work {
    let ((spec, values), velocity) = (spec(law), velocity());
    Box::new(move || {
        black_box(batch::torque(&spec, black_box(values), &columns(&velocity))).expect("a model");
    })
}

fn gradient(law: &str) -> Work {
    let ((spec, values), velocity) = (spec(law), velocity());
    Box::new(move || {
        black_box(batch::gradient(&spec, black_box(values), &columns(&velocity), None))
            .expect("a model");
    })
}

fn triangle() -> Work {
    let ((spec, values), velocity) = (spec("lugre"), velocity());
    let (residual, jacobian) =
        batch::gradient(&spec, values, &columns(&velocity), None).expect("a model");
    let group = vec![0; ROWS];
    Box::new(move || {
        black_box(identify::triangles(black_box(&jacobian), WIDTH, &residual, &group, 1))
            .expect("columns that fit together");
    })
}
