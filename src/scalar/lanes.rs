use core::array::from_fn;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use super::{Mask, Real, Scalar};

/// Numbers of `L` samples side by side: every operation is done on each, with the bits that it has
/// alone, in loops that the compiler turns into vector instructions.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Lanes<T, const L: usize>(pub [T; L]);

impl<T: Scalar<Plain = T>, const L: usize> Lanes<T, L> {
    #[inline(always)]
    fn map(self, f: impl Fn(T) -> T) -> Self {
        Self(from_fn(|i| f(self.0[i])))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        Self(from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn ask(self, other: Self, f: impl Fn(T, T) -> bool) -> LaneMask<L> {
        LaneMask(from_fn(|i| f(self.0[i], other.0[i])))
    }
}

/// Yes or no for each of `L` lanes.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct LaneMask<const L: usize>([bool; L]);

impl<const L: usize> Mask for LaneMask<L> {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] & other.0[i]))
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] | other.0[i]))
    }

    #[inline(always)]
    fn not(self) -> Self {
        Self(from_fn(|i| !self.0[i]))
    }

    #[inline(always)]
    fn all(self) -> bool {
        self.0.iter().fold(true, |all, own| all & own)
    }
}

macro_rules! operator {
    ($($operator:ident: $method:ident),+) => {$(
        impl<T: Scalar<Plain = T>, const L: usize> $operator for Lanes<T, L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, T::$method)
            }
        }
    )+};
}

operator!(Add: add, Sub: sub, Mul: mul, Div: div);

impl<T: Scalar<Plain = T>, const L: usize> Neg for Lanes<T, L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(T::neg)
    }
}

impl<T: Scalar<Plain = T>, const L: usize> AddAssign for Lanes<T, L> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Scalar<Plain = T>, const L: usize> MulAssign for Lanes<T, L> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

macro_rules! lane_by_lane {
    ($($name:ident),+) => {$(
        #[inline(always)]
        fn $name(self) -> Self {
            self.map(T::$name)
        }
    )+};
}

impl<T: Scalar<Plain = T>, const L: usize> Real for Lanes<T, L> {
    type Plain = Self;
    type Mask = LaneMask<L>;

    lane_by_lane!(abs, sign, exp, expm1, ln, sqrt, cbrt, sin, cos, tanh, atan);

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self([T::from_f64(x); L])
    }

    #[inline(always)]
    fn from_plain(x: Self) -> Self {
        x
    }

    #[inline(always)]
    fn plain(self) -> Self {
        self
    }

    #[inline(always)]
    fn every(self, mut test: impl FnMut(f64) -> bool) -> bool {
        self.0.iter().all(|x| x.every(&mut test))
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.0.iter().all(T::is_zero)
    }

    #[inline(always)]
    fn is_below(self, bound: Self) -> LaneMask<L> {
        self.ask(bound, T::is_below)
    }

    #[inline(always)]
    fn is_above(self, bound: Self) -> LaneMask<L> {
        self.ask(bound, T::is_above)
    }

    #[inline(always)]
    fn equals(self, other: Self) -> LaneMask<L> {
        self.ask(other, T::equals)
    }

    #[inline(always)]
    fn is_finite(self) -> LaneMask<L> {
        self.ask(self, |x, _| x.is_finite())
    }

    #[inline(always)]
    fn choose(mask: LaneMask<L>, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }

    #[inline(always)]
    fn scale(self, factor: Self) -> Self {
        self * factor
    }

    #[inline(always)]
    fn shift(self, by: Self) -> Self {
        self + by
    }

    #[inline(always)]
    fn add_scaled(&mut self, other: &Self, factor: Self) {
        *self += *other * factor;
    }

    #[inline(always)]
    fn add_sum<const K: usize>(&mut self, others: [&Self; K], factors: [Self; K]) {
        for (other, factor) in others.into_iter().zip(factors) {
            *self += *other * factor;
        }
    }

    #[inline(always)]
    fn divide(self, numerator: Self) -> Self {
        numerator / self
    }

    #[inline(always)]
    fn exponent_of(self, base: Self) -> Self {
        base.powf(self)
    }

    #[inline(always)]
    fn powf(self, p: Self) -> Self {
        self.zip(p, T::powf)
    }

    #[inline(always)]
    fn phi(self, order: u8) -> Self {
        self.map(|x| x.phi(order))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let pairs: [(T, T); L] = from_fn(|i| self.0[i].sin_cos());
        (Self(from_fn(|i| pairs[i].0)), Self(from_fn(|i| pairs[i].1)))
    }
}
