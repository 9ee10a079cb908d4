//! The loops over a block of rows, one an operation. All blocks are of one length: no loop has a rest.

use core::cell::Cell;
use core::hint::select_unpredictable;

use super::operation::{Binary, Unary};
use crate::math::f64 as elementary;
use crate::scalar::Real;

/// Numbers of a block: what all operations leave stays in the first cache.
pub const BLOCK: usize = 256;

/// Room for a block. It begins with a line of the cache: a vector as long as a line that lay across
/// two of them would be read and written twice.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Buffer<const N: usize = BLOCK>(pub [f64; N]);

impl<const N: usize> Buffer<N> {
    /// Of zeros.
    pub const ZERO: Self = Self([0.0; N]);
}

/// What an operation takes: one number a row, or the same for all.
#[derive(Clone, Copy, Debug)]
pub enum Operand<'a, const N: usize = BLOCK> {
    /// The same.
    Same(f64),
    /// One a row.
    Each(&'a [f64; N]),
}

impl<const N: usize> Operand<'_, N> {
    /// That of one row.
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
fn map<const N: usize>(out: &mut [f64; N], x: Operand<'_, N>, f: impl Fn(f64) -> f64) {
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
fn zip<const N: usize>(
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

/// An operation on one number of each row.
#[inline(always)]
pub fn unary<const N: usize>(out: &mut [f64; N], operation: Unary, x: Operand<'_, N>) {
    match operation {
        Unary::Negate => map(out, x, |x| -x),
        Unary::Abs => map(out, x, f64::abs),
        Unary::Sign => map(out, x, Real::sign),
        Unary::Exp => map(out, x, elementary::exp),
        Unary::Expm1 => map(out, x, elementary::expm1),
        Unary::Ln => map(out, x, elementary::ln),
        Unary::Sqrt => map(out, x, elementary::sqrt),
        Unary::Cbrt => map(out, x, elementary::cbrt),
        Unary::Sin => wave(out, x, |(sin, _)| sin),
        Unary::Cos => wave(out, x, |(_, cos)| cos),
        Unary::Tanh => map(out, x, elementary::tanh),
        Unary::Atan => map(out, x, elementary::atan),
        Unary::Phi(order) => map(out, x, |x| elementary::phi(order, x)),
        Unary::IsFinite => map(out, x, |x| mask(x.is_finite())),
        Unary::Not => map(out, x, |x| 1.0 - x),
    }
}

/// Sine or cosine: the few phases that need care are mended.
#[inline(always)]
fn wave<const N: usize>(out: &mut [f64; N], x: Operand<'_, N>, of: impl Fn((f64, f64)) -> f64) {
    map(out, x, |x| of(elementary::sin_cos_fast(x)));
    for (row, out) in out.iter_mut().enumerate() {
        if elementary::needs_care(x.at(row)) {
            *out = of(elementary::sin_cos(x.at(row)));
        }
    }
}

/// An operation on two numbers of each row.
#[inline(always)]
pub fn binary<const N: usize>(
    out: &mut [f64; N],
    operation: Binary,
    x: Operand<'_, N>,
    y: Operand<'_, N>,
) {
    match operation {
        Binary::Add => zip(out, x, y, |x, y| x + y),
        Binary::Subtract => zip(out, x, y, |x, y| x - y),
        Binary::Multiply | Binary::And => zip(out, x, y, |x, y| x * y),
        Binary::Divide => zip(out, x, y, |x, y| x / y),
        Binary::Power => power(out, x, y),
        Binary::Below => zip(out, x, y, |x, y| mask(x < y)),
        Binary::Above => zip(out, x, y, |x, y| mask(x > y)),
        Binary::Equal => zip(out, x, y, |x, y| mask(x == y)),
        Binary::Or => zip(out, x, y, |x, y| if x > y { x } else { y }),
        Binary::Chain => chain_all(out, x, y),
    }
}

/// Of an exponent that all rows share the special cases are looked at once.
#[inline(always)]
fn power<const N: usize>(out: &mut [f64; N], x: Operand<'_, N>, p: Operand<'_, N>) {
    let plain = elementary::is_plain_exponent;
    match (x, p) {
        (x, Operand::Same(1.0)) => map(out, x, |x| elementary::powf(x, 1.0)),
        (x, Operand::Same(2.0)) => map(out, x, |x| elementary::powf(x, 2.0)),
        (Operand::Each(x), Operand::Same(p)) if plain(p) => {
            let low = logarithms(x, out);
            for ((out, &x), &low) in out.iter_mut().zip(x).zip(&low.0) {
                *out = elementary::powf_fast(x, (*out, low), p);
            }
            mend_powers(out, x, |_| p);
        }
        (Operand::Each(x), Operand::Each(p)) => {
            let low = logarithms(x, out);
            for ((out, &x), (&p, &low)) in out.iter_mut().zip(x).zip(p.iter().zip(&low.0)) {
                let power = elementary::powf_fast(x, (*out, low), p);
                *out = elementary::power_without_logarithm(power, x, p);
            }
            mend_powers(out, x, |row| p[row]);
        }
        (x, p) => zip(out, x, p, elementary::powf),
    }
}

/// High parts and, returned, low parts. Two loops keep more rows under way than one.
#[inline(always)]
fn logarithms<const N: usize>(x: &[f64; N], high: &mut [f64; N]) -> Buffer<N> {
    let mut lows = Buffer::ZERO;
    for ((&x, high), low) in x.iter().zip(high).zip(&mut lows.0) {
        (*high, *low) = elementary::log2_fast(x);
    }
    lows
}

/// The few bases and exponents that need care.
#[inline(always)]
fn mend_powers<const N: usize>(out: &mut [f64; N], x: &[f64; N], p: impl Fn(usize) -> f64) {
    if any_nan(out) {
        for (row, (out, &x)) in out.iter_mut().zip(x).enumerate() {
            if out.is_nan() {
                *out = elementary::powf(x, p(row));
            }
        }
    }
}

/// Products; the few that are no numbers are mended.
#[inline(always)]
fn chain_all<const N: usize>(out: &mut [f64; N], slope: Operand<'_, N>, by: Operand<'_, N>) {
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
fn any_nan<const N: usize>(numbers: &[f64; N]) -> bool {
    numbers.iter().fold(false, |any, x| any | x.is_nan())
}

/// A slope times a derivative; nothing where one of them is nothing.
#[inline(always)]
fn chain(slope: f64, by: f64) -> f64 {
    let product = slope * by;
    if slope == 0.0 || by == 0.0 { 0.0 } else { product }
}

/// The second where the mask holds, else the third.
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
                // An `if` would be made a choice of the place to read from, row by row.
                *out = select_unpredictable(mask == 0.0, no, yes);
            }
        }
    }
}

/// The same operation on single numbers.
pub fn unary_once(operation: Unary, x: f64) -> f64 {
    let mut out = [0.0];
    unary(&mut out, operation, Operand::Same(x));
    out[0]
}

/// The same operation on single numbers.
pub fn binary_once(operation: Binary, x: f64, y: f64) -> f64 {
    let mut out = [0.0];
    binary(&mut out, operation, Operand::Same(x), Operand::Same(y));
    out[0]
}
