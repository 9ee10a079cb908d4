//! Numbers to compare between types of processors: `python3 develop.py processors`.
//!
//! `bits` lines must be equal on every processor. `near` lines hold a number and its standard error,
//! of which a small share may differ.
#![allow(clippy::disallowed_methods)]

use stribeck::Spec;
use stribeck::batch::{self, Channels, Columns, TimeStep};
use stribeck::identify::{
    Bounds, Problem, Steps, Triangle, bounded_least_squares, minimise, triangles,
};

const ROWS: usize = 3000;
const STEPS: Steps = Steps { tolerance: 1e-18, max_steps: 200, damping: 1e-2 };
const TRUTH: [f64; 9] = [900.0, 8.0, 0.6, 2.0, 3.0, 0.05, 1.4, 0.3, 0.1];

fn main() {
    a_model();
    linear_problems();
}

/// Noise between -1 and 1, the same everywhere.
fn noise(count: usize) -> Vec<f64> {
    let mut state = 1_u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| next()).collect()
}

fn bits(name: &str, numbers: &[f64]) {
    // FNV-1a over the bits of all numbers.
    let hash = numbers
        .iter()
        .flat_map(|x| x.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
        });
    println!("bits {name} {hash:016x}");
}

fn near(name: &str, values: &[f64], errors: &[f64]) {
    for (k, (value, error)) in values.iter().zip(errors).enumerate() {
        println!("near {name}[{k}] {value:?} {error:?}");
    }
}

/// Torque, gradient and factor of a model, and the parameters that a search finds.
fn a_model() {
    let spec = Spec::parse("lugre+offset+direction").expect("known ids");
    let shake = noise(ROWS);
    let turn = |i: usize| i as f64 * 0.004;
    // Powers alone: the functions of the platform differ between platforms, not processors.
    let wave = |x: f64| (x - x.floor()) * (1.0 - x + x.floor()) * 4.0 - 0.5;
    let velocity: Vec<f64> = (0..ROWS)
        .map(|i| 0.5 * wave(turn(i)) + 0.1 * wave(3.7 * turn(i)) + 1e-4 * shake[i])
        .collect();
    let channels = Channels { velocity: &velocity, ..Channels::default() };
    let columns = Columns { dt: TimeStep::Uniform(0.002), channels, ..Columns::default() };
    let (torque, gradient) =
        batch::gradient(&spec, &TRUTH, &columns, None).expect("columns of the model");
    bits("torque", &torque);
    bits("gradient", &gradient);
    let measured: Vec<f64> = torque.iter().zip(&shake).map(|(t, e)| t + 0.02 * e).collect();
    let problem = Problem {
        spec: &spec,
        columns,
        target: &measured,
        scale: None,
        group: &[0; ROWS],
        groups: 1,
        begins: &[],
        moving: &[true; ROWS],
        torque_norm: measured.iter().map(|x| x * x).sum::<f64>().sqrt(),
        threads: 1,
    };
    let all: Vec<usize> = (0..TRUTH.len()).collect();
    let at = |values: &[f64]| {
        let made = problem.triangles(values, &all, &[1.0; TRUTH.len()]).expect("columns");
        made.expect("a finite model").remove(0)
    };
    bits("factor", at(&TRUTH).factor());
    let lower = TRUTH.map(|x| 0.1 * x);
    let upper = TRUTH.map(|x| 10.0 * x);
    let linear = [false, false, false, true, false, false, false, true, false];
    let bounds = Bounds {
        lower: &lower,
        upper: &upper,
        linear: &linear,
        logarithmic: &linear.map(|linear| !linear),
    };
    let start = TRUTH.map(|x| 1.3 * x);
    let found = minimise(&problem, &start, &bounds, STEPS).expect("columns of the model");
    near("search", &found.values, &standard_errors(&at(&found.values), ROWS));
}

/// Steps within bounds: determined, and with two directions that the data does not determine.
fn linear_problems() {
    for p in [3, 12, 25] {
        let rows = 4 * p;
        let mut matrix = noise(rows * p);
        let right: Vec<f64> = noise(rows * (p + 1)).split_off(rows * p);
        let made = triangles(&matrix, p, &right, &vec![0; rows], 1).expect("sizes").remove(0);
        bits(&format!("factor of {p}"), made.factor());
        let errors = standard_errors(&made, rows);
        let (free, near_by) = (vec![f64::INFINITY; p], vec![0.1; p]);
        let negative = |x: &[f64]| x.iter().map(|x| -x).collect::<Vec<f64>>();
        let solved = bounded_least_squares(&matrix, &right, &negative(&free), &free);
        near(&format!("free step of {p}"), &solved, &errors);
        let solved = bounded_least_squares(&matrix, &right, &negative(&near_by), &near_by);
        near(&format!("bounded step of {p}"), &solved, &errors);
        matrix.chunks_mut(p).for_each(|row| {
            row[1] = row[0];
            row[p - 1] = 0.0;
        });
        let solved = bounded_least_squares(&matrix, &right, &negative(&free), &free);
        near(&format!("step of least norm of {p}"), &solved, &errors);
    }
}

/// `s^2 (R'R)^-1`, the roots of its diagonal.
fn standard_errors(made: &Triangle, rows: usize) -> Vec<f64> {
    let p = made.width() - 1;
    let variance = made.right(p) * made.right(p) / (rows - p) as f64;
    let mut squares = vec![0.0; p];
    for unit in 0..p {
        // A column of the inverse of R, from below.
        let mut column = vec![0.0; p];
        for row in (0..=unit).rev() {
            let known: f64 = (row + 1..=unit).map(|k| made.row(row)[k] * column[k]).sum();
            column[row] = (f64::from(u8::from(row == unit)) - known) / made.row(row)[row];
        }
        squares.iter_mut().zip(&column).for_each(|(square, x)| *square += x * x);
    }
    squares.iter().map(|square| (variance * square).sqrt()).collect()
}
