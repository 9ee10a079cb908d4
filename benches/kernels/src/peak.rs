//! The peak number of floating-point operations of this machine, measured.

use std::hint::black_box;

use pulp::{Arch, Simd, WithSimd};

use crate::timing::{elapsed, runs_within};

/// Independent chains: enough to hide the latency, few enough for the registers.
const CHAINS: usize = 12;
/// Operations of each chain per run.
const LENGTH: usize = 4096;
const REPEATS: usize = 1001;

/// Prints one line per kind: the best of many short measurements, in operations per nanosecond.
pub fn print() {
    let kinds: [(&str, Kind); 5] = [
        ("add", Kind::Add),
        ("multiply", Kind::Multiply),
        ("add and multiply", Kind::AddAndMultiply),
        ("divide", Kind::Divide),
        ("square root", Kind::SquareRoot),
    ];
    for (name, kind) in kinds {
        println!("{name}\t{:.4}", best(kind));
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Add,
    Multiply,
    AddAndMultiply,
    Divide,
    SquareRoot,
}

/// Operations per nanosecond.
fn best(kind: Kind) -> f64 {
    let mut work: crate::Work = Box::new(move || {
        Arch::new().dispatch(Chained { kind: black_box(kind) });
    });
    let operations = Arch::new().dispatch(Chained { kind });
    let runs = runs_within(5e-4, &mut work);
    let shortest = (0..REPEATS).map(|_| elapsed(runs, &mut work)).fold(f64::INFINITY, f64::min);
    (operations * runs) as f64 / (1e9 * shortest)
}

/// Independent chains of one kind of operation; returns the number of operations.
struct Chained {
    kind: Kind,
}

impl WithSimd for Chained {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        // Close to 1, so that nothing overflows or becomes subnormal.
        let (one, small) = (simd.splat_f64s(black_box(1.0)), simd.splat_f64s(black_box(1e-9)));
        let chains = LENGTH * CHAINS * S::F64_LANES;
        macro_rules! chained {
            ($step:expr) => {
                simd.vectorize(
                    #[inline(always)]
                    || {
                        let mut x = [one; CHAINS];
                        for _ in 0..LENGTH {
                            x = x.map($step);
                        }
                        black_box(x);
                    },
                )
            };
        }
        match self.kind {
            Kind::Add => chained!(
                #[inline(always)]
                |x| simd.add_f64s(x, small)
            ),
            Kind::Multiply => chained!(
                #[inline(always)]
                |x| simd.mul_f64s(x, one)
            ),
            Kind::AddAndMultiply => {
                chained!(
                    #[inline(always)]
                    |x| simd.mul_f64s(simd.add_f64s(x, small), one)
                );
                return 2 * chains;
            }
            Kind::Divide => chained!(
                #[inline(always)]
                |x| simd.div_f64s(x, one)
            ),
            Kind::SquareRoot => chained!(
                #[inline(always)]
                |x| simd.sqrt_f64s(x)
            ),
        }
        chains
    }
}
