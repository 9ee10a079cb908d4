//! Elementary functions with branches, for one number at a time: the usual case comes first and
//! computes only what it needs.
//!
//! A microcontroller has no time for operations whose result is discarded. The bits are those of
//! the functions without branches, whose parts are used here.

use super::format::Format;
use super::{exponential, phi, power, trigonometric};

/// `e^x`.
#[inline(always)]
pub fn exp<F: Format>(x: F) -> F {
    let size = x.abs();
    if size.is_between(F::of(0.0), F::EXP_FAR) {
        let (significand, bits) = exponential::exp_parts(x);
        if size.is_between(F::of(0.0), F::EXP_USUAL) {
            significand.times_power_of_two_in_range(bits)
        } else {
            significand.times_power_of_two(bits)
        }
    } else if x < F::of(0.0) {
        F::of(0.0)
    } else {
        rare_exp(x)
    }
}

#[cold]
#[inline(never)]
fn rare_exp<F: Format>(x: F) -> F {
    exponential::exp(x)
}

/// `e^x - 1`.
#[inline(always)]
pub fn expm1<F: Format>(x: F) -> F {
    let size = x.abs();
    if size.is_between(F::EXPM1_LINEAR, F::EXPM1_USUAL) {
        let (high, low) = exponential::half_expm1_within(x);
        F::of(2.0) * (high + low)
    } else if size < F::EXPM1_LINEAR {
        x
    } else if x < F::of(0.0) {
        -F::of(1.0)
    } else {
        rare_expm1(x)
    }
}

#[cold]
#[inline(never)]
fn rare_expm1<F: Format>(x: F) -> F {
    exponential::expm1(x)
}

/// `phi_k(x)`.
#[inline(always)]
pub fn phi<F: Format>(order: u8, x: F) -> F {
    if order == 1 && x.abs().is_between(F::EXPM1_LINEAR, F::EXPM1_USUAL) {
        expm1(x) / x
    } else {
        phi::phi(order, x)
    }
}

/// `x^p`.
#[inline(always)]
pub fn powf<F: Format>(x: F, p: F) -> F {
    if p.has_bits_of(F::of(2.0)) { x * x } else { any_power(x, p) }
}

#[inline(never)]
fn any_power<F: Format>(x: F, p: F) -> F {
    let usual_base = x.is_between(F::SMALLEST_NORMAL, F::INFINITY);
    if usual_base && !p.has_bits_of(F::of(1.0)) {
        let logarithm = power::log2_fast(x);
        let (product, rest) = power::product(p, logarithm);
        // Not for an exponent that is NaN or very large: except for `x = 1`, whose power is 1.
        if product.abs().is_between(F::of(0.0), F::EXP2_NORMAL) {
            let (n, bits) = (product + rest).nearest();
            let fraction = (product - n) + rest;
            return power::exp2_of_fraction(fraction).times_power_of_two_in_range(bits);
        }
    }
    if x.has_bits_of(F::of(0.0)) && p > x { x } else { rare_power(x, p) }
}

#[cold]
#[inline(never)]
fn rare_power<F: Format>(x: F, p: F) -> F {
    power::powf(x, p)
}

/// Sine and cosine.
#[inline(always)]
pub fn sin_cos<F: Format>(x: F) -> (F, F) {
    if x.abs() < F::PHASE_USUAL { trigonometric::sin_cos_unreduced(x) } else { any_sin_cos(x) }
}

#[inline(never)]
fn any_sin_cos<F: Format>(x: F) -> (F, F) {
    trigonometric::sin_cos(x)
}
