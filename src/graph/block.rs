//! One loop per operation over a block of samples. All blocks have the same length, so that no loop
//! has a remainder.

use core::cell::Cell;
use core::hint::select_unpredictable;

use super::operation::{Binary, Unary};
use crate::math::{cbrt_fast, f64 as elementary};
use crate::scalar::Real;

/// Numbers per block: the results of all operations fit into the first-level cache.
pub const BLOCK: usize = 256;

/// Memory of one block, aligned to a cache line: vector loads and stores that cross two lines cost
/// double.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Buffer<const N: usize = BLOCK>(pub [f64; N]);

impl<const N: usize> Buffer<N> {
    /// All zeros.
    pub const ZERO: Self = Self([0.0; N]);
}

/// An operand: one number per sample, or one for all.
#[derive(Clone, Copy, Debug)]
pub enum Operand<'a, const N: usize = BLOCK> {
    /// One number for all samples.
    Same(f64),
    /// One number per sample.
    Each(&'a [f64; N]),
}

impl<const N: usize> Operand<'_, N> {
    /// The value at one sample.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, row: usize) -> f64 {
        match self {
            Self::Same(x) => *x,
            Self::Each(rows) => rows[row],
        }
    }
}

const fn mask(yes: bool) -> f64 {
    if yes { 1.0 } else { 0.0 }
}

#[inline(always)]
pub fn map<const N: usize>(out: &mut [f64; N], x: Operand<'_, N>, f: impl Fn(f64) -> f64) {
    match x {
        Operand::Same(x) => out.fill(f(x)),
        Operand::Each(x) => {
            for (out, &x) in out.iter_mut().zip(x) {
                *out = f(x);
            }
        }
    }
}

#[inline(always)]
pub fn zip<const N: usize>(
    out: &mut [f64; N],
    x: Operand<'_, N>,
    y: Operand<'_, N>,
    f: impl Fn(f64, f64) -> f64,
) {
    match (x, y) {
        (Operand::Same(x), y) => map(out, y, |y| f(x, y)),
        (x, Operand::Same(y)) => map(out, x, |x| f(x, y)),
        (Operand::Each(x), Operand::Each(y)) => {
            for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                *out = f(x, y);
            }
        }
    }
}

/// Memory for the halves of a function; its content does not matter.
pub type Halves<const N: usize = BLOCK> = [Buffer<N>; 2];

/// A unary operation on each sample.
#[inline(always)]
pub fn unary<const N: usize>(
    out: &mut [f64; N],
    operation: Unary,
    x: Operand<'_, N>,
    halves: &mut Halves<N>,
) {
    match operation {
        Unary::Negate => map(out, x, |x| -x),
        Unary::Abs => map(out, x, f64::abs),
        Unary::Sign => map(out, x, Real::sign),
        Unary::Exp => exponential(out, x, halves, |x| x),
        Unary::Expm1 => {
            in_halves(out, x, halves, elementary::expm1_reduced, elementary::expm1_of_reduced);
        }
        Unary::Ln => map(out, x, elementary::ln),
        Unary::Sqrt => map(out, x, elementary::sqrt),
        Unary::Cbrt => cube_root(out, x),
        Unary::Sin => sin_or_cos(out, x, |(sin, _)| sin),
        Unary::Cos => sin_or_cos(out, x, |(_, cos)| cos),
        Unary::Tanh => {
            in_halves(out, x, halves, elementary::tanh_reduced, elementary::tanh_of_reduced);
        }
        Unary::Atan => map(out, x, elementary::atan),
        Unary::Phi(order) => map(out, x, |x| elementary::phi(order, x)),
        Unary::IsFinite => map(out, x, |x| mask(x.is_finite())),
        Unary::Not => map(out, x, |x| 1.0 - x),
    }
}

/// `e^f(x)`. Where no result is at the end of the range of numbers the second half is shorter.
#[inline(always)]
pub fn exponential<const N: usize>(
    out: &mut [f64; N],
    x: Operand<'_, N>,
    halves: &mut Halves<N>,
    f: impl Fn(f64) -> f64,
) {
    let Operand::Each(x) = x else { return map(out, x, |x| elementary::exp(f(x))) };
    let [large, small] = halves;
    let mut usual = true;
    let parts = large.0.iter_mut().zip(&mut small.0);
    for ((n, &x), (large, small)) in out.iter_mut().zip(x).zip(parts) {
        (*n, (*large, *small)) = elementary::exp_reduced(f(x));
        usual &= elementary::is_usual_exp(x);
    }
    let parts = large.0.iter().zip(&small.0);
    if usual {
        for (out, (&large, &small)) in out.iter_mut().zip(parts) {
            *out = elementary::usual_exp_of_reduced(*out, (large, small));
        }
    } else {
        for (out, (&large, &small)) in out.iter_mut().zip(parts) {
            *out = elementary::exp_of_reduced(*out, (large, small));
        }
    }
}

/// A function in two loops: a processor looks only so many operations ahead, so that shorter ones
/// keep more independent operations in flight.
#[inline(always)]
fn in_halves<const N: usize>(
    out: &mut [f64; N],
    x: Operand<'_, N>,
    [large, small]: &mut Halves<N>,
    first: impl Fn(f64) -> (f64, (f64, f64)),
    second: impl Fn(f64, f64, (f64, f64)) -> f64,
) {
    let Operand::Each(x) = x else {
        return map(out, x, |x| {
            let (n, rest) = first(x);
            second(x, n, rest)
        });
    };
    let parts = large.0.iter_mut().zip(&mut small.0);
    for ((n, &x), (large, small)) in out.iter_mut().zip(x).zip(parts) {
        (*n, (*large, *small)) = first(x);
    }
    let parts = large.0.iter().zip(&small.0);
    for ((out, &x), (&large, &small)) in out.iter_mut().zip(x).zip(parts) {
        *out = second(x, *out, (large, small));
    }
}

/// Sine or cosine; the few large arguments are recomputed with the exact reduction.
#[inline(always)]
fn sin_or_cos<const N: usize>(
    out: &mut [f64; N],
    x: Operand<'_, N>,
    of: impl Fn((f64, f64)) -> f64,
) {
    map(out, x, |x| of(elementary::sin_cos_fast(x)));
    for (row, out) in out.iter_mut().enumerate() {
        if elementary::needs_exact_reduction(x.at(row)) {
            *out = of(elementary::sin_cos(x.at(row)));
        }
    }
}

/// Cube roots; the few that are not certain are recomputed.
#[inline(always)]
fn cube_root<const N: usize>(out: &mut [f64; N], x: Operand<'_, N>) {
    map(out, x, cbrt_fast);
    if any_nan(out) {
        for (row, out) in out.iter_mut().enumerate().filter(|(_, out)| out.is_nan()) {
            *out = elementary::cbrt(x.at(row));
        }
    }
}

/// A binary operation on each sample.
#[inline(always)]
pub fn binary<const N: usize>(
    out: &mut [f64; N],
    operation: Binary,
    x: Operand<'_, N>,
    y: Operand<'_, N>,
    halves: &mut Halves<N>,
) {
    match operation {
        Binary::Add => zip(out, x, y, |x, y| x + y),
        Binary::Subtract => zip(out, x, y, |x, y| x - y),
        Binary::Multiply | Binary::And => zip(out, x, y, |x, y| x * y),
        Binary::Divide => zip(out, x, y, |x, y| x / y),
        Binary::Power => power(out, x, y, halves),
        Binary::Below => zip(out, x, y, |x, y| mask(x < y)),
        Binary::Above => zip(out, x, y, |x, y| mask(x > y)),
        Binary::Equal => zip(out, x, y, |x, y| mask(x == y)),
        Binary::Or => zip(out, x, y, |x, y| if x > y { x } else { y }),
        Binary::Chain => chain_each(out, x, y),
    }
}

/// Powers. For an exponent that all samples share, the special cases are checked once.
#[inline(always)]
fn power<const N: usize>(
    out: &mut [f64; N],
    x: Operand<'_, N>,
    p: Operand<'_, N>,
    halves: &mut Halves<N>,
) {
    let plain = elementary::is_plain_exponent;
    match (x, p) {
        (x, Operand::Same(1.0)) => map(out, x, |x| elementary::powf(x, 1.0)),
        (x, Operand::Same(2.0)) => map(out, x, |x| elementary::powf(x, 2.0)),
        (Operand::Each(x), Operand::Same(p)) if plain(p) => {
            if exponent_each(out, x, |_| p, halves) {
                for (out, &fraction) in out.iter_mut().zip(&halves[0].0) {
                    *out = elementary::usual_power((*out, fraction));
                }
                return;
            }
            for ((out, &x), &fraction) in out.iter_mut().zip(x).zip(&halves[0].0) {
                *out = elementary::powf_of_exponent(x, (*out, fraction), p);
            }
            recompute_nan_powers(out, x, |_| p);
        }
        (Operand::Each(x), Operand::Each(p)) => {
            exponent_each(out, x, |row| p[row], halves);
            let each = p.iter().zip(&halves[0].0);
            for ((out, &x), (&p, &fraction)) in out.iter_mut().zip(x).zip(each) {
                let power = elementary::powf_of_exponent(x, (*out, fraction), p);
                *out = elementary::power_without_logarithm(power, x, p);
            }
            recompute_nan_powers(out, x, |row| p[row]);
        }
        (x, p) => zip(out, x, p, elementary::powf),
    }
}

/// The powers of two that equal the powers: writes the integer parts and, to the first of `halves`,
/// the fractions. Whether none is a special case.
#[inline(always)]
fn exponent_each<const N: usize>(
    out: &mut [f64; N],
    x: &[f64; N],
    p: impl Fn(usize) -> f64,
    [one, other]: &mut Halves<N>,
) -> bool {
    for ((k, &x), (s, low)) in out.iter_mut().zip(x).zip(one.0.iter_mut().zip(&mut other.0)) {
        (*k, (*s, *low)) = elementary::log2_quotient(x);
    }
    for ((out, one), &low) in out.iter_mut().zip(&mut one.0).zip(&other.0) {
        (*out, *one) = elementary::log2_of_quotient(*out, (*one, low));
    }
    let mut usual = true;
    for (row, ((out, &x), one)) in out.iter_mut().zip(x).zip(&mut one.0).enumerate() {
        (*out, *one) = elementary::exponent_fast((*out, *one), p(row));
        usual &= elementary::is_usual_power(x, *out);
    }
    usual
}

/// Recomputes the results that are NaN: special cases.
#[inline(always)]
fn recompute_nan_powers<const N: usize>(
    out: &mut [f64; N],
    x: &[f64; N],
    p: impl Fn(usize) -> f64,
) {
    if any_nan(out) {
        for (row, (out, &x)) in out.iter_mut().zip(x).enumerate() {
            if out.is_nan() {
                *out = elementary::powf(x, p(row));
            }
        }
    }
}

/// Products of slopes and derivatives; recomputed by [`chain`] where one is NaN.
#[inline(always)]
fn chain_each<const N: usize>(out: &mut [f64; N], slope: Operand<'_, N>, by: Operand<'_, N>) {
    let nan = Cell::new(false);
    zip(out, slope, by, |slope, by| {
        let product = slope * by;
        nan.set(nan.get() | product.is_nan());
        product
    });
    if nan.get() {
        zip(out, slope, by, chain);
    }
}

#[inline(always)]
pub fn any_nan<const N: usize>(numbers: &[f64; N]) -> bool {
    numbers.iter().fold(false, |any, x| any | x.is_nan())
}

/// A slope times a derivative: 0 where either is 0, even if the other is infinite.
#[inline(always)]
pub fn chain(slope: f64, by: f64) -> f64 {
    let product = slope * by;
    if slope == 0.0 || by == 0.0 { 0.0 } else { product }
}

/// `yes` where the mask is not 0, else `no`.
#[inline(always)]
pub fn choose<const N: usize>(
    out: &mut [f64; N],
    mask: Operand<'_, N>,
    yes: Operand<'_, N>,
    no: Operand<'_, N>,
) {
    match (mask, yes, no) {
        (Operand::Same(mask), yes, no) => map(out, if mask == 0.0 { no } else { yes }, |x| x),
        (mask, Operand::Same(yes), no) => {
            zip(out, mask, no, |mask, no| if mask == 0.0 { no } else { yes });
        }
        (mask, yes, Operand::Same(no)) => {
            zip(out, mask, yes, |mask, yes| if mask == 0.0 { no } else { yes });
        }
        (Operand::Each(mask), Operand::Each(yes), Operand::Each(no)) => {
            for (((out, &mask), &yes), &no) in out.iter_mut().zip(mask).zip(yes).zip(no) {
                // With an `if` the compiler selects an address per sample instead of a value.
                *out = select_unpredictable(mask == 0.0, no, yes);
            }
        }
    }
}

/// A unary operation on a single number.
pub fn unary_once(operation: Unary, x: f64) -> f64 {
    let mut out = [0.0];
    unary(&mut out, operation, Operand::Same(x), &mut [Buffer([0.0]); 2]);
    out[0]
}

/// A binary operation on single numbers.
pub fn binary_once(operation: Binary, x: f64, y: f64) -> f64 {
    let mut out = [0.0];
    binary(&mut out, operation, Operand::Same(x), Operand::Same(y), &mut [Buffer([0.0]); 2]);
    out[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bits of `block` and of single numbers, for numbers within the usual range, and with others
    /// among them.
    fn same_bits(
        usual: [f64; 4],
        others: [f64; 4],
        block: impl Fn(&mut [f64; 8], Operand<'_, 8>, &mut Halves<8>),
        single: impl Fn(f64) -> f64,
    ) {
        for last in [usual, others] {
            let x: [f64; 8] = core::array::from_fn(|i| if i < 4 { usual[i] } else { last[i - 4] });
            let mut out = [0.0; 8];
            block(&mut out, Operand::Each(&x), &mut [Buffer::ZERO; 2]);
            assert_eq!(out.map(f64::to_bits), x.map(|x| single(x).to_bits()), "{x:?}");
        }
    }

    #[test]
    fn blocks_with_and_without_special_cases_have_the_bits_of_single_numbers() {
        same_bits(
            [0.3, 1.0, 17.0, 1e-200],
            [0.0, 5e-324, 1e300, f64::INFINITY],
            |out, x, halves| binary(out, Binary::Power, x, Operand::Same(1.3), halves),
            |x| elementary::powf(x, 1.3),
        );
        same_bits(
            [-511.0, -0.0, 0.7, 511.0],
            [-745.0, 709.7, f64::NEG_INFINITY, 1e4],
            |out, x, halves| unary(out, Unary::Exp, x, halves),
            elementary::exp,
        );
    }
}
