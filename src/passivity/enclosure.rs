//! Interval arithmetic: numbers with bounds, rounded outwards.
//!
//! The bounds hold for the exact real function, and for the value that the laws compute in `f64`.
//! With `u = 2^-53` (round to nearest) and `e = 2 u` ([`f64::EPSILON`]):
//!
//! - `a + b`: the error of the rounded sum is a number of the format and is computed exactly
//!   (two-sum). If it is 0 the sum is exact, else the exact sum lies between the neighbours of the
//!   rounded one. An overflow makes the error NaN, which counts as inexact.
//! - `a b`, `1 / x`: correctly rounded, so the exact value lies between the neighbours, below the
//!   smallest normal number too. A product has the sign of its factors. `a / b` is `a (1 / b)`, with
//!   two outward roundings.
//! - Increasing functions: a value `y` differs from the exact one by at most `b` units in its last
//!   place, `b e |y|` or `b 2^-1074`. Values computed inside the interval differ from the exact ones
//!   by as much again, so `2 b` suffices. [`SLACK`] is `16 e` and [`SLACK_OF_SUBNORMALS`] 16 units;
//!   the largest measured `b` is 1.9.
//! - `phi_k`: increasing; the same with `b = 6`, 12 e, against the 4500 e of [`PHI_SLACK`].
//! - `sin`, `cos`: at the ends as above, where `|y| <= 1`. For an extremum at `p + 2 pi k` between
//!   the ends see [`Enclosure::passes`].
//! - `powf`: monotonic in the base and in the exponent, so the extremes are at the corners.
//!
//! The `b` are measured, not derived: `tests/math.rs` compares the functions with values at 50
//! digits, and `tests/python/passivity/test_rounding.py` with many more. The slack is at least four
//! times what they need.

use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use crate::math::f64 as elementary;
use crate::scalar::Real;

/// Relative slack of an elementary function.
const SLACK: f64 = 16.0 * f64::EPSILON;

/// The same for the `phi` functions, which take several operations.
const PHI_SLACK: f64 = 1e-12;

/// Absolute slack, for values below the smallest normal number: 16 units in their last place.
const SLACK_OF_SUBNORMALS: f64 = f64::from_bits(16);

/// The interval from `lower` to `upper`.
///
/// A law evaluated on enclosures gives an enclosure of all its values, provided that each branch is
/// the same for the whole interval. Laws branch on the signs of channels, so the interval of a
/// channel must not contain both signs: see [`pieces`](super::region::pieces).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
}

impl Enclosure {
    /// All real numbers.
    pub const ALL: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// From `lower` to `upper`; a bound that is NaN becomes infinite.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self {
            lower: if lower.is_nan() { f64::NEG_INFINITY } else { lower },
            upper: if upper.is_nan() { f64::INFINITY } else { upper },
        }
    }

    /// The interval of one number; all numbers for NaN.
    #[must_use]
    pub const fn point(x: f64) -> Self {
        if x.is_nan() { Self::ALL } else { Self { lower: x, upper: x } }
    }

    /// The smallest interval that contains both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// The part that is not negative, if it contains a positive number.
    #[must_use]
    pub fn positive_part(self) -> Option<Self> {
        (self.upper > 0.0).then(|| Self { lower: self.lower.max(0.0), upper: self.upper })
    }

    /// `x^2`; unlike `x * x` never negative.
    #[must_use]
    pub fn square(self) -> Self {
        let size = self.abs();
        size * size
    }

    /// The image under an increasing function.
    #[must_use]
    pub fn growing(self, slack: f64, function: impl Fn(f64) -> f64) -> Self {
        let (low, high) = (function(self.lower), function(self.upper));
        let error = |y: f64| y.abs() * slack + SLACK_OF_SUBNORMALS;
        Self::new((low - error(low)).next_down(), (high + error(high)).next_up())
    }

    /// The image under an increasing function that has the sign of its argument.
    fn growing_through_zero(self, function: impl Fn(f64) -> f64) -> Self {
        let mut values = self.growing(SLACK, function);
        if self.lower >= 0.0 {
            values.lower = values.lower.max(0.0);
        }
        if self.upper <= 0.0 {
            values.upper = values.upper.min(0.0);
        }
        values
    }

    fn within(self, lower: f64, upper: f64) -> Self {
        Self { lower: self.lower.max(lower), upper: self.upper.min(upper) }
    }

    fn reciprocal(self) -> Self {
        if self.lower > 0.0 || self.upper < 0.0 {
            return Self::new((1.0 / self.upper).next_down(), (1.0 / self.lower).next_up());
        }
        match (self.lower == 0.0, self.upper == 0.0) {
            (true, false) => Self::new((1.0 / self.upper).next_down(), f64::INFINITY),
            (false, true) => Self::new(f64::NEG_INFINITY, (1.0 / self.lower).next_up()),
            _ => Self::ALL,
        }
    }

    /// Whether the interval contains `phase + 2 pi k` for some integer `k`; also true if it nearly
    /// does.
    ///
    /// With `m` the larger end, `|k| <= m / 6 + 1`. The constants `phase` and `turn` have relative
    /// errors of at most `u`, and each of the six operations rounds once, so that all of them move
    /// `phase + 2 pi k` by less than `8 u (m + 7)`, 1e-14 (1 + m). The slack is a hundred times that.
    fn passes(self, phase: f64) -> bool {
        let turn = core::f64::consts::TAU;
        let slack = 1e-12 * (1.0 + self.lower.abs().max(self.upper.abs()));
        let turns = ((self.lower - slack - phase) / turn).ceil();
        phase + turns * turn <= self.upper + slack
    }

    /// Sine or cosine, with its maxima at `crest` and its minima at `trough`, modulo 2 pi.
    fn sin_or_cos(self, crest: f64, trough: f64, function: impl Fn(f64) -> f64) -> Self {
        if !(self.lower.is_finite() && self.upper.is_finite()) {
            return Self { lower: -1.0, upper: 1.0 };
        }
        let (low, high) = (function(self.lower), function(self.upper));
        let ends =
            Self::new((low.min(high) - SLACK).next_down(), (low.max(high) + SLACK).next_up());
        Self {
            lower: if self.passes(trough) { -1.0 } else { ends.lower },
            upper: if self.passes(crest) { 1.0 } else { ends.upper },
        }
        .within(-1.0, 1.0)
    }
}

/// Bounds of `a + b`: the sum itself where it is exact.
fn sum(a: f64, b: f64) -> Enclosure {
    let sum = a + b;
    let part = sum - a;
    let error = (a - (sum - part)) + (b - part);
    if error == 0.0 {
        Enclosure::point(sum)
    } else {
        Enclosure::new(sum.next_down(), sum.next_up())
    }
}

/// Bounds of `a b`, on the right side of zero; zero times infinity is zero.
fn product(a: f64, b: f64) -> Enclosure {
    if a == 0.0 || b == 0.0 {
        return Enclosure::point(0.0);
    }
    let product = a * b;
    if a.abs() == 1.0 || b.abs() == 1.0 {
        return Enclosure::point(product);
    }
    if (a > 0.0) == (b > 0.0) {
        Enclosure::new(product.next_down().max(0.0), product.next_up())
    } else {
        Enclosure::new(product.next_down(), product.next_up().min(0.0))
    }
}

impl Add for Enclosure {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (low, high) = (sum(self.lower, other.lower), sum(self.upper, other.upper));
        Self::new(low.lower, high.upper)
    }
}

impl Neg for Enclosure {
    type Output = Self;

    fn neg(self) -> Self {
        Self { lower: -self.upper, upper: -self.lower }
    }
}

impl Sub for Enclosure {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Enclosure {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let low = product(self.lower, other.lower).hull(product(self.lower, other.upper));
        let high = product(self.upper, other.lower).hull(product(self.upper, other.upper));
        low.hull(high)
    }
}

impl Div for Enclosure {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl)]
    fn div(self, other: Self) -> Self {
        self * other.reciprocal()
    }
}

impl AddAssign for Enclosure {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl MulAssign for Enclosure {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

/// Defined only where the order is the same for all values.
impl PartialOrd for Enclosure {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        if self.upper < other.lower {
            Some(Ordering::Less)
        } else if self.lower > other.upper {
            Some(Ordering::Greater)
        } else if self.lower == self.upper && self == other {
            Some(Ordering::Equal)
        } else {
            None
        }
    }
}

impl Real for Enclosure {
    type Plain = Self;
    type Mask = bool;

    fn from_f64(x: f64) -> Self {
        Self::point(x)
    }

    fn from_plain(x: Self) -> Self {
        x
    }

    fn plain(self) -> Self {
        self
    }

    /// Tests one finite number of the interval, which is 0 only if the interval is zero.
    fn every(self, mut test: impl FnMut(f64) -> bool) -> bool {
        let (lower, upper) = (self.lower.max(-f64::MAX), self.upper.min(f64::MAX));
        let middle = 0.5 * lower + 0.5 * upper;
        test(if middle == 0.0 { upper } else { middle })
    }

    fn is_below(self, bound: Self) -> bool {
        self.value() < bound.value()
    }

    fn is_above(self, bound: Self) -> bool {
        self.value() > bound.value()
    }

    fn equals(self, other: Self) -> bool {
        self.value() == other.value()
    }

    fn is_finite(self) -> bool {
        true
    }

    fn choose(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    /// Both alternatives where the interval lies on both sides of the bound.
    fn choose_below(self, bound: Self, yes: Self, no: Self) -> Self {
        if self.upper < bound.lower {
            yes
        } else if self.lower >= bound.upper {
            no
        } else {
            yes.hull(no)
        }
    }

    fn is_zero(&self) -> bool {
        self.lower == 0.0 && self.upper == 0.0
    }

    fn scale(self, factor: Self) -> Self {
        self * factor
    }

    fn shift(self, by: Self) -> Self {
        self + by
    }

    fn add_scaled(&mut self, other: &Self, factor: Self) {
        *self += *other * factor;
    }

    fn add_linear_combination<const K: usize>(&mut self, others: [&Self; K], factors: [Self; K]) {
        for (other, factor) in others.into_iter().zip(factors) {
            *self += *other * factor;
        }
    }

    fn reciprocal_times(self, numerator: Self) -> Self {
        numerator / self
    }

    fn exp_with_base(self, base: Self) -> Self {
        base.powf(self)
    }

    fn abs(self) -> Self {
        if self.lower >= 0.0 {
            self
        } else if self.upper <= 0.0 {
            -self
        } else {
            Self { lower: 0.0, upper: self.upper.max(-self.lower) }
        }
    }

    fn sign(self) -> Self {
        Self { lower: Real::sign(self.lower), upper: Real::sign(self.upper) }
    }

    fn exp(self) -> Self {
        self.growing(SLACK, elementary::exp).within(0.0, f64::INFINITY)
    }

    fn expm1(self) -> Self {
        self.growing_through_zero(elementary::expm1).within(-1.0, f64::INFINITY)
    }

    fn phi(self, order: u8) -> Self {
        let weight = |x| elementary::phi(order, x);
        self.growing(PHI_SLACK, weight).within(0.0, f64::INFINITY)
    }

    fn ln(self) -> Self {
        self.within(0.0, f64::INFINITY).growing(SLACK, elementary::ln)
    }

    /// The extremes are at the corners.
    fn powf(self, p: Self) -> Self {
        let base = self.within(0.0, f64::INFINITY);
        let corner = |x: f64, p: f64| Self::point(elementary::powf(x, p));
        let low = corner(base.lower, p.lower).hull(corner(base.lower, p.upper));
        let high = corner(base.upper, p.lower).hull(corner(base.upper, p.upper));
        let power = low.hull(high).growing(SLACK, |x| x).within(0.0, f64::INFINITY);
        // Laws replace an infinite power by a large number.
        let lower = if power.upper < f64::MAX { power.lower } else { power.lower.min(1e30) };
        Self { lower, upper: power.upper }
    }

    fn sqrt(self) -> Self {
        self.within(0.0, f64::INFINITY).growing_through_zero(elementary::sqrt)
    }

    fn cbrt(self) -> Self {
        self.growing_through_zero(elementary::cbrt)
    }

    fn sin(self) -> Self {
        let quarter = core::f64::consts::FRAC_PI_2;
        self.sin_or_cos(quarter, -quarter, elementary::sin)
    }

    fn cos(self) -> Self {
        self.sin_or_cos(0.0, core::f64::consts::PI, elementary::cos)
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }

    fn tanh(self) -> Self {
        self.growing_through_zero(elementary::tanh).within(-1.0, 1.0)
    }

    fn atan(self) -> Self {
        self.growing_through_zero(elementary::atan)
    }
}

#[cfg(test)]
mod tests;
