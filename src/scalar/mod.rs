//! The number types that laws are written in: `f32`, `f64`, and [`Dual`] for gradients.

mod dual;
mod mask;

pub use dual::Dual;
pub use mask::{Choice, Mask};

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

/// A real number, or several in parallel lanes. Comparisons are by value and ignore derivatives.
///
/// Code generic over `Real` runs on every number type with the same bits. It must not branch on a
/// number: it computes both alternatives and [chooses](Self::choose) one. Code that has to branch
/// requires a [`Scalar`].
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + MulAssign
{
    /// The type without derivatives: of samples, constants and time.
    type Plain: Real<Plain: Real<Mask = Self::Mask>, Mask = Self::Mask>;
    /// The result of a comparison: one `bool` per lane.
    type Mask: Mask;

    /// A constant.
    fn from_f64(x: f64) -> Self;
    /// A number without derivatives.
    fn from_plain(x: Self::Plain) -> Self;
    /// The value, without derivatives.
    fn plain(self) -> Self::Plain;
    /// Whether the value of every lane passes `test`.
    fn every(self, test: impl FnMut(f64) -> bool) -> bool;
    /// Whether the value and all derivatives are 0.
    fn is_zero(&self) -> bool;
    /// `x < bound`.
    fn is_below(self, bound: Self::Plain) -> Self::Mask;
    /// `x > bound`.
    fn is_above(self, bound: Self::Plain) -> Self::Mask;
    /// `x == other`.
    fn equals(self, other: Self::Plain) -> Self::Mask;
    /// Whether the value is neither infinite nor NaN.
    fn is_finite(self) -> Self::Mask;
    /// `yes` where the mask is true, `no` elsewhere; the other alternative has no influence, not
    /// even if it is NaN.
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `yes` where `x < bound`, `no` elsewhere. Other than `choose` it may be used where the order
    /// follows from more than the sign of a channel: an interval across the bound gives both.
    #[inline(always)]
    #[must_use]
    fn choose_below(self, bound: Self::Plain, yes: Self, no: Self) -> Self {
        Self::choose(self.is_below(bound), yes, no)
    }
    /// `a x`.
    fn scale(self, factor: Self::Plain) -> Self;
    /// `x sgn v`. A single number is not multiplied.
    #[inline(always)]
    #[must_use]
    fn along(self, velocity: Self::Plain) -> Self {
        self.scale(velocity.sign())
    }
    /// `x + a`.
    fn shift(self, by: Self::Plain) -> Self;
    /// `x += a y`.
    fn add_scaled(&mut self, other: &Self, factor: Self::Plain);
    /// `x += sum_j a_j y_j`, in one pass.
    fn add_linear_combination<const K: usize>(
        &mut self,
        others: [&Self; K],
        factors: [Self::Plain; K],
    );
    /// `a / x`, rounded once.
    fn reciprocal_times(self, numerator: Self::Plain) -> Self;
    /// `a^x` for `a >= 0`; at `a = 0` the derivative is defined as 0.
    fn exp_with_base(self, base: Self::Plain) -> Self;
    /// `|x|`, with derivative `sign(x)`.
    fn abs(self) -> Self;
    /// -1, 0 or 1; `sign(0) = 0`, unlike `signum`. Its derivative is 0.
    fn sign(self) -> Self;
    /// `e^x`; where it underflows to 0 its derivative is 0 too.
    fn exp(self) -> Self;
    /// `e^x - 1`.
    fn expm1(self) -> Self;
    /// `phi_k(x) = sum_j x^j / (j + k)!`, the weights of an exponential integrator.
    fn phi(self, order: u8) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// `x^p` for `x >= 0`; at `x = 0` an infinite derivative is replaced by 0.
    fn powf(self, p: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Cube root, negative for negative `x`.
    fn cbrt(self) -> Self;
    /// Sine.
    fn sin(self) -> Self;
    /// Cosine.
    fn cos(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;

    /// Zero.
    #[inline]
    #[must_use]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    /// One.
    #[inline]
    #[must_use]
    fn one() -> Self {
        Self::from_f64(1.0)
    }

    /// The value of a single number as `f64`.
    #[inline]
    fn value(self) -> f64
    where
        Self: Real<Mask = bool>,
    {
        let mut value = f64::NAN;
        self.every(|x| {
            value = x;
            true
        });
        value
    }

    /// `x > 0`.
    #[inline]
    fn is_positive(self) -> Self::Mask {
        self.is_above(Self::Plain::zero())
    }

    /// `x < 0`.
    #[inline]
    fn is_negative(self) -> Self::Mask {
        self.is_below(Self::Plain::zero())
    }

    /// `x >= bound`.
    #[inline]
    fn reaches(self, bound: Self::Plain) -> Self::Mask {
        self.is_above(bound).or(self.equals(bound))
    }

    /// `x == 0`, whatever the derivatives.
    #[inline]
    fn at_zero(self) -> Self::Mask {
        self.equals(Self::Plain::zero())
    }
}

/// A single real number, on which code may branch. States are stepped with it.
pub trait Scalar: Real<Mask = bool> {}

impl<S: Real<Mask = bool>> Scalar for S {}

macro_rules! primitive {
    ($float:ident: $($name:ident),+) => {
        impl Real for $float {
            type Plain = Self;
            type Mask = bool;

            #[inline]
            #[allow(clippy::cast_possible_truncation)]
            fn from_f64(x: f64) -> Self {
                x as Self
            }

            #[inline]
            fn from_plain(x: Self) -> Self {
                x
            }

            #[inline]
            fn plain(self) -> Self {
                self
            }

            #[inline]
            fn every(self, mut test: impl FnMut(f64) -> bool) -> bool {
                test(f64::from(self))
            }

            #[inline]
            fn is_zero(&self) -> bool {
                *self == 0.0
            }

            #[inline]
            fn is_below(self, bound: Self) -> bool {
                self < bound
            }

            #[inline]
            fn is_above(self, bound: Self) -> bool {
                self > bound
            }

            #[inline]
            fn equals(self, other: Self) -> bool {
                self == other
            }

            #[inline]
            fn is_finite(self) -> bool {
                <$float>::is_finite(self)
            }

            #[inline]
            fn choose(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }

            #[inline]
            fn scale(self, factor: Self) -> Self {
                self * factor
            }

            #[inline(always)]
            fn along(self, velocity: Self) -> Self {
                if velocity > 0.0 {
                    self
                } else if velocity < 0.0 {
                    -self
                } else {
                    self * (velocity + 0.0)
                }
            }

            #[inline]
            fn shift(self, by: Self) -> Self {
                self + by
            }

            #[inline]
            fn add_scaled(&mut self, other: &Self, factor: Self) {
                *self += *other * factor;
            }

            #[inline]
            fn add_linear_combination<const K: usize>(&mut self, others: [&Self; K], factors: [Self; K]) {
                for (other, factor) in others.into_iter().zip(factors) {
                    *self += *other * factor;
                }
            }

            #[inline]
            fn reciprocal_times(self, numerator: Self) -> Self {
                numerator / self
            }

            #[inline]
            fn exp_with_base(self, base: Self) -> Self {
                crate::math::$float::branching::powf(base, self)
            }

            #[inline]
            fn abs(self) -> Self {
                <$float>::abs(self)
            }

            #[inline]
            fn sign(self) -> Self {
                if self > 0.0 {
                    1.0
                } else if self < 0.0 {
                    -1.0
                } else {
                    // keeps NaN and turns -0 into 0
                    self + 0.0
                }
            }

            #[inline(always)]
            fn powf(self, p: Self) -> Self {
                crate::math::$float::branching::powf(self, p)
            }

            #[inline]
            fn phi(self, order: u8) -> Self {
                crate::math::$float::branching::phi(order, self)
            }

            #[inline]
            fn exp(self) -> Self {
                crate::math::$float::branching::exp(self)
            }

            #[inline]
            fn expm1(self) -> Self {
                crate::math::$float::branching::expm1(self)
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                crate::math::$float::branching::sin_cos(self)
            }

            $(
                #[inline]
                fn $name(self) -> Self {
                    crate::math::$float::$name(self)
                }
            )+
        }
    };
}

primitive!(f64: ln, sqrt, cbrt, sin, cos, tanh, atan);
primitive!(f32: ln, sqrt, cbrt, sin, cos, tanh, atan);
