//! Cube roots of many numbers.
//!
//! `x = 2^(3 q) z` with `1/3 < z < 3`, and `t` is the root of `z` to 17 digits, so that `t^3` is
//! exact. With `u = (z - t^3) / t^3` the root is `t (1 + u)^(1/3) = t + e`. The small `e` has the
//! relative error of a few roundings, so that the sum is known beyond the digits of the format.

use super::bits::Bits;
use super::polynomial::estrin;

/// The cube root of 2.
const ROOT_OF_2: f64 = 1.259_921_049_894_873_2;
/// The cube root of 1/2.
const ROOT_OF_HALF: f64 = 0.793_700_525_984_099_8;
/// Added and subtracted, it leaves the digits of `t` down to `2^-16`.
const ROUNDER: f64 = 1.5 * (1_u64 << 36) as f64;
/// `t + e` is closer to the root: `e` is below `2^-15.8` and has five roundings.
const ERROR: f64 = 1.0 / (1_u128 << 65) as f64;

/// The cube root, correctly rounded, without branches; NaN where [`libm::cbrt`] must be used: for a
/// number that is not normal, or a root that is too close to the middle between two floats.
#[inline(always)]
pub fn cbrt_fast(x: f64) -> f64 {
    let size = x.abs();
    let (k, m) = size.exponent_and_significand_of_normal();
    let (q, bits) = (k * (1.0 / 3.0)).nearest();
    let rest = k - 3.0 * q;
    let (power, root) = if rest > 0.0 { (2.0, ROOT_OF_2) } else { (1.0, 1.0) };
    let (power, root) = if rest < 0.0 { (0.5, ROOT_OF_HALF) } else { (power, root) };

    let t = root * about(m);
    let t = (t + ROUNDER) - ROUNDER;
    let cube = (t * t) * t;
    let u = (power * m - cube) / cube;
    let beyond = estrin!(u; 1.0 / 3.0, -1.0 / 9.0, 5.0 / 81.0, -10.0 / 243.0);
    let e = t * (u * beyond);
    let value = t + e;
    let lost = e - (value - t);
    let certain = (value + (lost + ERROR) == value) & (value + (lost - ERROR) == value);

    let certain = certain & size.is_normal_and_positive();
    let value = if certain { value.times_power_of_two_in_range(bits) } else { f64::NAN };
    let value = if x == 0.0 { x } else { value };
    value.copysign(x)
}

/// The cube root for `sqrt(1/2) <= m < sqrt(2)`, with a relative error of `2^-19.6`
/// (`tests/elementary/coefficients.py`).
#[inline(always)]
fn about(m: f64) -> f64 {
    estrin!(
        m;
        0.42168977359094584,
        1.0560151128247404,
        -0.8360698968449027,
        0.5109660530188697,
        -0.17955698256692565,
        0.0269549532203302,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of every size, in a fixed order.
    fn numbers() -> impl Iterator<Item = f64> {
        let mut bits = 1_u64;
        (0..200_000).map(move |_| {
            bits = bits.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            f64::from_bits(bits ^ (bits >> 29))
        })
    }

    #[test]
    fn roots_have_the_bits_of_libm_or_are_left_to_it() {
        let cubes = (1..1200).map(|n| f64::from(n * n * n) * 0.125);
        let mut left = 0;
        for x in numbers().chain(cubes).chain([0.0, -0.0]) {
            let (fast, exact) = (cbrt_fast(x), libm::cbrt(x));
            assert!(fast.is_nan() || fast.to_bits() == exact.to_bits(), "{x:e}: {fast:e}");
            left += usize::from(fast.is_nan() && x.is_normal());
        }
        assert!(left < 500, "{left} normal numbers were left to libm");
    }

    #[test]
    fn what_is_not_normal_is_left_to_libm() {
        for x in [f64::from_bits(1), -1e-310, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            assert!(cbrt_fast(x).is_nan(), "{x:e}");
        }
    }
}
