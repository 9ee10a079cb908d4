//! Dahl's bristle with any exponent, stepped exactly for a velocity that is constant over the step.
//!
//! `dz/dt = v sgn(u) |u|^n` with `u = 1 - sgn(v) s0 z/D`, and `tf = s0 z + V + additive` (Dahl
//! 1968). Over a travel `|v| dt`, with `k = s0 |v| dt/D`, `u` becomes `u e^-w` and its mean over
//! the step is `u ln(1 + c)/c phi_1((n - 2) w)`, where `c = (n - 1) k |u|^(n-1)` and
//! `w = ln(1 + c)/(n - 1)`: smooth in `n`, also at `n = 1` (`w = k`) and `n = 2`. For `n < 1`
//! sliding begins within the step where `c <= -1`.

use super::{BristleState, Interval, Step, following, logarithm_ratio};
use crate::sample::Split;
use crate::scalar::{Mask, Real};

/// Above this `k` dry friction is negligible.
const VANISHED: f64 = 1e30;

/// Below this `k` the joint is at rest; the slope of `ln k` would overflow.
const STILL: f64 = 1e-290;

/// Above this `c` the 1 in `1 + c` is below the rounding error.
const FAR: f64 = 1e15;

/// Parameters of Dahl's bristle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DahlBristle<S> {
    /// Stiffness `s0` (T/X).
    pub stiffness: S,
    /// Exponent `n`: with 1 sliding is approached exponentially, above 1 more slowly, below 1 it is
    /// reached.
    pub exponent: S,
}

impl<S: Real> DahlBristle<S> {
    /// Steps over `interval` with the dry magnitude `dry` constant; the torque is that of `split`,
    /// at the end.
    #[inline]
    pub fn step_over(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let Slid { mean, following } = self.advance(state, dry, interval);
        if interval.mean_velocity.is_some() {
            let moved = (split.dry() - dry) / self.stiffness;
            state.z += moved.along(interval.velocity()) * following;
        }
        let torque = self.stiffness * state.z + split.rate + split.additive;
        if !interval.mean {
            return Step::same(torque);
        }
        Step { torque, mean_torque: self.stiffness * mean + split.rate + split.additive }
    }

    /// Advances the state.
    #[inline]
    fn advance(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        interval: &Interval<S::Plain>,
    ) -> Slid<S> {
        let before = state.z;
        let travel = interval.travel();
        let pull = self.stiffness.scale(travel);
        let target = (dry / self.stiffness).along(interval.velocity());
        let slides = || {
            let gap = target - before;
            let Fall { covered, mean, following } =
                self.fall((gap * self.stiffness / dry).abs(), pull / dry);
            [before + gap * covered, before + gap * mean, following]
        };
        let vanished = pull.reaches(dry.plain() * S::Plain::from_f64(VANISHED));
        let [z, mean, following] = travel.at_zero().either(
            || [before, before, S::zero()],
            || vanished.either(|| [target, target, S::one()], slides),
        );
        state.z = z;
        Slid { mean, following }
    }

    /// The decrease of `u > 0` over a travel `k`.
    #[inline]
    fn fall(&self, u: S, k: S) -> Fall<S> {
        let arrived = u.at_zero().or(u.is_finite().not());
        let still = k.is_below(S::Plain::from_f64(STILL)).or(k.at_zero());
        let [covered, mean, following] = arrived.either(
            || at_once(S::one()),
            || still.either(|| [S::zero(); 3], || self.approach(u, k)),
        );
        Fall { covered, mean, following }
    }

    /// Like [`fall`](Self::fall) for a bristle that moves and has not reached sliding: `covered`,
    /// `mean` and `following`.
    #[inline]
    fn approach(&self, u: S, k: S) -> [S; 3] {
        let one = S::Plain::one();
        let excess = self.exponent.shift(-one);
        let other = excess.shift(-one);
        // ln(k u^(n-1)): the power itself may overflow.
        let pace = excess * u.ln() + k.ln();
        let reach = pace.exp();
        let c = excess * reach;
        let far = || {
            let w = (excess.ln() + pace) / excess;
            let bend = other * w;
            let growth = S::choose(bend.is_positive(), bend, S::zero());
            [w, w * (-bend.abs()).phi(1) * (growth - pace).exp()]
        };
        let near = || {
            let slope = logarithm_ratio(c);
            let w = reach * slope;
            [w, slope * (other * w).phi(1)]
        };
        let falls = || {
            let [w, area] = c.is_above(S::Plain::from_f64(FAR)).either(far, near);
            let y = -w;
            [-y.expm1(), (-area).shift(one), following(y, y.phi(1))]
        };
        let ends = c.is_below(-one).or(c.equals(-one));
        ends.either(|| at_once((S::one() / (other * reach)).shift(one)), falls)
    }
}

/// The result of a step: the mean deflection, and the share of a change of the target that it has
/// followed.
struct Slid<S> {
    mean: S,
    following: S,
}

/// The share of the distance to sliding that is covered, at the end of a step and on average.
struct Fall<S> {
    covered: S,
    mean: S,
    following: S,
}

/// Sliding is reached within the step, in which this share is covered on average.
#[inline]
fn at_once<S: Real>(mean: S) -> [S; 3] {
    [S::one(), mean, S::one()]
}
