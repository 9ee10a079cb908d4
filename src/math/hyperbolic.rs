//! Hyperbolic tangent.

use super::exponential::{expm1_reduced, half_expm1, half_expm1_of_reduced};
use super::format::{Format, within};

/// Hyperbolic tangent: `h / (1 + h)` with `h = (e^(2 |x|) - 1) / 2`.
///
/// Numerator and denominator have rounding errors, `lost` and `denominator_lost`. They change the
/// quotient `q` by `(lost - q denominator_lost) / (1 + h)`, where `1 / (1 + h)` is `1 - q`.
#[inline(always)]
pub fn tanh<F: Format>(x: F) -> F {
    tanh_of(x, half_expm1(doubled(x)))
}

/// `2 |x|`, as far as it matters.
#[inline(always)]
fn doubled<F: Format>(x: F) -> F {
    F::of(2.0) * within(x.abs(), F::of(0.0), F::TANH_ONE)
}

/// The first half of [`tanh`]: that of `e^(2 |x|) - 1`.
#[inline(always)]
pub fn tanh_reduced<F: Format>(x: F) -> (F, (F, F)) {
    expm1_reduced(doubled(x))
}

/// The second half of [`tanh`].
#[inline(always)]
pub fn tanh_of_reduced<F: Format>(x: F, n: F, r: (F, F)) -> F {
    tanh_of(x, half_expm1_of_reduced(n, r))
}

#[inline(always)]
fn tanh_of<F: Format>(x: F, (high, low): (F, F)) -> F {
    let one = F::of(1.0);
    let h = high + low;
    let lost = low - (h - high);
    let denominator = one + h;
    let part = denominator - one;
    let denominator_lost = (one - (denominator - part)) + (h - part) + lost;
    let q = h / denominator;
    let correction = (lost - q * denominator_lost) * (one - q);
    (q + correction).copysign(x)
}
