//! Dual numbers: values with derivatives, for forward-mode automatic differentiation.

use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use super::{Mask, Real};

/// A number with its derivatives in `N` directions (forward mode).
///
/// Arrays on the stack, no allocation. Dual numbers of dual numbers give higher derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Dual<T, const N: usize> {
    /// The value.
    pub value: T,
    /// The derivatives.
    pub derivative: [T; N],
}

impl<T: Real, const N: usize> Dual<T, N> {
    /// A number whose derivatives are all 0.
    #[inline(always)]
    #[must_use]
    pub fn constant(value: T) -> Self {
        Self { value, derivative: [T::zero(); N] }
    }

    /// The variable of direction `index`; a constant if `index >= N`.
    #[inline(always)]
    #[must_use]
    pub fn variable(value: T, index: usize) -> Self {
        let mut dual = Self::constant(value);
        if let Some(own) = dual.derivative.get_mut(index) {
            *own = T::one();
        }
        dual
    }

    /// A function of `self` with this value and slope. Zero derivatives stay 0, even where the
    /// slope is infinite.
    #[inline(always)]
    fn chain(self, value: T, slope: T) -> Self {
        let bounded = slope.is_finite();
        if bounded.all() {
            return Self { value, derivative: self.map(|d| slope * d) };
        }
        let derivative =
            self.map(|d| T::choose(bounded.not().and(d.at_zero()), T::zero(), slope * d));
        Self { value, derivative }
    }

    /// The same value, with derivatives of 0 where the mask is true.
    #[inline(always)]
    fn with_zero_derivatives_where(self, mask: T::Mask) -> Self {
        Self { value: self.value, derivative: self.map(|d| T::choose(mask, T::zero(), d)) }
    }

    /// Whether all derivatives are 0.
    #[inline(always)]
    fn is_constant(&self) -> bool {
        self.derivative.iter().all(Real::is_zero)
    }

    /// Applies `f` to each derivative, without temporary arrays and without branches in the loop.
    #[inline(always)]
    fn map(&self, f: impl Fn(T) -> T) -> [T; N] {
        core::array::from_fn(|i| f(self.derivative[i]))
    }

    /// Applies `f` to each pair of derivatives.
    #[inline(always)]
    fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> [T; N] {
        core::array::from_fn(|i| f(self.derivative[i], other.derivative[i]))
    }
}

impl<T: PartialEq, const N: usize> PartialEq for Dual<T, N> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: PartialOrd, const N: usize> PartialOrd for Dual<T, N> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}

impl<T: Real, const N: usize> Add for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, derivative: self.zip(&other, |a, b| a + b) }
    }
}

impl<T: Real, const N: usize> Sub for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, derivative: self.zip(&other, |a, b| a - b) }
    }
}

impl<T: Real, const N: usize> Mul for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl)]
    fn mul(self, other: Self) -> Self {
        let (x, y) = (self.value, other.value);
        Self { value: x * y, derivative: self.zip(&other, |a, b| a * y + x * b) }
    }
}

impl<T: Real, const N: usize> Div for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let inverse = T::one() / other.value;
        Self { value, derivative: self.zip(&other, |a, b| (a - value * b) * inverse) }
    }
}

impl<T: Real, const N: usize> Neg for Dual<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, derivative: self.map(|d| -d) }
    }
}

impl<T: Real, const N: usize> AddAssign for Dual<T, N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for (d, by) in self.derivative.iter_mut().zip(&other.derivative) {
            *d += *by;
        }
    }
}

impl<T: Real, const N: usize> MulAssign for Dual<T, N> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        let (x, y) = (self.value, other.value);
        self.value = x * y;
        for (d, by) in self.derivative.iter_mut().zip(&other.derivative) {
            *d = *d * y + x * *by;
        }
    }
}

impl<T: Real<Plain: Real<Plain: Real<Mask = T::Mask>>>, const N: usize> Real for Dual<T, N> {
    type Plain = T;
    type Mask = T::Mask;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self::constant(T::from_f64(x))
    }

    #[inline(always)]
    fn from_plain(x: T) -> Self {
        Self::constant(x)
    }

    #[inline(always)]
    fn plain(self) -> T {
        self.value
    }

    #[inline(always)]
    fn every(self, test: impl FnMut(f64) -> bool) -> bool {
        self.value.every(test)
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.is_constant()
    }

    #[inline(always)]
    fn is_below(self, bound: T) -> T::Mask {
        self.value.is_below(bound.plain())
    }

    #[inline(always)]
    fn is_above(self, bound: T) -> T::Mask {
        self.value.is_above(bound.plain())
    }

    #[inline(always)]
    fn equals(self, other: T) -> T::Mask {
        self.value.equals(other.plain())
    }

    #[inline(always)]
    fn is_finite(self) -> T::Mask {
        self.value.is_finite()
    }

    #[inline(always)]
    fn choose(mask: T::Mask, yes: Self, no: Self) -> Self {
        Self {
            value: T::choose(mask, yes.value, no.value),
            derivative: yes.zip(&no, |a, b| T::choose(mask, a, b)),
        }
    }

    #[inline(always)]
    fn choose_below(self, bound: T, yes: Self, no: Self) -> Self {
        let choice = |yes: T, no: T| self.value.choose_below(bound.plain(), yes, no);
        Self { value: choice(yes.value, no.value), derivative: yes.zip(&no, choice) }
    }

    #[inline(always)]
    fn scale(self, factor: T) -> Self {
        Self { value: self.value * factor, derivative: self.map(|d| d * factor) }
    }

    #[inline(always)]
    fn shift(self, by: T) -> Self {
        Self { value: self.value + by, ..self }
    }

    #[inline(always)]
    fn add_scaled(&mut self, other: &Self, factor: T) {
        self.value += other.value * factor;
        for (d, by) in self.derivative.iter_mut().zip(&other.derivative) {
            *d += *by * factor;
        }
    }

    #[inline(always)]
    fn add_linear_combination<const K: usize>(&mut self, others: [&Self; K], factors: [T; K]) {
        for (other, factor) in others.into_iter().zip(factors) {
            self.value += other.value * factor;
        }
        for (i, d) in self.derivative.iter_mut().enumerate() {
            for (other, factor) in others.into_iter().zip(factors) {
                *d += other.derivative[i] * factor;
            }
        }
    }

    #[inline(always)]
    fn reciprocal_times(self, numerator: T) -> Self {
        let value = numerator / self.value;
        let slope = -value / self.value;
        Self { value, derivative: self.map(|d| d * slope) }
    }

    #[inline(always)]
    fn exp_with_base(self, base: T) -> Self {
        let value = base.powf(self.value);
        if self.is_constant() {
            return Self::constant(value);
        }
        self.chain(value, value * base.ln()).with_zero_derivatives_where(base.at_zero())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.chain(self.value.abs(), self.value.sign())
    }

    #[inline(always)]
    fn sign(self) -> Self {
        Self::constant(self.value.sign())
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        // e^(-x) falls faster than any power of x grows: the limit is 0 even where the exponent's
        // derivative has overflowed, and 0 * inf must not give NaN.
        self.chain(value, value).with_zero_derivatives_where(value.at_zero())
    }

    #[inline(always)]
    fn expm1(self) -> Self {
        let value = self.value.expm1();
        // Far below zero `value + 1` loses its digits by cancellation.
        let near = value.is_above(T::Plain::from_f64(-0.5));
        if near.all() {
            return self.chain(value, value + T::one());
        }
        let slope = T::choose(near, value + T::one(), self.value.exp());
        self.chain(value, slope).with_zero_derivatives_where(slope.at_zero())
    }

    #[inline(always)]
    fn phi(self, order: u8) -> Self {
        // phi_k' = phi_k - k phi_(k+1)
        let value = self.value.phi(order);
        if self.is_constant() {
            return Self::constant(value);
        }
        let slope = value - T::from_f64(f64::from(order)) * self.value.phi(order + 1);
        self.chain(value, slope)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), T::one() / self.value)
    }

    #[inline(always)]
    fn powf(self, p: Self) -> Self {
        let value = self.value.powf(p.value);
        let at_zero = self.value.at_zero();
        let unit = T::choose(p.value.equals(T::Plain::one()), T::one(), T::zero());
        let by_base = T::choose(at_zero, unit, p.value * (value / self.value));
        let along = self.chain(value, by_base);
        if p.is_constant() {
            return along;
        }
        let by_exponent = T::choose(at_zero, T::zero(), value * self.value.ln());
        along + p.chain(T::zero(), by_exponent)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.chain(value, T::from_f64(0.5) / value)
    }

    #[inline(always)]
    fn cbrt(self) -> Self {
        let value = self.value.cbrt();
        self.chain(value, T::one() / (T::from_f64(3.0) * value * value))
    }

    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }

    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    #[inline(always)]
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        let near = value.abs().is_below(T::Plain::from_f64(0.5));
        if near.all() {
            return self.chain(value, T::one() - value * value);
        }
        // Far from zero 1 - tanh^2 cancels: use 4 e / (1 + e)^2 with e = exp(-2 |x|) there.
        let e = (T::from_f64(-2.0) * self.value.abs()).exp();
        let whole = T::one() + e;
        let far = T::from_f64(4.0) * e / (whole * whole);
        self.chain(value, T::choose(near, T::one() - value * value, far))
    }

    #[inline(always)]
    fn atan(self) -> Self {
        self.chain(self.value.atan(), T::one() / (T::one() + self.value * self.value))
    }
}
