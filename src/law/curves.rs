//! Curves that several laws use.

use crate::sample::StribeckCurve;
use crate::scalar::Real;

/// `|v|^p sgn v`, 0 at rest even where `p <= 0`.
#[inline]
pub fn signed_power<S: Real>(velocity: S::Plain, exponent: S) -> S {
    let power = exponent.exp_with_base(velocity.abs());
    // An infinite power is replaced by a large one, so that a coefficient of 0 still gives 0.
    let power = S::choose(power.is_finite(), power, S::from_f64(1e30)).along(velocity);
    S::choose(velocity.at_zero(), S::zero(), power)
}

/// `sqrt(|v|) sgn v`.
#[inline]
pub fn signed_root<P: Real>(velocity: P) -> P {
    velocity.abs().sqrt() * velocity.sign()
}

/// `1/(1 + exp(-x))`, without overflow for any sign of `x`.
#[inline]
pub fn logistic<S: Real>(x: S) -> S {
    let below = x.is_negative();
    let rest = S::choose(below, x, -x).exp();
    let whole = rest.shift(S::Plain::one());
    S::choose(below, rest / whole, S::one() / whole)
}

/// `1 - exp(-x)`, without cancellation for small `x`.
#[inline]
pub fn saturation<S: Real>(x: S) -> S {
    -(-x).expm1()
}

/// The Stribeck curve `exp(-(v/vs)^2)`: 1 at rest, whatever the Stribeck velocity.
#[inline]
pub fn gaussian_curve<S: Real>(velocity: S::Plain, stribeck_velocity: S) -> StribeckCurve<S> {
    let ratio =
        S::choose(velocity.at_zero(), S::zero(), stribeck_velocity.reciprocal_times(velocity));
    // `abs` makes the square of an interval non-negative.
    let ratio = ratio.abs();
    StribeckCurve::new(ratio * ratio, S::from_f64(2.0))
}

/// `a + b x + c x^2`.
#[inline]
pub fn quadratic<S: Real>([a, b, c]: [S; 3], x: S::Plain) -> S {
    a + b.scale(x) + c.scale(x * x)
}
