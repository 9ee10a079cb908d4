//! Time per element of the elementary functions: one number at a time, in a vectorised loop, and
//! for comparison `libm` and the standard library.
// The functions compared with are banned in the crate.
#![allow(clippy::disallowed_methods)]

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use stribeck::math;

/// Number of elements; two columns of them fit into the first-level cache.
const COUNT: usize = 1024;

/// Compiles the same loop for AVX2 with eight lanes, so that two chains of operations run in
/// parallel.
macro_rules! packed {
    ($float:ident, $function:expr) => {{
        #[cfg_attr(target_arch = "x86_64", target_feature(enable = "avx2"))]
        fn packed(arguments: &[$float], values: &mut [$float]) {
            let lanes = arguments.as_chunks::<8>().0.iter().zip(values.as_chunks_mut::<8>().0);
            for (arguments, values) in lanes {
                *values = arguments.map($function);
            }
        }
        packed
    }};
}

macro_rules! compare {
    ($group:expr, $float:ident, $low:expr, $high:expr,
     own: $own:expr, libm: $libm:expr, std: $std:expr) => {{
        let group: &mut BenchmarkGroup<WallTime> = $group;
        // In an order that branch prediction cannot learn.
        let turn = |i: usize| (i * 7919 % COUNT) as $float / COUNT as $float;
        let arguments: Vec<$float> = (0..COUNT).map(|i| $low + ($high - $low) * turn(i)).collect();
        let mut values = arguments.clone();
        let one_by_one: [(&str, fn($float) -> $float); 3] =
            [("alone", $own), ("libm", $libm), ("std", $std)];
        for (name, function) in one_by_one {
            let function = black_box(function);
            group.bench_function(format!("{} {name}", stringify!($float)), |b| {
                b.iter(|| {
                    for (value, &x) in values.iter_mut().zip(black_box(&arguments)) {
                        *value = function(x);
                    }
                });
            });
        }
        if cfg!(target_arch = "x86_64") && !std::arch::is_x86_feature_detected!("avx2") {
            return;
        }
        let packed = packed!($float, $own);
        group.bench_function(concat!(stringify!($float), " packed"), |b| {
            // SAFETY: the processor supports AVX2.
            b.iter(|| unsafe { packed(black_box(&arguments), black_box(&mut values)) });
        });
    }};
}

/// A benchmark of one function in both formats.
macro_rules! benchmark {
    ($name:ident, $low:expr, $high:expr,
     own: $own:ident, libm: $libm:ident $single_libm:ident, std: $std:ident) => {
        benchmark!($name, $low, $high,
            own: |x| math::f64::$own(x), |x| math::f32::$own(x),
            libm: |x| libm::$libm(x), |x| libm::$single_libm(x),
            std: |x| f64::$std(x), |x| f32::$std(x));
    };
    ($name:ident, $low:expr, $high:expr, own: $own:expr, $single_own:expr,
     libm: $libm:expr, $single_libm:expr, std: $std:expr, $single_std:expr) => {
        fn $name(criterion: &mut Criterion) {
            let mut group = criterion.benchmark_group(stringify!($name));
            group.throughput(Throughput::Elements(COUNT as u64));
            compare!(&mut group, f64, $low, $high, own: $own, libm: $libm, std: $std);
            compare!(&mut group, f32, $low, $high,
                own: $single_own, libm: $single_libm, std: $single_std);
        }
    };
}

benchmark!(exp, -20.0, 5.0, own: exp, libm: exp expf, std: exp);
benchmark!(expm1, -20.0, 1.0, own: expm1, libm: expm1 expm1f, std: exp_m1);
benchmark!(ln, 0.01, 9.0, own: ln, libm: log logf, std: ln);
benchmark!(tanh, -5.0, 5.0, own: tanh, libm: tanh tanhf, std: tanh);
benchmark!(atan, -5.0, 5.0, own: atan, libm: atan atanf, std: atan);
benchmark!(powf, 0.01, 9.0,
    own: |x| math::f64::powf(x, 1.37), |x| math::f32::powf(x, 1.37),
    libm: |x| libm::pow(x, 1.37), |x| libm::powf(x, 1.37),
    std: |x| x.powf(1.37), |x| x.powf(1.37));
benchmark!(sin_cos, -5.0, 5.0,
    own: |x| sum(math::f64::sin_cos_fast(x)), |x| sum(math::f32::sin_cos_fast(x)),
    libm: |x| sum(libm::sincos(x)), |x| sum(libm::sincosf(x)),
    std: |x| sum(x.sin_cos()), |x| sum(x.sin_cos()));

/// A single number that depends on both.
#[inline(always)]
fn sum<T: std::ops::Add<Output = T>>((sin, cos): (T, T)) -> T {
    sin + cos
}

criterion_group!(benches, exp, expm1, ln, tanh, atan, powf, sin_cos);
criterion_main!(benches);
