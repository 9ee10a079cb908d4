//! Sine and cosine.
//!
//! `x = n pi/2 + r` with `|r| <= pi/4`; `n` selects the series and its sign.

use super::format::Format;
use super::phase;

/// Sine and cosine.
#[inline(always)]
pub fn sin_cos<F: Format>(x: F) -> (F, F) {
    if needs_exact_reduction(x) { sin_cos_exactly_reduced(x) } else { sin_cos_fast(x) }
}

/// Whether `|x|` is too large for [`sin_cos_fast`].
#[inline(always)]
pub fn needs_exact_reduction<F: Format>(x: F) -> bool {
    x.abs() > F::LARGEST_PHASE
}

/// Sine and cosine without branches, where [`needs_exact_reduction`] is false.
#[inline(always)]
pub fn sin_cos_fast<F: Format>(x: F) -> (F, F) {
    let (n, bits) = (x * F::FRAC_2_PI).nearest();
    let [first, second, third, fourth] = F::PI_HALF;
    // Near a multiple of pi/2 each subtraction may cancel.
    let (sum, lost) = difference(x - n * first, n * second);
    let (r, lost_again) = difference(sum, n * third);
    let low = (lost + lost_again) - n * fourth;
    let (sin, cos) = in_quadrant(bits, r, low);
    // keeps the sign of -0
    (if x == F::of(0.0) { x } else { sin }, cos)
}

/// Sine and cosine for `|x| < PHASE_USUAL`, without argument reduction.
#[inline(always)]
pub fn sin_cos_unreduced<F: Format>(x: F) -> (F, F) {
    let z = x * x;
    let half = F::of(0.5) * z;
    let rough = F::of(1.0) - half;
    let lost = (F::of(1.0) - rough) - half;
    let sin = x + z * x * F::sin_series(z);
    (if x == F::of(0.0) { x } else { sin }, rough + F::cos_beyond(lost, z))
}

/// Sine and cosine of a large argument.
#[cold]
fn sin_cos_exactly_reduced<F: Format>(x: F) -> (F, F) {
    if x.abs() == F::INFINITY {
        return (F::NAN, F::NAN);
    }
    let (n, r, low) = phase::reduce(x);
    let (sin, cos) = in_quadrant(n, r, low);
    (if x < F::of(0.0) { -sin } else { sin }, cos)
}

/// Sine and cosine of `n pi/2 + r + low`.
#[inline(always)]
fn in_quadrant<F: Format>(n: F::Integer, r: F, low: F) -> (F, F) {
    let (sin, cos) = (sine(r, low), cosine(r, low));
    let swapped = F::is_odd(n);
    (
        if swapped { cos } else { sin }.negated_by_second_bit(n, 0),
        if swapped { sin } else { cos }.negated_by_second_bit(n, 1),
    )
}

/// `a - b`, and its rounding error.
#[inline(always)]
fn difference<F: Format>(a: F, b: F) -> (F, F) {
    let rounded = a - b;
    let part = rounded - a;
    (rounded, (a - (rounded - part)) - (b + part))
}

/// Sine of `r + low`.
#[inline(always)]
fn sine<F: Format>(r: F, low: F) -> F {
    let z = r * r;
    let cube = z * r;
    r + (cube * F::sin_series(z) + low * (F::of(1.0) - F::of(0.5) * z))
}

/// Cosine of `r + low`.
#[inline(always)]
fn cosine<F: Format>(r: F, low: F) -> F {
    let one = F::of(1.0);
    let z = r * r;
    let half = F::of(0.5) * z;
    let rough = one - half;
    let lost = (one - rough) - half;
    rough + F::cos_beyond(lost - r * low, z)
}
