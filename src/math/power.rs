//! The power `x^p`.

use super::format::{Format, within};
use super::logarithm::{log2_pair, quotient};

/// `x` to the power `p`, with the special cases of IEEE 754's `pow`.
///
/// `p log2 x` may be about 1000, where a relative error counts a thousandfold, so the logarithm has
/// extra digits. `x^1` and `x^2` are correctly rounded.
#[inline(always)]
pub fn powf<F: Format>(x: F, p: F) -> F {
    let (zero, one) = (F::of(0.0), F::of(1.0));
    let size = x.abs();
    let value = exp2_of_product(
        within(p, -F::LARGE_EXPONENT, F::LARGE_EXPONENT),
        log2_pair(size.exponent_and_significand()),
    );

    let limit = if (size == zero) == (p < zero) { F::INFINITY } else { zero };
    let value = if (size == zero) | (size == F::INFINITY) { limit } else { value };
    let (is_integer, odd) = p.is_integer_and_odd();
    let value = if odd { value.copysign(x) } else { value };
    let value = if (x < zero) & !is_integer & (size < F::INFINITY) { F::NAN } else { value };
    let value = if x.is_nan() { x } else { value };
    let value = if x == one { one } else { value };
    without_logarithm(value, x, p)
}

/// The power for an exponent of 0, 1 or 2, which needs no logarithm; `value` for any other.
#[inline(always)]
pub fn without_logarithm<F: Format>(value: F, x: F, p: F) -> F {
    let (zero, one) = (F::of(0.0), F::of(1.0));
    let value = if p == F::of(2.0) { x * x } else { value };
    let value = if p == one { x } else { value };
    if p == zero { one } else { value }
}

/// The binary logarithm of a normal, positive number, high and low part: the first half of
/// [`powf`].
#[inline(always)]
pub fn log2_fast<F: Format>(x: F) -> (F, F) {
    log2_pair(x.exponent_and_significand_of_normal())
}

/// The first half of [`log2_fast`]: the exponent, and a quotient with its rounding error.
#[inline(always)]
pub fn log2_quotient<F: Format>(x: F) -> (F, (F, F)) {
    let (k, m) = x.exponent_and_significand_of_normal();
    (k, quotient(m))
}

/// `x` to the power `p` from its [logarithm](log2_fast), without branches and without most special
/// cases: where these might matter the result is NaN and [`powf`] must be used. Otherwise the bits
/// are the same. `p` must pass [`is_plain_exponent`].
#[inline(always)]
pub fn powf_fast<F: Format>(x: F, logarithm: (F, F), p: F) -> F {
    powf_of_exponent(x, exponent_fast(logarithm, p), p)
}

/// The first half of [`powf_fast`]: `n` and `f` of `x^p = 2^(n + f)` with `|f| <= 1/2`.
#[inline(always)]
pub fn exponent_fast<F: Format>(logarithm: (F, F), p: F) -> (F, F) {
    let (product, rest) = product(p, logarithm);
    let (n, _) = (product + rest).nearest();
    (n, (product - n) + rest)
}

/// The second half of [`powf_fast`].
#[inline(always)]
pub fn powf_of_exponent<F: Format>(x: F, (n, fraction): (F, F), p: F) -> F {
    let zero = F::of(0.0);
    let value = usual_power((n, fraction));
    let limit = if n < zero { zero } else { F::INFINITY };
    let beyond = if n.abs() >= F::EXP2_RANGE { limit } else { F::NAN };
    let value = if n.abs() < F::EXP2_NORMAL { value } else { beyond };
    let value = if x.is_normal_and_positive() { value } else { F::NAN };
    if (x == zero) & (p > zero) { zero } else { value }
}

/// Whether the second half of [`powf_fast`] is [`usual_power`]: no special case.
#[inline(always)]
pub fn is_usual_power<F: Format>(x: F, n: F) -> bool {
    (n.abs() < F::EXP2_NORMAL) & x.is_normal_and_positive()
}

/// `2^(n + f)` where [`is_usual_power`].
#[inline(always)]
pub fn usual_power<F: Format>((n, fraction): (F, F)) -> F {
    exp2_of_fraction(fraction).times_power_of_two_in_range(n.nearest().1)
}

/// Whether [`powf_fast`] supports this exponent: not 0, 1, 2, NaN or very large.
#[inline(always)]
pub fn is_plain_exponent<F: Format>(p: F) -> bool {
    p.abs() < F::LARGE_EXPONENT && p != F::of(0.0) && p != F::of(1.0) && p != F::of(2.0)
}

/// `p l` for `l = high + low`: the exact product of the high parts, and the rest.
#[inline(always)]
pub fn product<F: Format>(p: F, (high, low): (F, F)) -> (F, F) {
    let p_high = p.high_half();
    (p_high * high, (p - p_high) * high + p * low)
}

/// `2^f` for `|f| <= 1/2`.
#[inline(always)]
pub fn exp2_of_fraction<F: Format>(fraction: F) -> F {
    F::of(1.0) + fraction * F::exp2_series(fraction)
}

/// `2^(p l)` for `l = high + low`.
#[inline(always)]
fn exp2_of_product<F: Format>(p: F, logarithm: (F, F)) -> F {
    let (product, rest) = product(p, logarithm);
    let rest = if product.abs() > F::EXP2_RANGE { F::of(0.0) } else { rest };
    let product = within(product, -F::EXP2_RANGE, F::EXP2_RANGE);
    let (n, bits) = (product + rest).nearest();
    exp2_of_fraction((product - n) + rest).times_power_of_two(bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_out_of_range_have_the_bits_of_the_full_function() {
        let bases = [1e-300, 3.0e-5, 0.3, 0.999_99, 1.000_01, 1.7, 42.0, 5.0e200];
        let exponents = [-1e19, -3e4, -366.7, -5.5, 0.58, 5.5, 366.7, 3e4, 1e19, f64::NAN];
        let mut out_of_range = 0;
        for (x, p) in bases.iter().flat_map(|&x| exponents.map(|p| (x, p))) {
            let (fast, full): (f64, f64) = (powf_fast(x, log2_fast(x), p), powf(x, p));
            assert!(fast.is_nan() || fast.to_bits() == full.to_bits(), "{x:e}^{p:e}: {fast:e}");
            out_of_range += usize::from(fast == 0.0 || fast.is_infinite());
        }
        assert_eq!(out_of_range, 40);
    }
}
