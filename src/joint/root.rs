//! The scalar equation of a step: secant steps until the root is bracketed, then Chandrupatla's
//! method, inverse quadratic interpolation where it converges and bisection elsewhere (Advances in
//! Engineering Software 28, 1997).

use crate::scalar::Scalar;

/// Evaluations to bracket the root; the distance doubles where secants do not help.
const MAX_WIDENED: usize = 80;
/// Evaluations to narrow the bracket: bisection alone would need about this many.
const MAX_NARROWED: usize = 120;
/// Rounding errors of one evaluation, in units in the last place of its largest term.
const SLACK: f64 = 4.0;

/// Unit in the last place of 1.
pub(crate) fn rounding<P: Scalar + PartialOrd>() -> P {
    let double = P::from_f64(1.0 + f64::EPSILON) > P::one();
    P::from_f64(if double { f64::EPSILON } else { f64::from(f32::EPSILON) })
}

/// The zero of a function that is expected to grow at least as fast as `slope`.
pub(crate) struct Equation<P> {
    /// The initial guess.
    pub start: P,
    /// The function there.
    pub value: P,
    /// A lower bound of the slope, if the function is monotonic.
    pub slope: P,
    /// Magnitude of the terms of the function: a value below its rounding error counts as zero.
    pub size: P,
}

impl<P: Scalar + PartialOrd> Equation<P> {
    /// The tolerance of the function; 0 if the magnitude is not finite.
    fn settled(&self) -> P {
        let settled = self.size * rounding::<P>() * P::from_f64(SLACK);
        if settled.value().is_finite() { settled } else { P::zero() }
    }

    /// The root, exact to rounding, with a bounded number of evaluations. Without a change of sign
    /// within reach it is the last point evaluated.
    pub fn solve(&self, function: impl FnMut(P) -> P) -> P {
        self.solve_above(P::from_f64(f64::NEG_INFINITY), function).unwrap_or(self.start)
    }

    /// The root if it lies above `least`, where the function is negative.
    pub fn solve_above(&self, least: P, mut function: impl FnMut(P) -> P) -> Option<P> {
        let (settled, half) = (self.settled(), P::from_f64(0.5));
        let (mut near, mut f_near) = (self.start, self.value);
        if f_near.abs() <= settled {
            return Some(near);
        }
        let mut distance = -f_near / self.slope;
        for _ in 0..MAX_WIDENED {
            let far = near + distance;
            let beyond = far <= least;
            let far = if beyond { least } else { far };
            let f_far = function(far);
            if beyond && f_far >= P::zero() {
                return None;
            }
            if f_far.abs() <= settled || far == near {
                return Some(far);
            }
            if f_far.sign() != f_near.sign() {
                return Some(narrow(function, [(near, f_near), (far, f_far)], settled));
            }
            // Secant steps; twice the distance where the last one has not reduced the function
            // enough.
            let left = f_far / f_near;
            let reduced = left > P::zero() && left < half;
            distance *= if reduced { left / (P::one() - left) } else { P::from_f64(2.0) };
            // Next to a jump a secant step is too short: move by at least the rounding error.
            let shortest = rounding::<P>() * far.abs();
            if distance.abs() < shortest {
                distance = distance.sign() * shortest;
            }
            (near, f_near) = (far, f_far);
        }
        Some(near)
    }
}

/// Narrows a bracket of a root, whose second end is the latest.
fn narrow<P: Scalar + PartialOrd>(
    mut function: impl FnMut(P) -> P,
    [first, second]: [(P, P); 2],
    settled: P,
) -> P {
    let (half, one) = (P::from_f64(0.5), P::one());
    let unit = rounding::<P>();
    let (mut best, mut other) = (second, first);
    let secant = best.1 / (best.1 - other.1);
    // A secant of infinite values is no use: bisect.
    let mut share = if secant > P::zero() && secant < one { secant } else { half };
    let mut nearest = nearer(best, other);
    for _ in 0..MAX_NARROWED {
        // Stay away from both ends by the rounding error: a flat part next to a jump looks like a
        // root.
        let span = other.0 - best.0;
        let least = unit * nearest.0.abs() / span.abs();
        if share < least {
            share = least;
        }
        if share > one - least {
            share = one - least;
        }
        let next = best.0 + share * span;
        if next == best.0 || next == other.0 {
            break;
        }
        let tried = (next, function(next));
        let left;
        if tried.1.sign() == best.1.sign() {
            left = best;
        } else {
            left = other;
            other = best;
        }
        best = tried;
        nearest = nearer(best, other);
        if nearest.1.abs() <= settled || (other.0 - best.0).abs() <= unit * nearest.0.abs() {
            break;
        }
        share = interpolated(best, other, left).unwrap_or(half);
    }
    nearest.0
}

/// The end with the smaller function value.
fn nearer<P: Scalar + PartialOrd>(best: (P, P), other: (P, P)) -> (P, P) {
    if other.1.abs() < best.1.abs() { other } else { best }
}

/// Position between `a` and `b`, as a share, where the inverse quadratic through three points is
/// zero, if the interpolation is sure to converge.
fn interpolated<P: Scalar + PartialOrd>(a: (P, P), b: (P, P), c: (P, P)) -> Option<P> {
    let one = P::one();
    let xi = (a.0 - b.0) / (c.0 - b.0);
    let phi = (a.1 - b.1) / (c.1 - b.1);
    if phi * phi < xi && (one - phi) * (one - phi) < one - xi {
        let first = a.1 / (b.1 - a.1) * (c.1 / (b.1 - c.1));
        let second = (c.0 - a.0) / (b.0 - a.0) * (a.1 / (c.1 - a.1)) * (b.1 / (c.1 - b.1));
        Some(first + second)
    } else {
        None
    }
}
