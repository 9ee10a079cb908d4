//! The generalized Maxwell slip model, stepped exactly for a velocity that is constant over the
//! step.
//!
//! Each element sticks, `dF_i/dt = k_i v`, until its force reaches `a_i s(v)` in the direction of
//! motion; then it slides, `dF_i/dt = C (a_i s sgn v - F_i)/s`, until the velocity passes through
//! zero (Al-Bender, Lampaert and Swevers 2005, eqs 18-20). Here `s = D` and `a_i = F_i/sum F`. At a
//! constant velocity the force is a ramp followed by an exponential, with at most one transition.

use super::{Elements, Interval, MAX_ELEMENTS, SATURATED, Step};
use crate::sample::Split;
use crate::scalar::{Mask, Real};

/// Parameters of the elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxwellSlip<'a, S> {
    /// Force of each element in sliding, relative to the others (T).
    pub friction: &'a [S; MAX_ELEMENTS],
    /// Stiffness of each element (T/X).
    pub stiffness: &'a [S; MAX_ELEMENTS],
    /// Number of elements.
    pub count: usize,
    /// Rate at which a sliding element settles, `C` (T/s).
    pub attraction: S,
}

impl<S: Real> MaxwellSlip<'_, S> {
    /// Steps over `interval` with the dry magnitude `dry` constant; the torque is that of `split`,
    /// at the end.
    #[inline]
    pub fn step_over(
        &self,
        state: &mut Elements<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let count = self.count.min(MAX_ELEMENTS);
        let slide = self.slide(dry, split.dry(), interval);
        let (mut force, mut mean) = (S::zero(), S::zero());
        for k in 0..count {
            let element = Element { friction: self.friction[k], stiffness: self.stiffness[k] };
            mean += element.advance(&mut state.force[k], &mut state.sliding[k], &slide);
            force += state.force[k];
        }
        let torque = force + split.rate + split.additive;
        if !interval.mean {
            return Step::same(torque);
        }
        Step { torque, mean_torque: mean + split.rate + split.additive }
    }

    /// Values common to all elements over a step at whose end dry friction is `end`.
    #[inline]
    fn slide(&self, dry: S, end: S, interval: &Interval<S::Plain>) -> Slide<S> {
        let mut total = S::zero();
        for &friction in &self.friction[..self.count.min(MAX_ELEMENTS)] {
            total += friction;
        }
        let change = if interval.mean_velocity.is_some() { end - dry } else { S::zero() };
        let dt = S::Plain::choose(interval.dt.is_positive(), interval.dt, S::Plain::zero());
        let settling = Settling { pull: self.attraction.scale(dt), dry, mean: interval.mean };
        Slide {
            direction: interval.velocity().sign(),
            travel: interval.travel(),
            from: (dry - change) / total,
            to: (dry + change) / total,
            whole: settling.weights(S::one()),
            settling,
        }
    }
}

/// Values common to all elements over a step.
struct Slide<S: Real> {
    direction: S::Plain,
    travel: S::Plain,
    /// Force in sliding over the friction of an element, at the start of the step and at its end:
    /// it changes linearly and has the constant value at the middle.
    from: S,
    to: S,
    settling: Settling<S>,
    /// The weights of an element that slides during the whole step.
    whole: Weights<S>,
}

/// The settling of a sliding element: over the whole step it relaxes by the exponent `pull/dry`.
struct Settling<S> {
    pull: S,
    dry: S,
    mean: bool,
}

/// The remaining shares of a distance: its mean (`phi_1`), the mean for a distance that grows
/// linearly (`phi_2`, if the mean is requested), and the share covered at the end.
struct Weights<S> {
    first: S,
    second: S,
    covered: S,
}

impl<S: Real> Settling<S> {
    /// The weights over a share of the step.
    #[inline]
    fn weights(&self, share: S) -> Weights<S> {
        let pull = self.pull * share;
        let stays = || [S::one(), S::from_f64(0.5), S::zero()];
        let follows = || {
            let y = -(pull / self.dry);
            let first = y.phi(1);
            let second = if self.mean { y.phi(2) } else { S::zero() };
            [first, second, -(y * first)]
        };
        let arrives = || {
            let first = self.dry.is_positive().either(|| self.dry / pull, S::zero);
            [first, first * (-first).shift(S::Plain::one()), S::one()]
        };
        let bound = self.dry.plain() * S::Plain::from_f64(SATURATED);
        let [first, second, covered] =
            pull.at_zero().either(stays, || pull.is_below(bound).either(follows, arrives));
        Weights { first, second, covered }
    }
}

struct Element<S> {
    friction: S,
    stiffness: S,
}

impl<S: Real> Element<S> {
    /// Advances one element and returns its mean force over the step.
    #[inline]
    fn advance(&self, force: &mut S, sliding: &mut S::Plain, slide: &Slide<S>) -> S {
        let (direction, held) = (slide.direction, *force);
        let slides = sliding.equals(direction.plain());
        let moves = || {
            let [after, mean, sticks] = self.along(held.scale(direction), slides, slide);
            [after.scale(direction), mean.scale(direction), sticks]
        };
        let rests = || [held, held, S::one()];
        let [after, mean, sticks] = direction.at_zero().either(rests, moves);
        *force = after;
        *sliding = S::Plain::choose(sticks.at_zero(), direction, S::Plain::zero());
        mean
    }

    /// Force at the end and mean force of an element that starts at `before`, both along the
    /// motion, and 1 if it sticks throughout, else 0. One that `slides` does so until the motion
    /// reverses; another sticks for a share of the step, or for all of it.
    #[inline]
    fn along(&self, before: S, slides: S::Mask, slide: &Slide<S>) -> [S; 3] {
        let half = S::Plain::from_f64(0.5);
        let (from, to) = (self.friction * slide.from, self.friction * slide.to);
        let goes_on = || {
            let [after, mean] = approach(before, (from, to), &slide.whole);
            [after, mean, S::zero()]
        };
        let begins = || {
            let room = from - before;
            let reach = self.stiffness.scale(slide.travel);
            let gain = reach - (to - from);
            let sticks = || [before + reach, before + reach.scale(half), S::one()];
            let breaks_away = || {
                let share = room / gain;
                let rest = (-share).shift(S::Plain::one());
                let start = before + reach * share;
                let weights = slide.settling.weights(rest);
                let [after, mean] = approach(start, (start, to), &weights);
                [after, share * (before + start).scale(half) + rest * mean, S::zero()]
            };
            let at_limit = room.is_negative().or(room.at_zero());
            at_limit.either(goes_on, || room.is_above(gain.plain()).either(sticks, breaks_away))
        };
        slides.either(goes_on, begins)
    }
}

/// Force at the end and mean force of an element that starts at `start` and tends to a limit that
/// moves linearly.
#[inline]
fn approach<S: Real>(start: S, (from, to): (S, S), weights: &Weights<S>) -> [S; 2] {
    let (gap, rise) = (from - start, to - from);
    let after = start + gap * weights.covered + rise * (-weights.first).shift(S::Plain::one());
    let half = S::Plain::from_f64(0.5);
    [after, from - gap * weights.first + rise * (-weights.second).shift(half)]
}
