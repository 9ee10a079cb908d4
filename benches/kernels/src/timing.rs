//! Nanoseconds per row, with the kernels measured in turn.

use std::time::Instant;

use crate::{Kernel, Work};

/// Runs of each kernel in one measurement last about this long (s).
const LENGTH: f64 = 2e-3;
/// Measurements of each kernel, interleaved so that other load on the machine affects all of them.
const REPEATS: usize = 101;

/// Prints one line per kernel: the median.
pub fn print<'a>(kernels: impl Iterator<Item = &'a Kernel>) {
    let mut ready: Vec<(&Kernel, Work, usize, Vec<f64>)> = kernels
        .map(|kernel| {
            let mut work = (kernel.prepare)();
            let runs = runs_within(LENGTH, &mut work);
            (kernel, work, runs, Vec::with_capacity(REPEATS))
        })
        .collect();
    for _ in 0..REPEATS {
        for (_, work, runs, seconds) in &mut ready {
            seconds.push(elapsed(*runs, work));
        }
    }
    for (kernel, _, runs, mut seconds) in ready {
        seconds.sort_by(f64::total_cmp);
        let each = seconds[REPEATS / 2] / (runs * kernel.rows) as f64;
        println!("{}\t{}\t{:.4}", kernel.name, kernel.rows, 1e9 * each);
    }
}

/// Number of runs within a time (s), at least one.
pub fn runs_within(length: f64, work: &mut Work) -> usize {
    let mut runs = 1;
    while elapsed(runs, work) < length {
        runs *= 2;
    }
    runs
}

/// Duration of that many runs (s).
pub fn elapsed(runs: usize, work: &mut Work) -> f64 {
    let begin = Instant::now();
    (0..runs).for_each(|_| work());
    begin.elapsed().as_secs_f64()
}
