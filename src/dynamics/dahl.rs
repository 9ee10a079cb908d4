//! Dahl's bristle with any exponent, stepped exactly for a velocity held over the step.
//!
//! `dz/dt = v sgn(u) |u|^n` with `u = 1 - sgn(v) s0 z/D`, and `tf = s0 z + V + additive` (Dahl
//! 1968). Over a travel `|v| dt`, with `k = s0 |v| dt/D`, `u` goes to `u e^-w` and the mean of `u`
//! over the step is `u ln(1 + c)/c phi_1((n - 2) w)`, where
//! `c = (n - 1) k |u|^(n-1)` and `w = ln(1 + c)/(n - 1)`: smooth in `n`, for `n = 1` (`w = k`) and
//! `n = 2` too. For `n < 1` sliding begins within the step where `c <= -1`.

use super::{BristleState, Interval, Step, following, logarithm_ratio};
use crate::sample::Split;
use crate::scalar::{Real, Scalar};

/// Above this `k` dry friction has vanished beside what the travel would have built up.
const VANISHED: f64 = 1e30;

/// Below this `k` nothing moves, and the slope of its logarithm is beyond all numbers.
const STILL: f64 = 1e-290;

/// Above this `c` the one in `1 + c` is lost.
const FAR: f64 = 1e15;

/// Parameters of Dahl's bristle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DahlBristle<S> {
    /// Stiffness `s0` (T/X).
    pub stiffness: S,
    /// Exponent `n`: 1 approaches sliding exponentially, more takes longer, less gets there.
    pub exponent: S,
}

impl<S: Scalar> DahlBristle<S> {
    /// Steps over `interval` with the dry magnitude `dry` held; `split` is that of the sample, with
    /// which the torque is read.
    #[inline]
    pub fn over(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let Slid { mean, following } = self.advance(state, dry, interval);
        if interval.mean_velocity.is_some() {
            let moved = (split.dry() - dry) / self.stiffness;
            state.z += moved.scale(interval.velocity().sign()) * following;
        }
        let torque = self.stiffness * state.z + split.rate + split.additive;
        if !interval.mean {
            return Step::same(torque);
        }
        Step { torque, mean_torque: self.stiffness * mean + split.rate + split.additive }
    }

    /// Moves the state.
    #[inline]
    fn advance(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        interval: &Interval<S::Plain>,
    ) -> Slid<S> {
        let travel = interval.travel();
        if travel.value() == 0.0 {
            return Slid { mean: state.z, following: S::zero() };
        }
        let before = state.z;
        let pull = self.stiffness.scale(travel);
        let target = (dry / self.stiffness).scale(interval.velocity().sign());
        if pull.value() >= VANISHED * dry.value() {
            state.z = target;
            return Slid { mean: target, following: S::one() };
        }
        let gap = target - before;
        let fall = self.fall((gap * self.stiffness / dry).abs(), pull / dry);
        state.z += gap * fall.covered;
        Slid { mean: before + gap * fall.mean, following: fall.following }
    }

    /// How `u > 0` falls over a travel `k`.
    #[inline]
    fn fall(&self, u: S, k: S) -> Fall<S> {
        let one = S::Plain::one();
        if u.value() == 0.0 || !u.value().is_finite() {
            return Fall::at_once(S::one());
        }
        if k.value() < STILL {
            let zero = S::zero();
            return Fall { covered: zero, mean: zero, following: zero };
        }
        let excess = self.exponent.shift(-one);
        let other = excess.shift(-one);
        // ln(k u^(n-1)): the power itself may be beyond all numbers.
        let pace = excess * u.ln() + k.ln();
        let reach = pace.exp();
        let c = excess * reach;
        if c.value() <= -1.0 {
            let area = S::one() / (other * reach);
            return Fall::at_once(area.shift(one));
        }
        let (w, area) = if c.value() > FAR {
            let w = (excess.ln() + pace) / excess;
            let bend = other * w;
            let growth = if bend.value() > 0.0 { bend } else { S::zero() };
            (w, w * (-bend.abs()).phi(1) * (growth - pace).exp())
        } else {
            let slope = logarithm_ratio(c);
            let w = reach * slope;
            (w, slope * (other * w).phi(1))
        };
        let y = -w;
        Fall { covered: -y.expm1(), mean: (-area).shift(one), following: following(y, y.phi(1)) }
    }
}

/// How a step went: the mean deflection, and how far it has followed where it tends to.
struct Slid<S> {
    mean: S,
    following: S,
}

/// What share of the way to sliding is covered at the end of a step, and on average over it.
struct Fall<S> {
    covered: S,
    mean: S,
    following: S,
}

impl<S: Scalar> Fall<S> {
    /// Sliding begins within the step.
    #[inline]
    fn at_once(mean: S) -> Self {
        Self { covered: S::one(), mean, following: S::one() }
    }
}
