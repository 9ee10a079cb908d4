//! The loops over a block of rows, one an operation.

use core::cell::Cell;
use core::ops::Range;

use super::operation::{Binary, Unary};
use crate::math::f64 as elementary;
use crate::scalar::Real;

/// Numbers of a block: what all operations leave stays in the first cache.
pub const BLOCK: usize = 256;

/// Room for a block. It begins with a line of the cache: a vector as long as a line that lay across
/// two of them would be read and written twice.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Buffer(pub [f64; BLOCK]);

impl Buffer {
    /// Of zeros.
    pub const ZERO: Self = Self([0.0; BLOCK]);
}

/// Numbers of a block: one a row, or the same for all.
#[derive(Clone, Copy, Debug)]
pub enum Numbers<'a> {
    /// The same.
    Same(f64),
    /// One a row.
    Each(&'a [f64]),
}

impl Numbers<'_> {
    /// That of one row.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, row: usize) -> f64 {
        match self {
            Self::Same(x) => *x,
            Self::Each(rows) => rows[row],
        }
    }

    /// Those of some rows.
    #[inline(always)]
    #[must_use]
    pub fn part(&self, rows: &Range<usize>) -> Self {
        match *self {
            Self::Same(x) => Self::Same(x),
            Self::Each(all) => Self::Each(&all[rows.clone()]),
        }
    }

    /// Products with a factor.
    #[inline(always)]
    pub fn times(&self, factor: f64, out: &mut [f64]) {
        map(out, *self, |x| x * factor);
    }

    /// Differences to other numbers.
    #[inline(always)]
    pub fn subtracted_from(&self, others: &[f64], out: &mut [f64]) {
        zip(out, Numbers::Each(others), *self, |other, x| other - x);
    }

    /// Copies them.
    #[inline(always)]
    pub fn copy_to(&self, out: &mut [f64]) {
        match self {
            Self::Same(x) => out.fill(*x),
            Self::Each(rows) => out.copy_from_slice(rows),
        }
    }

    /// Puts sums with a number into places, one a row.
    #[inline(always)]
    pub fn add_to_each<'o>(&self, number: f64, out: impl Iterator<Item = &'o mut f64>) {
        match self {
            Self::Same(x) => out.for_each(|out| *out = x + number),
            Self::Each(rows) => out.zip(*rows).for_each(|(out, x)| *out = x + number),
        }
    }
}

const fn mask(yes: bool) -> f64 {
    if yes { 1.0 } else { 0.0 }
}

#[inline(always)]
fn map(out: &mut [f64], x: Numbers<'_>, f: impl Fn(f64) -> f64) {
    match x {
        Numbers::Same(x) => out.fill(f(x)),
        Numbers::Each(x) => {
            for (out, &x) in out.iter_mut().zip(x) {
                *out = f(x);
            }
        }
    }
}

#[inline(always)]
fn zip(out: &mut [f64], x: Numbers<'_>, y: Numbers<'_>, f: impl Fn(f64, f64) -> f64) {
    match (x, y) {
        (Numbers::Same(x), y) => map(out, y, |y| f(x, y)),
        (x, Numbers::Same(y)) => map(out, x, |x| f(x, y)),
        (Numbers::Each(x), Numbers::Each(y)) => {
            for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                *out = f(x, y);
            }
        }
    }
}

/// An operation on one number of each row.
#[inline(always)]
pub fn unary(out: &mut [f64], operation: Unary, x: Numbers<'_>) {
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
fn wave(out: &mut [f64], x: Numbers<'_>, of: impl Fn((f64, f64)) -> f64) {
    map(out, x, |x| of(elementary::sin_cos_fast(x)));
    for (row, out) in out.iter_mut().enumerate() {
        if elementary::needs_care(x.at(row)) {
            *out = of(elementary::sin_cos(x.at(row)));
        }
    }
}

/// An operation on two numbers of each row.
#[inline(always)]
pub fn binary(out: &mut [f64], operation: Binary, x: Numbers<'_>, y: Numbers<'_>) {
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
fn power(out: &mut [f64], x: Numbers<'_>, p: Numbers<'_>) {
    let plain = elementary::is_plain_exponent;
    match (x, p) {
        (x, Numbers::Same(1.0)) => map(out, x, |x| elementary::powf(x, 1.0)),
        (x, Numbers::Same(2.0)) => map(out, x, |x| elementary::powf(x, 2.0)),
        (Numbers::Each(x), Numbers::Same(p)) if plain(p) => {
            let (mut high, mut low) = (Buffer::ZERO, Buffer::ZERO);
            logarithms(x, &mut high.0, &mut low.0);
            for (((out, &x), high), low) in out.iter_mut().zip(x).zip(high.0).zip(low.0) {
                *out = elementary::powf_fast(x, (high, low), p);
            }
            mend_powers(out, x, |_| p);
        }
        (Numbers::Each(x), Numbers::Each(p)) => {
            let (mut high, mut low) = (Buffer::ZERO, Buffer::ZERO);
            logarithms(x, &mut high.0, &mut low.0);
            let rows = x.iter().zip(p).zip(high.0).zip(low.0);
            for (out, (((&x, &p), high), low)) in out.iter_mut().zip(rows) {
                let power = elementary::powf_fast(x, (high, low), p);
                *out = if plain(p) { power } else { f64::NAN };
            }
            mend_powers(out, x, |row| p[row]);
        }
        (x, p) => zip(out, x, p, elementary::powf),
    }
}

/// Two loops keep more rows under way than one.
#[inline(always)]
fn logarithms(x: &[f64], high: &mut [f64; BLOCK], low: &mut [f64; BLOCK]) {
    for ((&x, high), low) in x.iter().zip(high).zip(low) {
        (*high, *low) = elementary::log2_fast(x);
    }
}

/// The few bases and exponents that need care.
#[inline(always)]
fn mend_powers(out: &mut [f64], x: &[f64], p: impl Fn(usize) -> f64) {
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
fn chain_all(out: &mut [f64], slope: Numbers<'_>, by: Numbers<'_>) {
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
fn any_nan(numbers: &[f64]) -> bool {
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
pub fn choose(out: &mut [f64], mask: Numbers<'_>, yes: Numbers<'_>, no: Numbers<'_>) {
    match (mask, yes, no) {
        (Numbers::Same(mask), yes, no) => map(out, if mask == 0.0 { no } else { yes }, |x| x),
        (mask, Numbers::Same(yes), no) => {
            zip(out, mask, no, |mask, no| if mask == 0.0 { no } else { yes });
        }
        (mask, yes, Numbers::Same(no)) => {
            zip(out, mask, yes, |mask, yes| if mask == 0.0 { no } else { yes });
        }
        (Numbers::Each(mask), Numbers::Each(yes), Numbers::Each(no)) => {
            for (((out, &mask), &yes), &no) in out.iter_mut().zip(mask).zip(yes).zip(no) {
                *out = if mask == 0.0 { no } else { yes };
            }
        }
    }
}

/// The same operation on single numbers.
pub fn unary_once(operation: Unary, x: f64) -> f64 {
    let mut out = [0.0];
    unary(&mut out, operation, Numbers::Same(x));
    out[0]
}

/// The same operation on single numbers.
pub fn binary_once(operation: Binary, x: f64, y: f64) -> f64 {
    let mut out = [0.0];
    binary(&mut out, operation, Numbers::Same(x), Numbers::Same(y));
    out[0]
}
