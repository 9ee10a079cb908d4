//! Hyperbolic tangent.

use super::exponential::half_expm1;
use super::format::{Format, within};

/// Hyperbolic tangent: `h / (1 + h)` with `h = (e^(2 |x|) - 1) / 2`.
///
/// Numerator and denominator have rounding errors, `lost` and `denominator_lost`. They change the
/// quotient `q` by `(lost - q denominator_lost) / (1 + h)`, where `1 / (1 + h)` is `1 - q`.
#[inline(always)]
pub fn tanh<F: Format>(x: F) -> F {
    let one = F::of(1.0);
    let size = within(x.abs(), F::of(0.0), F::TANH_ONE);
    let (high, low) = half_expm1(F::of(2.0) * size);
    let h = high + low;
    let lost = low - (h - high);
    let denominator = one + h;
    let part = denominator - one;
    let denominator_lost = (one - (denominator - part)) + (h - part) + lost;
    let q = h / denominator;
    let correction = (lost - q * denominator_lost) * (one - q);
    (q + correction).copysign(x)
}
