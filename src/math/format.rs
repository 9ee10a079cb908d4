//! The constants and polynomials that the elementary functions need of a floating-point format.

use super::bits::Bits;

/// The constants and polynomials of double or single precision.
pub trait Format: Bits + 'static {
    /// Outside this range `e^x` is 0 or infinite.
    const EXP_RANGE: (Self, Self);
    /// Below the first bound `e^x - 1` is -1, above the second infinite.
    const EXPM1_RANGE: (Self, Self);
    /// From this absolute exponent on a power of two is 0 or infinite.
    const EXP2_RANGE: Self;
    /// Up to this absolute exponent a power of two is normal.
    const EXP2_NORMAL: Self;
    /// Up to this `|x|`, `e^x - 1` is `x` and `phi_2` is 1/2.
    const EXPM1_LINEAR: Self;
    /// Up to this `|x|`, `e^x` is normal.
    const EXP_USUAL: Self;
    /// From this `|x|` on, `e^x` is 0 or infinite.
    const EXP_FAR: Self;
    /// From this `|x|` on, `e^x - 1` of a negative `x` is -1.
    const EXPM1_USUAL: Self;
    /// From this `|x|` on, the hyperbolic tangent is 1.
    const TANH_ONE: Self;
    /// An exponent of this size takes every base except 1 to 0 or infinity.
    const LARGE_EXPONENT: Self;
    /// Below this `|x|` sine and cosine need no argument reduction.
    const PHASE_USUAL: Self;
    /// Up to this `|x|` the argument is reduced with `PI_HALF`.
    const LARGEST_PHASE: Self;

    const LOG2_E: Self;
    /// `ln 2` in two parts; the product of the first with a binary exponent is exact.
    const LN_2: [Self; 2];
    /// `2 / (3 ln 2)` in two parts; the first has half the digits.
    const LOG2_SCALE: [Self; 2];
    const FRAC_2_PI: Self;
    /// `pi / 2` in four parts; the products of the first three with a number of quarter turns are
    /// exact.
    const PI_HALF: [Self; 4];
    /// `pi / 2` in two parts.
    const PI_HALF_PAIR: [Self; 2];

    /// Pairs of terms in the series of `phi_k` for `|x| <= 1/2`.
    const PHI_PAIRS: usize;
    /// `1 / n!`, or 0 where it has no influence.
    fn inverse_factorial(n: usize) -> Self;

    // The coefficients of the polynomials below.
    const EXP_BEYOND: &'static [Self];
    const EXPM1_BEYOND: &'static [Self];
    const EXP2_SERIES: &'static [Self];
    const LOG_BEYOND: &'static [Self];
    const LOG_TAIL: &'static [Self];
    const ATAN_SERIES: &'static [Self];
    const SIN_SERIES: &'static [Self];
    const COS_BEYOND: &'static [Self];

    /// `first + e^r - 1 - r` for `|r| <= ln(2) / 2`, with the accuracy that `e^r` needs.
    fn exp_beyond(first: Self, r: Self) -> Self;
    /// The same with the accuracy that `e^r - 1` needs.
    fn expm1_beyond(first: Self, r: Self) -> Self;
    /// `(2^f - 1) / f` for `|f| <= 1/2`.
    fn exp2_series(f: Self) -> Self;
    /// `first + 2 artanh(s) / s - 2` with `z = s^2` and `s = (m - 1) / (m + 1)`, for
    /// `sqrt(1/2) <= m < sqrt(2)`.
    fn log_beyond(first: Self, z: Self) -> Self;
    /// `3/2 (2 artanh(s) / s - 2 - 2/3 z) / z^2`.
    fn log_tail(z: Self) -> Self;
    /// `(atan(t) / t - 1) / z` with `z = t^2`, for `|t| <= sqrt(2) - 1`.
    fn atan_series(z: Self) -> Self;
    /// `(sin(r) / r - 1) / z` with `z = r^2`, for `|r| <= pi / 4`.
    fn sin_series(z: Self) -> Self;
    /// `first + cos(r) - 1 + z / 2` with `z = r^2`, for `|r| <= pi / 4`.
    fn cos_beyond(first: Self, z: Self) -> Self;
}

/// `x` clamped to the bounds; NaN stays NaN.
#[inline(always)]
pub fn within<F: Format>(x: F, lower: F, upper: F) -> F {
    let x = if x < lower { lower } else { x };
    if x > upper { upper } else { x }
}
