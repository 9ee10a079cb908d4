//! The generalized Maxwell slip model, stepped exactly for a velocity held over the step.
//!
//! Each element sticks, `dF_i/dt = k_i v`, until its force reaches `a_i s(v)` in the direction of
//! motion; then it slides, `dF_i/dt = C (a_i s sgn v - F_i)/s`, until the velocity passes through
//! zero (Al-Bender, Lampaert and Swevers 2005, eqs 18-20). Here `s = D` and `a_i = F_i/sum F`. A held
//! velocity moves an element along a ramp, then an exponential: it changes over at most once.

use super::{Elements, Interval, MOST_ELEMENTS, SATURATED, Step};
use crate::sample::Split;
use crate::scalar::Real;

/// Parameters of the elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxwellSlip<'a, S> {
    /// What each element carries in sliding, relative to the others (T).
    pub friction: &'a [S; MOST_ELEMENTS],
    /// Stiffness of each element (T/X).
    pub stiffness: &'a [S; MOST_ELEMENTS],
    /// How many elements there are.
    pub count: usize,
    /// How fast a sliding element settles, `C` (T/s).
    pub attraction: S,
}

impl<S: Real> MaxwellSlip<'_, S> {
    /// Steps over `interval`; `held` is the split of what is held, `end` that of the sample at
    /// the end, with which the torque is read.
    #[inline]
    pub fn over(
        &self,
        state: &mut Elements<S>,
        held: &Split<S>,
        end: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let count = self.count.min(MOST_ELEMENTS);
        let slide = self.slide(held, end, interval);
        let (mut force, mut mean) = (S::zero(), S::zero());
        for k in 0..count {
            let element = Element { friction: self.friction[k], stiffness: self.stiffness[k] };
            mean += element.advance(&mut state.force[k], &mut state.sliding[k], &slide);
            force += state.force[k];
        }
        let torque = force + end.rate + end.additive;
        if !interval.mean {
            return Step::same(torque);
        }
        Step { torque, mean_torque: mean + held.rate + held.additive }
    }

    /// What all elements have in common over the step.
    #[inline]
    fn slide(&self, held: &Split<S>, end: &Split<S>, interval: &Interval<S::Plain>) -> Slide<S> {
        let mut total = S::zero();
        for &friction in &self.friction[..self.count.min(MOST_ELEMENTS)] {
            total += friction;
        }
        let dry = held.dry();
        let change = if interval.held.is_some() { end.dry() - dry } else { S::zero() };
        let dt = if interval.dt.value() > 0.0 { interval.dt } else { S::Plain::zero() };
        Slide {
            direction: interval.velocity().sign(),
            travel: interval.travel(),
            from: (dry - change) / total,
            to: (dry + change) / total,
            pull: self.attraction.scale(dt),
            dry,
            mean: interval.mean,
        }
    }
}

/// What all elements have in common over a step.
struct Slide<S: Real> {
    direction: S::Plain,
    travel: S::Plain,
    /// Force in sliding over the friction of an element, at the start of the step and at its end: it
    /// moves steadily through what is held, at the middle.
    from: S,
    to: S,
    /// The relaxation in sliding over the whole step is the ratio of these.
    pull: S,
    dry: S,
    /// Whether the mean is wanted.
    mean: bool,
}

impl<S: Real> Slide<S> {
    /// The weights of an exponential approach over a share of the step: `phi_1`, `phi_2` and what
    /// is covered.
    #[inline]
    fn weights(&self, share: S) -> (S, S, S) {
        let pull = self.pull * share;
        if pull.value() == 0.0 {
            return (S::one(), S::from_f64(0.5), S::zero());
        }
        if pull.value() < SATURATED * self.dry.value() {
            let y = -(pull / self.dry);
            let phi = y.phi(1);
            let second = if self.mean { y.phi(2) } else { S::zero() };
            return (phi, second, -(y * phi));
        }
        let phi = if self.dry.value() > 0.0 { self.dry / pull } else { S::zero() };
        (phi, phi * (-phi).shift(S::Plain::one()), S::one())
    }
}

struct Element<S> {
    friction: S,
    stiffness: S,
}

impl<S: Real> Element<S> {
    /// Moves one element and returns its mean force over the step.
    #[inline]
    fn advance(&self, force: &mut S, sliding: &mut i8, slide: &Slide<S>) -> S {
        if slide.direction.value() == 0.0 {
            *sliding = 0;
            return *force;
        }
        let (half, one) = (S::Plain::from_f64(0.5), S::Plain::one());
        let along = if slide.direction.value() > 0.0 { 1 } else { -1 };
        let before = force.scale(slide.direction);
        let (mut limit, end) = (self.friction * slide.from, self.friction * slide.to);
        // Where sliding starts from, the share of the step that is left for it, and the area under
        // the ramp.
        let (mut start, mut rest, mut ramp) = (before, S::one(), S::zero());
        if *sliding != along {
            let room = limit - before;
            let reach = self.stiffness.scale(slide.travel);
            let gain = reach - (end - limit);
            if room.value() > 0.0 {
                if room.value() > gain.value() {
                    *sliding = 0;
                    *force += reach.scale(slide.direction);
                    return (before + reach.scale(half)).scale(slide.direction);
                }
                let share = room / gain;
                start = before + reach * share;
                limit = start;
                ramp = share * (before + start).scale(half);
                rest = (-share).shift(one);
            }
            *sliding = along;
        }
        let (phi, second, covered) = slide.weights(rest);
        let (gap, rise) = (limit - start, end - limit);
        let after = start + gap * covered + rise * (-phi).shift(one);
        *force = after.scale(slide.direction);
        let mean = limit - gap * phi + rise * (-second).shift(half);
        (ramp + rest * mean).scale(slide.direction)
    }
}
