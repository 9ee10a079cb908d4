//! `x^p`.

use super::format::{Format, within};
use super::logarithm::log2_pair;

/// `x` to the power `p`, with the special cases of IEEE 754's `pow`.
///
/// `p log2 x` may be a thousand and its error counts in full, so the logarithm comes with more
/// digits. `x^1` and `x^2` are exact as far as they can be.
#[inline(always)]
pub fn powf<F: Format>(x: F, p: F) -> F {
    let (zero, one) = (F::of(0.0), F::of(1.0));
    let size = x.abs();
    let value = exp2_of_product(within(p, -F::LARGE_EXPONENT, F::LARGE_EXPONENT), log2_pair(size));

    let limit = if (size == zero) == (p < zero) { F::INFINITY } else { zero };
    let value = if (size == zero) | (size == F::INFINITY) { limit } else { value };
    let (whole, odd) = p.whole_and_odd();
    let value = if odd { value.copysign(x) } else { value };
    let value = if (x < zero) & !whole & (size < F::INFINITY) { F::NAN } else { value };
    let value = if x.is_nan() { x } else { value };
    let value = if p == F::of(2.0) { x * x } else { value };
    let value = if p == one { x } else { value };
    if (p == zero) | (x == one) { one } else { value }
}

/// `2^(p l)` for `l = high + low`.
#[inline(always)]
fn exp2_of_product<F: Format>(p: F, (high, low): (F, F)) -> F {
    let p_high = p.short();
    let product = p_high * high;
    let rest = (p - p_high) * high + p * low;
    let rest = if product.abs() > F::EXP2_RANGE { F::of(0.0) } else { rest };
    let product = within(product, -F::EXP2_RANGE, F::EXP2_RANGE);
    let (n, bits) = (product + rest).nearest();
    let fraction = (product - n) + rest;
    (F::of(1.0) + fraction * F::exp2_series(fraction)).times_power_of_two(bits)
}
