//! The streaming factorisation of `stribeck::identify` beside faer's QR on the same blocks of
//! samples, and the small bounded problems of a search.
// Inputs may have different bits on different machines.
#![allow(clippy::disallowed_methods)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::qr::no_pivoting::factor::{qr_in_place, qr_in_place_scratch};
use faer::{Mat, Par};
use stribeck::identify::{bounded_least_squares, triangles};

const ROWS: usize = 4096;
/// Samples per factorisation by faer: the second is the best of 128 to 4096 on most computers.
const BLOCKS: [usize; 2] = [128, 512];

/// Rows of a Jacobian, and a residual.
fn problem(rows: usize, parameters: usize) -> (Vec<f64>, Vec<f64>) {
    let mut state = 1_u64;
    let mut number = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let jacobian = (0..rows * parameters).map(|_| number()).collect();
    (jacobian, (0..rows).map(|_| number()).collect())
}

/// The triangular factor of `[J r]`, row by row, from blocks of samples under the last factor.
fn by_faer(jacobian: &[f64], residual: &[f64], block: usize) -> Vec<f64> {
    let parameters = jacobian.len() / residual.len();
    let width = parameters + 1;
    let mut stacked = Mat::zeros(width + block, width);
    let mut reflections = Mat::zeros(1, width);
    let (sequential, tuning) = (Par::Seq, Default::default());
    let needed = qr_in_place_scratch::<f64>(width + block, width, 1, sequential, tuning);
    let mut scratch = MemBuffer::new(needed);
    for (rows, right) in jacobian.chunks(block * parameters).zip(residual.chunks(block)) {
        for k in 0..width {
            let column = stacked.col_as_slice_mut(k);
            column[k + 1..width].fill(0.0);
            let below = &mut column[width..width + right.len()];
            if k == parameters {
                below.copy_from_slice(right);
            } else {
                let own = rows[k..].iter().step_by(parameters);
                below.iter_mut().zip(own).for_each(|(x, &slope)| *x = slope);
            }
        }
        let used = stacked.as_mut().subrows_mut(0, width + right.len());
        let stack = MemStack::new(&mut scratch);
        qr_in_place(used, reflections.as_mut(), sequential, stack, tuning);
    }
    let entry = |row: usize, k: usize| if k < row { 0.0 } else { stacked[(row, k)] };
    (0..width).flat_map(|row| (0..width).map(move |k| entry(row, k))).collect()
}

fn streaming(criterion: &mut Criterion) {
    for parameters in [2, 5, 8, 12, 18, 25] {
        let (jacobian, residual) = problem(ROWS, parameters);
        let alone = [0; ROWS];
        let own = || triangles(black_box(&jacobian), parameters, &residual, &alone, 1);
        for block in BLOCKS {
            let made = own().expect("consistent sizes").remove(0);
            for (own, other) in made.factor().iter().zip(by_faer(&jacobian, &residual, block)) {
                assert!((own.abs() - other.abs()).abs() < 1e-10, "the same factor but for signs");
            }
        }
        let mut group = criterion.benchmark_group(format!("{parameters} parameters, streaming"));
        group.throughput(Throughput::Elements(ROWS as u64));
        group.bench_function("stribeck", |b| b.iter(own));
        for block in BLOCKS {
            group.bench_function(format!("faer, blocks of {block}"), |b| {
                b.iter(|| by_faer(black_box(&jacobian), &residual, block));
            });
        }
        group.finish();
    }
}

fn bounded(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("bounded least squares");
    for parameters in [2, 5, 8, 12, 18, 30] {
        let (matrix, right) = problem(2 * parameters, parameters);
        let upper = vec![0.3; parameters];
        let lower = vec![-0.3; parameters];
        group.bench_function(format!("{parameters} parameters"), |b| {
            b.iter(|| bounded_least_squares(black_box(&matrix), &right, &lower, &upper));
        });
    }
    group.finish();
}

criterion_group!(benches, streaming, bounded);
criterion_main!(benches);
