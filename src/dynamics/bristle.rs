//! A bristle for any split law, stepped exactly for a velocity that is constant over the step.
//!
//! `dz/dt = v - s0 |v|/D z`, `tf = s0 z + s1 dz/dt + V + additive` (Canudas de Wit et al. 1995, eqs
//! 4-6, with any dry magnitude `D`). With `x = s0 |v| dt/D` the deflection covers the share
//! `1 - e^-x` of the distance to its target `sgn(v) D/s0`: stable and without overshoot for every
//! stiffness and step. Share and target do not depend on `z`, so they are computed for many samples
//! in parallel.
//!
//! With a smoothed sign `S(v)`, `dz/dt = S^2 v - s0 S v/D z` (Indri et al. 2020): the share uses
//! `x |S|`, and the target is `S D/s0`.

use super::{Approach, Deflection, Interval, SATURATED, Step, following};
#[cfg(test)]
use crate::sample::Sample;
use crate::sample::{Split, arctangent_sign};
use crate::scalar::{Mask, Real, Scalar};

/// A bristle with a shorter settling time (s) is settled at the end of any step.
const SHORTEST: f64 = 1e-12;

/// Below this dry friction (T) there is no bristle.
const LEAST_DRY: f64 = 1e-30;

/// Parameters of a bristle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristle<S> {
    /// Stiffness `s0` (T/X).
    pub stiffness: S,
    /// Damping `s1` (T s/X).
    pub damping: S,
    /// Steepness of the smoothed sign (s/X); `None` for the exact sign.
    pub sign_steepness: Option<S>,
}

/// The dry magnitude (T) at which the deflection just settles within a step of this length (s), and
/// whether `dry` is below it and must be replaced by it. It is positive at rest too, where the pull
/// is 0.
#[inline(always)]
fn settling<S: Real>(pull: S, dry: S, dt: S::Plain) -> (S::Plain, S::Mask) {
    let shortest = S::Plain::from_f64(SHORTEST);
    let lasting = S::Plain::choose(dt.is_above(shortest.plain()), dt, shortest);
    let share = lasting * S::Plain::from_f64(1.0 / SATURATED);
    let lowest = pull.plain() * share + S::Plain::from_f64(LEAST_DRY);
    (lowest, dry.is_below(lowest))
}

/// State of a bristle, separate from its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BristleState<S> {
    /// Mean deflection `z` (X).
    pub z: S,
}

impl<S: Real> Default for BristleState<S> {
    fn default() -> Self {
        Self { z: S::zero() }
    }
}

impl<S: Real> Bristle<S> {
    /// A bristle of this stiffness (T/X) and damping (T s/X).
    #[inline(always)]
    #[must_use]
    pub const fn new(stiffness: S, damping: S) -> Self {
        Self { stiffness, damping, sign_steepness: None }
    }

    /// `S(v)`, if the sign is smoothed.
    #[inline(always)]
    fn smoothed_sign(&self, velocity: S::Plain) -> Option<S> {
        self.sign_steepness.map(|steepness| arctangent_sign(velocity, steepness))
    }

    /// The coefficient that pulls the deflection to its target, for `way = |v|` (T/s) or `|v| dt`
    /// (T).
    #[inline(always)]
    fn pull(&self, velocity: S::Plain, way: S::Plain) -> S {
        let pull = self.stiffness.scale(way);
        self.smoothed_sign(velocity).map_or(pull, |sign| pull * sign.abs())
    }

    /// `x` with the sign of the velocity.
    #[inline(always)]
    fn along(&self, velocity: S::Plain, x: S) -> S {
        self.smoothed_sign(velocity).map_or_else(|| x.along(velocity), |sign| x * sign)
    }

    /// The effect of a constant velocity on the deflection over `dt` (s); none with `dt <= 0`.
    ///
    /// At rest the deflection does not change. For a dry magnitude `D <= 0` the limit
    /// `z = sgn(v) D/s0` is used, so that a fit that passes through it gets a finite slope.
    #[inline(always)]
    pub(crate) fn course(&self, dry: S, velocity: S::Plain, dt: S::Plain) -> Course<S> {
        let lasts = dt.is_positive();
        let dt = S::Plain::choose(lasts, dt, S::Plain::zero());
        let pull = self.pull(velocity, velocity.abs());
        let (lowest, settled) = settling(pull, dry, dt);
        let pace = pull / S::choose(settled, S::from_plain(lowest), dry);
        let pace = S::choose(settled.and(lasts.not()), S::zero(), pace);
        let decay = pace.scale(-dt);
        let left = decay.expm1();
        let target = self.target(dry, velocity);
        Course { target, share: -left, pace, decay, left, rest: velocity.at_zero(), settled }
    }

    /// The target of the deflection (X).
    #[inline(always)]
    pub(crate) fn target(&self, dry: S, velocity: S::Plain) -> S {
        self.along(velocity, dry / self.stiffness)
    }

    /// Correction of the deflection at the end of a step (X), where dry magnitude and velocity have
    /// changed from the constant values to those at the end.
    #[inline(always)]
    pub(crate) fn shift(
        &self,
        course: &Course<S>,
        [dry, end]: [S; 2],
        [velocity, last]: [S::Plain; 2],
    ) -> S {
        let moved = match self.sign_steepness {
            None => ((end - dry) / self.stiffness).along(velocity),
            Some(_) => {
                // Only the magnitude of the smoothed sign changes, not the direction of motion.
                let along = velocity.sign() * last.sign();
                self.target(end, last).scale(along) - course.target
            }
        };
        moved * course.following()
    }

    /// Torque at the deflection `z` with `dz/dt = rate` (X/s).
    #[inline(always)]
    pub(crate) fn torque(&self, z: S, rate: S, split: &Split<S>) -> S {
        self.stiffness * z + self.damping * rate + split.rate + split.additive
    }

    /// `dz/dt` at `z`; 0 for a bristle that settles at once.
    #[inline(always)]
    pub(crate) fn rate(&self, z: S, dry: S, velocity: S::Plain) -> S {
        let pull = self.pull(velocity, velocity.abs());
        let (_, settled) = settling(pull, dry, S::Plain::zero());
        let rate = match self.sign_steepness {
            None => (-(pull / dry * z)).shift(velocity),
            Some(_) => pull / dry * (self.target(dry, velocity) - z),
        };
        S::choose(settled, S::zero(), rate)
    }
}

impl<S: Real> Bristle<S> {
    /// The equation of the deflection at `velocity`, for proofs.
    #[inline]
    #[must_use]
    pub(crate) fn deflection(&self, velocity: S::Plain) -> Deflection<S>
    where
        S: Scalar,
    {
        let drag = self.damping.scale(velocity.abs());
        let approach =
            self.smoothed_sign(velocity).map_or(Approach::Linear, |s| Approach::Smoothed(s.abs()));
        Deflection { stiffness: self.stiffness, drag, approach }
    }

    /// Steps over `interval` with the dry magnitude `dry` constant; the torque is that of `split`,
    /// at the end.
    #[inline(always)]
    pub(crate) fn step_over(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let velocity = interval.velocity();
        let course = self.course(dry, velocity, interval.dt);
        let before = state.z;
        state.z = course.end(before);
        let rate = if interval.mean_velocity.is_some() {
            let end = split.dry();
            let last = interval.sample.velocity;
            state.z += self.shift(&course, [dry, end], [velocity, last]);
            self.rate(state.z, end, last)
        } else {
            course.end_rate(before)
        };
        let torque = self.torque(state.z, rate, split);
        if !interval.mean {
            return Step::same(torque);
        }
        let pull = self.pull(velocity, interval.travel());
        let mean_torque = self.mean_torque(before, &course, dry / pull, split, interval.dt);
        Step { torque, mean_torque }
    }

    /// Steps over `dt` (s) with `velocity` and `split` constant. With `dt <= 0` the state is
    /// unchanged.
    #[cfg(test)]
    pub(crate) fn step(
        &self,
        state: &mut BristleState<S>,
        split: &Split<S>,
        velocity: S::Plain,
        dt: S::Plain,
    ) -> Step<S> {
        let interval = Interval { mean: true, ..Interval::constant(Sample::at(velocity), dt) };
        self.step_over(state, split.dry(), split, &interval)
    }

    /// Torque averaged over the step; `reach` is `1/x`.
    #[inline]
    fn mean_torque(
        &self,
        before: S,
        course: &Course<S>,
        reach: S,
        split: &Split<S>,
        dt: S::Plain,
    ) -> S {
        let way = course.target - before;
        let stays = || self.torque(course.end(before), S::zero(), split);
        let settles = || {
            // The transient is over, but the mean still contains its area, way/x.
            let slip = way.scale(S::Plain::one() / dt);
            self.torque(course.target - way * reach, slip, split)
        };
        let follows = || {
            // Relative to where the deflection is for most of the step: avoids cancellation.
            let phi = course.phi();
            let mean = course.decay.is_below(-S::Plain::one()).either(
                || course.target - way * phi,
                || before - course.decay * course.decay.phi(2) * way,
            );
            self.torque(mean, course.pace * phi * way, split)
        };
        let still = course.rest.or(dt.is_positive().not());
        still.either(stays, || course.settled.either(settles, follows))
    }
}

/// The effect of a step: the deflection covers a share of the distance to a target.
#[derive(Clone, Copy, Debug)]
pub struct Course<S: Real> {
    /// The target of the deflection (X).
    pub target: S,
    /// `1 - e^-x`.
    pub share: S,
    /// `s0 |v|/D` (1/s), 0 for a bristle at rest.
    pace: S,
    /// `-x`.
    decay: S,
    /// `e^-x - 1`.
    left: S,
    rest: S::Mask,
    settled: S::Mask,
}

impl<S: Real> Course<S> {
    /// The deflection at the end, from `z` (X).
    #[inline(always)]
    pub fn end(&self, z: S) -> S {
        z + self.share * (self.target - z)
    }

    /// `dz/dt` at the end, from `z` at the start (X/s).
    #[inline(always)]
    pub fn end_rate(&self, z: S) -> S {
        self.pace * self.left.shift(S::Plain::one()) * (self.target - z)
    }

    /// `phi_1(-x)`.
    #[inline(always)]
    fn phi(&self) -> S {
        S::choose(self.decay.at_zero(), S::one(), self.left / self.decay)
    }

    /// The share of a change of the target that the deflection has followed.
    #[inline(always)]
    fn following(&self) -> S {
        let moving = S::choose(self.settled, S::one(), following(self.decay, self.phi()));
        S::choose(self.rest, S::zero(), moving)
    }
}
