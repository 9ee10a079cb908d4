//! The scalar equation of a step: secants until the root is enclosed, then Chandrupatla's method,
//! inverse quadratic interpolation where it is sure to gain, else bisection (Advances in Engineering
//! Software 28, 1997).

use crate::scalar::Scalar;

/// Evaluations while the root is being enclosed; the distance doubles where secants do not help.
const MOST_WIDENED: usize = 80;
/// Evaluations while the enclosure closes: bisection alone would need about this many.
const MOST_NARROWED: usize = 120;
/// Rounding errors of one evaluation, in units in the last place of what is summed in it.
const SLACK: f64 = 4.0;

/// Unit in the last place of 1.
fn rounding<P: Scalar + PartialOrd>() -> P {
    let double = P::from_f64(1.0 + f64::EPSILON) > P::one();
    P::from_f64(if double { f64::EPSILON } else { f64::from(f32::EPSILON) })
}

/// Where a function is zero, that is expected to grow at least as fast as `slope`.
pub(super) struct Equation<P> {
    /// Where to begin.
    pub start: P,
    /// The function there.
    pub value: P,
    /// A lower bound of the slope, if the function is monotone.
    pub slope: P,
    /// Size of what is summed in the function: below its rounding, zero is zero.
    pub size: P,
}

impl<P: Scalar + PartialOrd> Equation<P> {
    /// What counts as zero; beyond all numbers nothing does.
    fn settled(&self) -> P {
        let settled = self.size * rounding::<P>() * P::from_f64(SLACK);
        if settled.value().is_finite() { settled } else { P::zero() }
    }

    /// The root: exact to rounding, by a bounded number of evaluations. Where the function does not
    /// change its sign within reach, the last place looked at.
    pub fn solve(&self, function: impl FnMut(P) -> P) -> P {
        self.solve_above(P::from_f64(f64::NEG_INFINITY), function).unwrap_or(self.start)
    }

    /// The root likewise, if it lies above `least`: the function is negative there.
    pub fn solve_above(&self, least: P, mut function: impl FnMut(P) -> P) -> Option<P> {
        let (settled, half) = (self.settled(), P::from_f64(0.5));
        let (mut near, mut f_near) = (self.start, self.value);
        if f_near.abs() <= settled {
            return Some(near);
        }
        let mut way = -f_near / self.slope;
        for _ in 0..MOST_WIDENED {
            let far = near + way;
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
            // Further by the secant; twice as far where that has not brought it much nearer.
            let left = f_far / f_near;
            let brought = left > P::zero() && left < half;
            way *= if brought { left / (P::one() - left) } else { P::from_f64(2.0) };
            // Beside a jump a secant is too steep: onwards by no less than rounding.
            let shortest = rounding::<P>() * far.abs();
            if way.abs() < shortest {
                way = way.sign() * shortest;
            }
            (near, f_near) = (far, f_far);
        }
        Some(near)
    }
}

/// Closes an enclosure of a root, whose second end is the latest.
fn narrow<P: Scalar + PartialOrd>(
    mut function: impl FnMut(P) -> P,
    [first, second]: [(P, P); 2],
    settled: P,
) -> P {
    let (half, one) = (P::from_f64(0.5), P::one());
    let unit = rounding::<P>();
    let (mut best, mut other) = (second, first);
    let secant = best.1 / (best.1 - other.1);
    // Beyond all numbers there is none.
    let mut share = if secant > P::zero() && secant < one { secant } else { half };
    let mut nearest = nearer(best, other);
    for _ in 0..MOST_NARROWED {
        // Off both ends by no less than rounding: a flat stretch beside a jump looks like a root.
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

/// The end at which the function is smaller.
fn nearer<P: Scalar + PartialOrd>(best: (P, P), other: (P, P)) -> (P, P) {
    if other.1.abs() < best.1.abs() { other } else { best }
}

/// Share of the way from `a` to `b` at which the inverse quadratic through three points is zero, if
/// that lies where it is sure to gain.
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
