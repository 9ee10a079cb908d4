use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use super::Real;

/// A number with its derivatives along `N` directions (forward mode).
///
/// Arrays on the stack, no allocation; nests for higher derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Dual<T, const N: usize> {
    /// The value.
    pub value: T,
    /// Its derivatives.
    pub derivative: [T; N],
}

impl<T: Real, const N: usize> Dual<T, N> {
    /// A number that depends on nothing.
    #[inline(always)]
    #[must_use]
    pub fn constant(value: T) -> Self {
        Self { value, derivative: [T::zero(); N] }
    }

    /// The variable of direction `index`; a constant if there is no such direction.
    #[inline(always)]
    #[must_use]
    pub fn variable(value: T, index: usize) -> Self {
        let mut dual = Self::constant(value);
        if let Some(own) = dual.derivative.get_mut(index) {
            *own = T::one();
        }
        dual
    }

    /// A function's value and slope at `self`. An infinite slope leaves constants constant.
    #[inline(always)]
    fn chain(self, value: T, slope: T) -> Self {
        let derivative = if slope.value().is_finite() {
            self.map(|d| slope * d)
        } else {
            self.map(|d| if d.value() == 0.0 { T::zero() } else { slope * d })
        };
        Self { value, derivative }
    }

    /// Whether nothing it depends on is a variable.
    #[inline(always)]
    fn is_constant(&self) -> bool {
        self.derivative.iter().all(Real::is_zero)
    }

    /// New derivatives, one from each: no temporary arrays, no branches in the loop.
    #[inline(always)]
    fn map(&self, f: impl Fn(T) -> T) -> [T; N] {
        core::array::from_fn(|i| f(self.derivative[i]))
    }

    /// New derivatives, one from each pair.
    #[inline(always)]
    fn zip(&self, other: &Self, f: impl Fn(T, T) -> T) -> [T; N] {
        core::array::from_fn(|i| f(self.derivative[i], other.derivative[i]))
    }
}

impl<T: Real, const N: usize> PartialEq for Dual<T, N> {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: Real, const N: usize> PartialOrd for Dual<T, N> {
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

impl<T: Real, const N: usize> Real for Dual<T, N> {
    type Plain = T;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self::constant(T::from_f64(x))
    }

    #[inline(always)]
    fn from_plain(x: T) -> Self {
        Self::constant(x)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.value.value()
    }

    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.value.is_zero() && self.is_constant()
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
    fn add_sum<const K: usize>(&mut self, others: [&Self; K], factors: [T; K]) {
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
    fn divide(self, numerator: T) -> Self {
        let value = numerator / self.value;
        let slope = -value / self.value;
        Self { value, derivative: self.map(|d| d * slope) }
    }

    #[inline(always)]
    fn exponent_of(self, base: T) -> Self {
        let value = base.powf(self.value);
        if base.value() == 0.0 || self.is_constant() {
            Self::constant(value)
        } else {
            self.chain(value, value * base.ln())
        }
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
        // e^(-x) outruns every power of x: 0 is the limit even where the exponent's own
        // derivative has overflowed, and 0 * inf must not become NaN.
        if value.value() == 0.0 { Self::constant(value) } else { self.chain(value, value) }
    }

    #[inline(always)]
    fn expm1(self) -> Self {
        let value = self.value.expm1();
        // Far below zero value + 1 cancels.
        if value.value() > -0.5 {
            return self.chain(value, value + T::one());
        }
        let slope = self.value.exp();
        if slope.value() == 0.0 { Self::constant(value) } else { self.chain(value, slope) }
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
        if self.value.value() == 0.0 {
            let slope = if p.value.value() == 1.0 { T::one() } else { T::zero() };
            return self.chain(value, slope);
        }
        let by_base = p.value * (value / self.value);
        if p.is_constant() {
            return self.chain(value, by_base);
        }
        let by_exponent = value * self.value.ln();
        if by_base.value().is_finite() && by_exponent.value().is_finite() {
            let derivative = self.zip(&p, |a, b| by_base * a + by_exponent * b);
            return Self { value, derivative };
        }
        self.chain(value, by_base) + p.chain(T::zero(), by_exponent)
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
        if value.value().abs() < 0.5 {
            return self.chain(value, T::one() - value * value);
        }
        // Far from zero 1 - tanh^2 cancels: there 4 e/(1 + e)^2 with e = exp(-2 |x|).
        let e = (T::from_f64(-2.0) * self.value.abs()).exp();
        let whole = T::one() + e;
        self.chain(value, T::from_f64(4.0) * e / (whole * whole))
    }

    #[inline(always)]
    fn atan(self) -> Self {
        self.chain(self.value.atan(), T::one() / (T::one() + self.value * self.value))
    }
}
