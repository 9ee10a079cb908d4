//! What the functions, which are written once, need to know of a format.

use super::bits::Bits;

/// The constants and polynomials of double or single precision.
pub trait Format: Bits + 'static {
    /// Beyond these `e^x` is 0 or infinite.
    const EXP_RANGE: (Self, Self);
    /// Below the first `e^x - 1` is -1, above the second infinite.
    const EXPM1_RANGE: (Self, Self);
    /// From here on a power of two is 0 or infinite.
    const EXP2_RANGE: Self;
    /// Up to here it is in the normal range.
    const EXP2_NORMAL: Self;
    /// Up to here `e^x - 1` is `x`, and `phi_2` is 1/2.
    const EXPM1_LINEAR: Self;
    /// Up to this `|x|` every `e^x` is in the normal range.
    const EXP_USUAL: Self;
    /// From this `|x|` on `e^x` is 0 or infinite.
    const EXP_FAR: Self;
    /// From this `|x|` on `e^x - 1` of a negative `x` is -1.
    const EXPM1_USUAL: Self;
    /// From here on the hyperbolic tangent is 1.
    const TANH_ONE: Self;
    /// An exponent as large as this takes every base but 1 to 0 or infinity.
    const LARGE_EXPONENT: Self;
    /// Below this `|x|` a phase is less than half a quarter turn.
    const PHASE_USUAL: Self;
    /// Up to here a phase is reduced by `PI_HALF`.
    const LARGEST_PHASE: Self;

    const LOG2_E: Self;
    /// `ln 2` in two parts: the first times a binary exponent is exact.
    const LN_2: [Self; 2];
    /// `2 / (3 ln 2)` in two parts: the first is short.
    const LOG2_SCALE: [Self; 2];
    const FRAC_2_PI: Self;
    /// `pi / 2` in four parts: the first three times a count of quarter turns are exact.
    const PI_HALF: [Self; 4];
    /// `pi / 2` in two parts.
    const PI_HALF_PAIR: [Self; 2];

    /// Pairs of terms that the series of `phi_k` needs for `|x| <= 1/2`.
    const PHI_PAIRS: usize;
    /// `1 / n!`, 0 where nobody would notice.
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

    /// `first + e^r - 1 - r` for `|r| <= ln(2) / 2`, as close as `e^r` needs it.
    fn exp_beyond(first: Self, r: Self) -> Self;
    /// The same, as close as `e^r - 1` needs it.
    fn expm1_beyond(first: Self, r: Self) -> Self;
    /// `(2^f - 1) / f` for `|f| <= 1/2`.
    fn exp2_series(f: Self) -> Self;
    /// `first + 2 artanh(s) / s - 2` with `z = s^2`, for `s` of a number between the roots of 1/2
    /// and 2.
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

/// `x`, or the bound that it passes; NaN stays NaN.
#[inline(always)]
pub fn within<F: Format>(x: F, lower: F, upper: F) -> F {
    let x = if x < lower { lower } else { x };
    if x > upper { upper } else { x }
}
