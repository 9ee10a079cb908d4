//! `e^x` and `e^x - 1`.
//!
//! `x = n ln 2 + r` with `|r| <= ln(2) / 2`, and `e^r = 1 + r + r^2 Q(r)`. As `ln 2` has two parts,
//! so has `r`: the larger is exact, and the smaller is added to the small quadratic term.

use super::format::{Format, within};

/// `e^x`.
#[inline(always)]
pub fn exp<F: Format>(x: F) -> F {
    let (lowest, highest) = F::EXP_RANGE;
    let (significand, bits) = exp_parts(within(x, lowest, highest));
    significand.times_power_of_two(bits)
}

/// `m` and `n` of `e^x = 2^n m` with `m` near 1, for `x` in `EXP_RANGE`.
#[inline(always)]
pub fn exp_parts<F: Format>(x: F) -> (F, F::Integer) {
    let (_, bits, r) = reduced(x);
    (exp_of(r), bits)
}

/// `n`, as a float and in the lowest bits, and both parts of `r = large - small`.
#[inline(always)]
fn reduced<F: Format>(x: F) -> (F, F::Integer, (F, F)) {
    let (n, bits) = (x * F::LOG2_E).nearest();
    (n, bits, (x - n * F::LN_2[0], n * F::LN_2[1]))
}

/// `e^r` for `|r| <= ln(2) / 2`.
#[inline(always)]
fn exp_of<F: Format>((large, small): (F, F)) -> F {
    F::of(1.0) + (large + F::exp_beyond(-small, large - small))
}

/// `n` and both parts of `r`: the first half of [`exp`].
#[inline(always)]
pub fn exp_reduced<F: Format>(x: F) -> (F, (F, F)) {
    let (lowest, highest) = F::EXP_RANGE;
    let (n, _, r) = reduced(within(x, lowest, highest));
    (n, r)
}

/// The second half of [`exp`].
#[inline(always)]
pub fn exp_of_reduced<F: Format>(n: F, r: (F, F)) -> F {
    exp_of(r).times_power_of_two(n.nearest().1)
}

/// Whether the second half of [`exp`] is [`usual_exp_of_reduced`]: the result is normal.
#[inline(always)]
pub fn is_usual_exp<F: Format>(x: F) -> bool {
    x.abs() < F::EXP_USUAL
}

/// The second half of [`exp`] where [`is_usual_exp`].
#[inline(always)]
pub fn usual_exp_of_reduced<F: Format>(n: F, r: (F, F)) -> F {
    exp_of(r).times_power_of_two_in_range(n.nearest().1)
}

/// `e^x - 1`.
#[inline(always)]
pub fn expm1<F: Format>(x: F) -> F {
    expm1_of(x, half_expm1(x))
}

#[inline(always)]
fn expm1_of<F: Format>(x: F, (high, low): (F, F)) -> F {
    let value = F::of(2.0) * (high + low);
    // Keeps the sign of zero and the last digit of a subnormal number.
    if x.abs() < F::EXPM1_LINEAR { x } else { value }
}

/// `n` and both parts of `r`: the first half of [`expm1`].
#[inline(always)]
pub fn expm1_reduced<F: Format>(x: F) -> (F, (F, F)) {
    let (lowest, highest) = F::EXPM1_RANGE;
    let (n, _, r) = reduced(within(x, lowest, highest));
    (n, r)
}

/// The second half of [`expm1`].
#[inline(always)]
pub fn expm1_of_reduced<F: Format>(x: F, n: F, r: (F, F)) -> F {
    expm1_of(x, half_expm1_of_reduced(n, r))
}

/// The second half of [`half_expm1`].
#[inline(always)]
pub fn half_expm1_of_reduced<F: Format>(n: F, r: (F, F)) -> (F, F) {
    half_expm1_of(n.nearest().1, r)
}

/// `(e^x - 1) / 2` as a number and its rounding error. Half of it, because `2^n` itself may
/// overflow.
///
/// In `(2^n - 1) + 2^n r + 2^n (e^r - 1 - r)` the first two terms may cancel and the last is small;
/// for `n = 0` only the last two remain.
#[inline(always)]
pub fn half_expm1<F: Format>(x: F) -> (F, F) {
    let (lowest, highest) = F::EXPM1_RANGE;
    half_expm1_within(within(x, lowest, highest))
}

/// The same for `x` in `EXPM1_RANGE`.
#[inline(always)]
pub fn half_expm1_within<F: Format>(x: F) -> (F, F) {
    let (_, bits, r) = reduced(x);
    half_expm1_of(bits, r)
}

#[inline(always)]
fn half_expm1_of<F: Format>(bits: F::Integer, (large, small): (F, F)) -> (F, F) {
    let beyond = F::expm1_beyond(-small, large - small);
    let scale = F::half_power_of_two(bits);

    let constant = scale - F::of(0.5);
    let linear = scale * large;
    let sum = constant + linear;
    let lost = linear - (sum - constant);
    (sum, lost + scale * beyond)
}
