//! Hyperbolic tangent.

use super::exponential::half_expm1;
use super::format::{Format, within};

/// Hyperbolic tangent: `h / (1 + h)` of `h = (e^(2 |x|) - 1) / 2`.
///
/// Both have been rounded. What that has taken from them, `lost` and `denominator_lost`, changes the
/// quotient `q` by `(lost - q denominator_lost) / (1 + h)`, and `1 / (1 + h)` is `1 - q`.
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
