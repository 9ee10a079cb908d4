//! Logarithms.
//!
//! `x = 2^k m`. With `s = (m - 1) / (m + 1)`, `ln m = 2 artanh s`: an odd series in `s`.

use super::format::Format;

/// Natural logarithm.
///
/// With `f = m - 1`, `2 s = f - s f`, so `ln m = f - (f^2/2 - s (f^2/2 + R))`: its largest term is
/// exact (K. C. Ng, fdlibm).
#[inline(always)]
pub fn ln<F: Format>(x: F) -> F {
    let (k, m) = x.exponent_and_significand();
    let f = m - F::of(1.0);
    let s = f / (m + F::of(1.0));
    let half_square = F::of(0.5) * f * f;
    let small = s * F::log_beyond(half_square, s * s) + k * F::LN_2[1];
    let value = k * F::LN_2[0] - ((half_square - small) - f);

    let value = if x == F::of(0.0) { -F::INFINITY } else { value };
    let value = if x < F::of(0.0) { F::NAN } else { value };
    if x < F::INFINITY { value } else { x }
}

/// The binary logarithm of `2^k m` (from `exponent_and_significand`) as the sum of a number with
/// half the digits and a small one: together one and a half times the precision of the format.
///
/// `ln m = 2/3 s (3 + z + z^2 L)` with `z = s^2`. Every factor is split so that the product of the
/// high parts is exact (as in fdlibm's `pow`). The high parts come from unrefined values, and their
/// errors are added to the low parts: this shortens the chain of dependent operations.
#[inline(always)]
pub fn log2_pair<F: Format>((k, m): (F, F)) -> (F, F) {
    log2_of_quotient(k, quotient(m))
}

/// `s` and its rounding error: the first half of [`log2_pair`].
#[inline(always)]
pub fn quotient<F: Format>(m: F) -> (F, F) {
    let one = F::of(1.0);
    let numerator = m - one;
    let denominator = m + one;
    let reciprocal = one / denominator;
    let s = numerator * reciprocal;
    let s_high = s.high_half();
    let denominator_high = denominator.high_half();
    let denominator_low = m - (denominator_high - one);
    let residual = (numerator - s_high * denominator_high) - s_high * denominator_low;
    (s, residual * reciprocal)
}

/// The second half of [`log2_pair`].
#[inline(always)]
pub fn log2_of_quotient<F: Format>(k: F, (s, s_low): (F, F)) -> (F, F) {
    let three = F::of(3.0);
    let s_high = s.high_half();
    let z = s * s;
    let square = z * z;
    let tail = square * F::log_tail(z) + s_low * (s_high + s);
    let rough_tail = square * (F::of(3.0 / 5.0) + F::of(3.0 / 7.0) * z);
    let series_high = (three + (z + rough_tail)).high_half();
    let series_low = ((three - series_high) + s_high * s_high) + tail;

    let product = s_high * series_high;
    let product_high = product.high_half();
    let product_low = (product - product_high) + (s_low * series_high + s * series_low);

    let [scale_high, scale_low] = F::LOG2_SCALE;
    let log_high = scale_high * product_high;
    let log_low = scale_low * product_high + (scale_high + scale_low) * product_low;
    let high = (k + log_high).high_half();
    (high, ((k - high) + log_high) + log_low)
}
