//! Time per sample of the kernels in which a fit and a controller spend their time.
// Inputs may have different bits on different machines.
#![allow(clippy::disallowed_methods)]

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use stribeck::Spec;
use stribeck::batch::{self, Channels, Columns, TimeStep};

const ROWS: usize = 4096;

fn kernels(criterion: &mut Criterion) {
    let turn = |i: usize| TAU * i as f64 / ROWS as f64;
    let velocity: Vec<f64> = (0..ROWS).map(|i| turn(i).sin()).collect();
    let position: Vec<f64> = (0..ROWS).map(|i| -turn(i).cos()).collect();
    let load: Vec<f64> = position.iter().map(|q| 10.0 * q.sin()).collect();
    let temperature: Vec<f64> = (0..ROWS).map(|i| 25.0 + turn(i)).collect();
    let columns = Columns {
        dt: TimeStep::Uniform(0.002),
        channels: Channels {
            velocity: &velocity,
            position: Some(&position),
            load_torque: Some(&load),
            temperature: Some(&temperature),
            ..Channels::default()
        },
        ..Columns::default()
    };
    let models: [(&str, &[&str]); 5] = [
        ("coulomb", &[]),
        ("bittencourt_a", &[]),
        ("lugre", &[]),
        ("coulomb", &["stribeck", "load", "position", "direction", "temperature_dry"]),
        ("bittencourt_a", &["load", "temperature_dry", "temperature_viscous", "position"]),
    ];
    for (law, effects) in models {
        let spec = Spec::new(law, effects.iter().copied()).expect("known ids");
        let values: Vec<f64> = spec.parameters().map(|p| p.start.max(0.01)).collect();
        let mut group = criterion.benchmark_group(spec.to_string());
        group.throughput(Throughput::Elements(ROWS as u64));
        group.bench_function("torque", |b| {
            b.iter(|| batch::torque(&spec, black_box(&values), &columns));
        });
        group.bench_function("gradient", |b| {
            b.iter(|| batch::gradient(&spec, black_box(&values), &columns, None));
        });
        group.bench_function("gradient by two", |b| {
            b.iter(|| batch::gradient(&spec, black_box(&values), &columns, Some(&[0, 1])));
        });
        group.finish();
    }
}

criterion_group!(benches, kernels);
criterion_main!(benches);
