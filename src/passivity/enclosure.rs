//! Numbers with bounds: every operation rounds outwards.

use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use crate::math::f64 as elementary;
use crate::scalar::Real;

/// How much a library function may be wrong, relative to its value: four units in the last place,
/// and as many so that values computed at points lie within as well.
const SLACK: f64 = 8.0 * f64::EPSILON;

/// The same for the weights of an exponential step, which take some operations.
const PHI_SLACK: f64 = 1e-12;

/// All numbers from `lower` to `upper`.
///
/// A law evaluated on enclosures gives an enclosure of all its values, if each of its branches goes
/// the same way over all of them. Laws branch on the signs of channels, so a channel must not
/// enclose both signs: see [`pieces`](super::region::pieces).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// No value is less.
    pub lower: f64,
    /// No value is more.
    pub upper: f64,
}

impl Enclosure {
    /// Every number.
    pub const ALL: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// From `lower` to `upper`; a bound that is no number bounds nothing.
    #[must_use]
    pub fn new(lower: f64, upper: f64) -> Self {
        Self {
            lower: if lower.is_nan() { f64::NEG_INFINITY } else { lower },
            upper: if upper.is_nan() { f64::INFINITY } else { upper },
        }
    }

    /// One number.
    #[must_use]
    pub const fn point(x: f64) -> Self {
        Self { lower: x, upper: x }
    }

    /// What lies in either.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// The part that is not negative, if there is a positive one.
    #[must_use]
    pub fn positive_part(self) -> Option<Self> {
        (self.upper > 0.0).then(|| Self { lower: self.lower.max(0.0), upper: self.upper })
    }

    /// `x^2`, which is not negative.
    #[must_use]
    pub fn square(self) -> Self {
        let size = self.abs();
        size * size
    }

    /// The values of a growing function, from those at the ends.
    #[must_use]
    pub fn growing(self, slack: f64, function: impl Fn(f64) -> f64) -> Self {
        let (low, high) = (function(self.lower), function(self.upper));
        let (low_error, high_error) = (low.abs() * slack, high.abs() * slack);
        Self::new((low - low_error).next_down(), (high + high_error).next_up())
    }

    /// The values of a growing function that has the sign of its argument.
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

    /// Whether `phase + 2 pi k` is among the values for some whole `k`, or nearly so.
    fn passes(self, phase: f64) -> bool {
        let turn = core::f64::consts::TAU;
        let slack = 1e-12 * (1.0 + self.lower.abs().max(self.upper.abs()));
        let turns = ((self.lower - slack - phase) / turn).ceil();
        phase + turns * turn <= self.upper + slack
    }

    /// Sine or cosine, whose crests and troughs are at these phases.
    fn wave(self, crest: f64, trough: f64, function: impl Fn(f64) -> f64) -> Self {
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

/// Bounds of `a b`, on the right side of zero; nothing times infinity is nothing.
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

/// Only where it holds for all values alike.
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

    /// Of a finite number within, which is 0 only where nothing else is.
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

    fn add_sum<const K: usize>(&mut self, others: [&Self; K], factors: [Self; K]) {
        for (other, factor) in others.into_iter().zip(factors) {
            *self += *other * factor;
        }
    }

    fn divide(self, numerator: Self) -> Self {
        numerator / self
    }

    fn exponent_of(self, base: Self) -> Self {
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

    /// In each of base and exponent it grows or falls all the way: the extremes are at corners.
    fn powf(self, p: Self) -> Self {
        let base = self.within(0.0, f64::INFINITY);
        let corner = |x: f64, p: f64| Self::point(elementary::powf(x, p));
        let low = corner(base.lower, p.lower).hull(corner(base.lower, p.upper));
        let high = corner(base.upper, p.lower).hull(corner(base.upper, p.upper));
        let power = low.hull(high).growing(SLACK, |x| x).within(0.0, f64::INFINITY);
        // Laws put a large number in place of one that is beyond all.
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
        self.wave(quarter, -quarter, elementary::sin)
    }

    fn cos(self) -> Self {
        self.wave(0.0, core::f64::consts::PI, elementary::cos)
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
