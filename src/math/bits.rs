//! The bits of a float: signs, powers of two, integers.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// A float whose bits can be manipulated.
///
/// Uses only operations that every vector unit has: no conversion between integers and floats, no
/// arithmetic shift. To convert an integer-valued float, `1.5 * 2^52` is added (`1.5 * 2^23` in
/// single precision), which leaves the integer in the lowest bits.
pub trait Bits:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// An integer in the lowest bits; the higher bits are arbitrary.
    type Integer: Copy;

    const SMALLEST_NORMAL: Self;
    const INFINITY: Self;
    const NAN: Self;

    /// A constant that is exact in single precision.
    fn of(x: f32) -> Self;
    /// Whether it is NaN.
    fn is_nan(self) -> bool;
    /// Whether the bits are equal: same number and sign, or the same NaN.
    fn has_bits_of(self, other: Self) -> bool;
    /// Whether `lower <= x < upper`, for two positive numbers.
    fn is_between(self, lower: Self, upper: Self) -> bool;
    /// `|x|`.
    fn abs(self) -> Self;
    /// `|x|` with the sign of another number.
    fn copysign(self, sign: Self) -> Self;
    /// `x` with the lower half of its significand cleared: the product of two such numbers is
    /// exact.
    fn high_half(self) -> Self;
    /// The nearest integer, as a float and in the lowest bits, for `|x| < 2^51` (`2^22`).
    fn nearest(self) -> (Self, Self::Integer);
    /// `2^(n-1)`, for a result in the normal range.
    fn half_power_of_two(n: Self::Integer) -> Self;
    /// `2^n x`, where `x` and the result are normal.
    fn times_power_of_two_in_range(self, n: Self::Integer) -> Self;
    /// `2^n x`, rounded once; `n` may lie somewhat outside the exponent range of the format.
    fn times_power_of_two(self, n: Self::Integer) -> Self;
    /// Whether the lowest bit is set.
    fn is_odd(n: Self::Integer) -> bool;
    /// `-x` where the second-lowest bit of `n + add` is set.
    fn negated_by_second_bit(self, n: Self::Integer, add: u8) -> Self;
    /// `k` and `m` of `x = 2^k m` with `sqrt(1/2) <= m < sqrt(2)`, for finite `x > 0`; arbitrary
    /// finite numbers for any other `x`.
    fn exponent_and_significand(self) -> (Self, Self);
    /// The same for a normal positive number.
    fn exponent_and_significand_of_normal(self) -> (Self, Self);
    /// Whether the number is normal and positive.
    fn is_normal_and_positive(self) -> bool;
    /// `m` and `e` of `|x| = m 2^e` with an integer `m`, for a normal number.
    fn integer_and_exponent(self) -> (u64, i32);
    /// `fraction / 2^digits` as an unevaluated sum of a large and a small number.
    fn pair_of_fraction(fraction: i128, digits: u32) -> (Self, Self);
    /// A small integer.
    fn integer(n: u8) -> Self::Integer;
    /// Whether the number is an integer, and whether it is odd; not for NaN.
    fn is_integer_and_odd(self) -> (bool, bool);
}

macro_rules! bits {
    ($float:ident, $integer:ident) => {
        const _: () = {
            /// Stored bits of the significand.
            const STORED: u32 = <$float>::MANTISSA_DIGITS - 1;
            /// The exponent field of 1.
            const BIAS: $integer = (<$float>::MAX_EXP - 1) as $integer;
            const ONE: $integer = BIAS << STORED;
            /// From here on every float is an integer.
            const INTEGERS: $float = ((1 as $integer) << STORED) as $float;

            impl Bits for $float {
                type Integer = $integer;

                const SMALLEST_NORMAL: Self = <$float>::MIN_POSITIVE;
                const INFINITY: Self = <$float>::INFINITY;
                const NAN: Self = <$float>::NAN;

                #[inline(always)]
                fn of(x: f32) -> Self {
                    Self::from(x)
                }

                #[inline(always)]
                fn is_nan(self) -> bool {
                    <$float>::is_nan(self)
                }

                #[inline(always)]
                fn has_bits_of(self, other: Self) -> bool {
                    self.to_bits() == other.to_bits()
                }

                #[inline(always)]
                fn is_between(self, lower: Self, upper: Self) -> bool {
                    // Positive floats have the order of their bits as integers; negative ones lie
                    // above them.
                    let (lower, upper) = (lower.to_bits(), upper.to_bits());
                    self.to_bits().wrapping_sub(lower) < upper - lower
                }

                #[inline(always)]
                fn abs(self) -> Self {
                    <$float>::abs(self)
                }

                #[inline(always)]
                fn copysign(self, sign: Self) -> Self {
                    <$float>::copysign(self, sign)
                }

                #[inline(always)]
                fn high_half(self) -> Self {
                    const LOWER_HALF: $integer = (1 << <$float>::MANTISSA_DIGITS.div_ceil(2)) - 1;
                    Self::from_bits(self.to_bits() & !LOWER_HALF)
                }

                #[inline(always)]
                fn nearest(self) -> (Self, $integer) {
                    const ROUNDER: $float = 1.5 * INTEGERS;
                    let rounded = self + ROUNDER;
                    (rounded - ROUNDER, rounded.to_bits())
                }

                #[inline(always)]
                fn half_power_of_two(n: $integer) -> Self {
                    Self::from_bits(n.wrapping_add(BIAS - 1) << STORED)
                }

                #[inline(always)]
                fn times_power_of_two_in_range(self, n: $integer) -> Self {
                    Self::from_bits(self.to_bits().wrapping_add(n << STORED))
                }

                #[inline(always)]
                fn times_power_of_two(self, n: $integer) -> Self {
                    // Two factors reach beyond the normal range. Adding twice the bias makes the
                    // sum positive, so that a logical shift halves it.
                    let both = n.wrapping_add(2 * BIAS);
                    let first = both >> 1;
                    let second = both.wrapping_sub(first);
                    self * Self::from_bits(first << STORED) * Self::from_bits(second << STORED)
                }

                #[inline(always)]
                fn is_odd(n: $integer) -> bool {
                    n & 1 != 0
                }

                #[inline(always)]
                fn negated_by_second_bit(self, n: $integer, add: u8) -> Self {
                    let bit = n.wrapping_add($integer::from(add)) & 2;
                    Self::from_bits(self.to_bits() ^ (bit << ($integer::BITS - 2)))
                }

                #[inline(always)]
                fn exponent_and_significand(self) -> (Self, Self) {
                    const LIFT: $float = INTEGERS * INTEGERS;
                    let (x, lifted) = if self < Self::MIN_POSITIVE {
                        (self * LIFT, (2 * STORED) as $float)
                    } else {
                        (self, 0.0)
                    };
                    let (exponent, significand) = x.exponent_and_significand_of_normal();
                    (exponent - lifted, significand)
                }

                #[inline(always)]
                fn exponent_and_significand_of_normal(self) -> (Self, Self) {
                    const ROOT_HALF: $integer =
                        (core::f64::consts::FRAC_1_SQRT_2 as $float).to_bits();
                    // Offset so that the exponent changes at sqrt(1/2) and not at 1.
                    let moved = self.to_bits().wrapping_add(ONE - ROOT_HALF);
                    let exponent = Self::from_bits((moved >> STORED) | INTEGERS.to_bits());
                    let significand = (moved & ((1 << STORED) - 1)) + ROOT_HALF;
                    (exponent - (INTEGERS + BIAS as $float), Self::from_bits(significand))
                }

                #[inline(always)]
                fn is_normal_and_positive(self) -> bool {
                    (Self::MIN_POSITIVE..Self::INFINITY).contains(&self)
                }

                fn integer_and_exponent(self) -> (u64, i32) {
                    let field = self.abs().to_bits() >> STORED;
                    let digits = (self.to_bits() & ((1 << STORED) - 1)) | (1 << STORED);
                    (digits.into(), field as i32 - (BIAS + STORED as $integer) as i32)
                }

                fn pair_of_fraction(fraction: i128, digits: u32) -> (Self, Self) {
                    let unit = Self::from_bits((BIAS - digits as $integer) << STORED);
                    let high = fraction as Self;
                    (high * unit, (fraction - high as i128) as Self * unit)
                }

                #[inline(always)]
                fn integer(n: u8) -> $integer {
                    n.into()
                }

                #[inline(always)]
                fn is_integer_and_odd(self) -> (bool, bool) {
                    let size = self.abs();
                    let shifted = size + INTEGERS;
                    let (whole, units) = if size < INTEGERS {
                        (shifted - INTEGERS == size, shifted.to_bits())
                    } else {
                        (true, size.to_bits())
                    };
                    (whole, whole && size < 2.0 * INTEGERS && units & 1 != 0)
                }
            }
        };
    };
}

bits!(f64, u64);
bits!(f32, u32);
