//! One loop for several operations over a block of samples.

use super::block::{Halves, Operand, any_nan, chain, exponential, zip};
use super::merge::{Step, Steps, Work};

/// Several operations on each sample.
#[inline(always)]
pub fn run<const N: usize>(
    out: &mut [f64; N],
    work: Work,
    from: [Operand<'_, N>; 4],
    halves: &mut Halves<N>,
) {
    let [x, y, z, w] = from;
    match work {
        Work::Single(_) => {}
        Work::Steps(all) => steps(out, &all, from),
        Work::AbsoluteQuotient => zip(out, x, y, |x, y| (x / y).abs()),
        Work::NegativeExponential => exponential(out, x, halves, |x| -x),
        Work::NegativeUnless => {
            let (other, equal) = (y.at(0), -z.at(0));
            zip(out, x, w, |x, differs| if x == other { equal } else { -differs });
        }
    }
}

/// A step whose kind the compiler knows.
trait Known {
    fn step(x: f64, y: f64) -> f64;
}

struct Plus;
struct Minus;
struct Times;

impl Known for Plus {
    #[inline(always)]
    fn step(x: f64, y: f64) -> f64 {
        x + y
    }
}

impl Known for Minus {
    #[inline(always)]
    fn step(x: f64, y: f64) -> f64 {
        x - y
    }
}

impl Known for Times {
    #[inline(always)]
    fn step(x: f64, y: f64) -> f64 {
        x * y
    }
}

/// The loop for each combination of steps.
macro_rules! with_known {
    ($step:expr, $known:ident => $loop:expr) => {
        match $step {
            Step::Add => {
                type $known = Plus;
                $loop
            }
            Step::Subtract => {
                type $known = Minus;
                $loop
            }
            Step::Multiply | Step::Chain => {
                type $known = Times;
                $loop
            }
        }
    };
}

#[inline(always)]
fn steps<const N: usize>(out: &mut [f64; N], steps: &Steps, from: [Operand<'_, N>; 4]) {
    match (steps.as_slice(), from) {
        (&[a, b], [Operand::Each(x), Operand::Each(y), Operand::Each(z), _]) => {
            with_known!(a, A => with_known!(b, B => {
                for ((out, &x), (&y, &z)) in out.iter_mut().zip(x).zip(y.iter().zip(z)) {
                    *out = B::step(A::step(x, y), z);
                }
            }));
        }
        (&[a, b, c], [Operand::Each(x), Operand::Each(y), Operand::Each(z), Operand::Each(w)]) => {
            with_known!(a, A => with_known!(b, B => with_known!(c, C => {
                let others = y.iter().zip(z.iter().zip(w));
                for ((out, &x), (&y, (&z, &w))) in out.iter_mut().zip(x).zip(others) {
                    *out = C::step(B::step(A::step(x, y), z), w);
                }
            })));
        }
        _ => return one_by_one(out, steps, from),
    }
    // Where a slope is infinite and a derivative 0.
    if steps.as_slice().contains(&Step::Chain) && any_nan(out) {
        one_by_one(out, steps, from);
    }
}

/// The steps sample by sample.
fn one_by_one<const N: usize>(out: &mut [f64; N], steps: &Steps, from: [Operand<'_, N>; 4]) {
    let [first, others @ ..] = from;
    for (row, out) in out.iter_mut().enumerate() {
        let all = steps.as_slice().iter().zip(others);
        *out = all.fold(first.at(row), |x, (step, y)| match (step, y.at(row)) {
            (Step::Add, y) => x + y,
            (Step::Subtract, y) => x - y,
            (Step::Multiply, y) => x * y,
            (Step::Chain, y) => chain(x, y),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::block::Buffer;

    #[test]
    fn zero_times_infinity_is_zero_within_a_loop() {
        let (infinite, zero) = ([f64::INFINITY, 2.0], [0.0, 3.0]);
        let all = Steps::NONE.then(Step::Chain).then(Step::Add);
        let from = [&infinite, &zero, &[1.0; 2], &zero].map(Operand::Each);
        let mut out = [0.0; 2];
        run(&mut out, Work::Steps(all), from, &mut [Buffer([0.0; 2]); 2]);
        assert_eq!(out, [1.0, 7.0]);
    }
}
