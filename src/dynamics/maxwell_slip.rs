//! The generalized Maxwell slip model, stepped exactly for a velocity held over the step.
//!
//! Each element sticks, `dF_i/dt = k_i v`, until its force reaches `a_i s(v)` in the direction of
//! motion; then it slides, `dF_i/dt = C (a_i s sgn v - F_i)/s`, until the velocity passes through
//! zero (Al-Bender, Lampaert and Swevers 2005, eqs 18-20). Here `s = D` and `a_i = F_i/sum F`. A held
//! velocity moves an element along a ramp, then an exponential: it changes over at most once.

use super::{Elements, Interval, MOST_ELEMENTS, SATURATED, Step};
use crate::sample::Split;
use crate::scalar::{Real, Scalar};

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

impl<S: Scalar> MaxwellSlip<'_, S> {
    /// Steps over `interval` with the dry magnitude `dry` held; `split` is that of the sample, with
    /// which the torque is read.
    #[inline]
    pub fn over(
        &self,
        state: &mut Elements<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let count = self.count.min(MOST_ELEMENTS);
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

    /// What all elements have in common over a step at whose end dry friction is `end`.
    #[inline]
    fn slide(&self, dry: S, end: S, interval: &Interval<S::Plain>) -> Slide<S> {
        let mut total = S::zero();
        for &friction in &self.friction[..self.count.min(MOST_ELEMENTS)] {
            total += friction;
        }
        let change = if interval.mean_velocity.is_some() { end - dry } else { S::zero() };
        let dt = if interval.dt.value() > 0.0 { interval.dt } else { S::Plain::zero() };
        let settling = Settling { pull: self.attraction.scale(dt), dry, mean: interval.mean };
        Slide {
            direction: interval.velocity().sign(),
            travel: interval.travel(),
            from: (dry - change) / total,
            to: (dry + change) / total,
            whole: settling.over(S::one()),
            settling,
        }
    }
}

/// What all elements have in common over a step.
struct Slide<S: Scalar> {
    direction: S::Plain,
    travel: S::Plain,
    /// Force in sliding over the friction of an element, at the start of the step and at its end: it
    /// moves steadily through what is held, at the middle.
    from: S,
    to: S,
    settling: Settling<S>,
    /// The weights of an element that slides through the whole step.
    whole: Weights<S>,
}

/// How a sliding element settles: its relaxation over the whole step is `pull/dry`.
struct Settling<S> {
    pull: S,
    dry: S,
    mean: bool,
}

/// What is left of a way, at the mean of it (`phi_1`) and of a way that grows (`phi_2`, if the mean
/// is wanted), and what is covered at the end.
struct Weights<S> {
    first: S,
    second: S,
    covered: S,
}

impl<S: Scalar> Settling<S> {
    /// The weights over a share of the step.
    #[inline]
    fn over(&self, share: S) -> Weights<S> {
        let pull = self.pull * share;
        if pull.value() == 0.0 {
            return Weights { first: S::one(), second: S::from_f64(0.5), covered: S::zero() };
        }
        if pull.value() < SATURATED * self.dry.value() {
            let y = -(pull / self.dry);
            let first = y.phi(1);
            let second = if self.mean { y.phi(2) } else { S::zero() };
            return Weights { first, second, covered: -(y * first) };
        }
        let first = if self.dry.value() > 0.0 { self.dry / pull } else { S::zero() };
        let second = first * (-first).shift(S::Plain::one());
        Weights { first, second, covered: S::one() }
    }
}

/// What an element does over a step.
enum Course<S> {
    /// It sticks throughout, and its force grows by this along the motion.
    Sticks(S),
    /// It sticks for this share of the step and begins to slide at this force.
    BreaksAway { share: S, force: S },
    /// It slides throughout.
    Slides,
}

struct Element<S> {
    friction: S,
    stiffness: S,
}

impl<S: Scalar> Element<S> {
    /// Moves one element and returns its mean force over the step.
    #[inline]
    fn advance(&self, force: &mut S, sliding: &mut i8, slide: &Slide<S>) -> S {
        if slide.direction.value() == 0.0 {
            *sliding = 0;
            return *force;
        }
        let along = if slide.direction.value() > 0.0 { 1 } else { -1 };
        let half = S::Plain::from_f64(0.5);
        let before = force.scale(slide.direction);
        let limits = (self.friction * slide.from, self.friction * slide.to);
        let course =
            if *sliding == along { Course::Slides } else { self.course(before, limits, slide) };
        *sliding = if matches!(course, Course::Sticks(_)) { 0 } else { along };
        let (after, mean) = match course {
            Course::Sticks(rise) => (before + rise, before + rise.scale(half)),
            Course::Slides => approach(before, limits, &slide.whole),
            Course::BreaksAway { share, force } => {
                let rest = (-share).shift(S::Plain::one());
                let (after, mean) = approach(force, (force, limits.1), &slide.settling.over(rest));
                (after, share * (before + force).scale(half) + rest * mean)
            }
        };
        *force = after.scale(slide.direction);
        mean.scale(slide.direction)
    }

    /// What an element that sticks at first does; forces along the motion.
    #[inline]
    fn course(&self, before: S, (from, to): (S, S), slide: &Slide<S>) -> Course<S> {
        let room = from - before;
        let reach = self.stiffness.scale(slide.travel);
        let gain = reach - (to - from);
        if room.value() <= 0.0 {
            Course::Slides
        } else if room.value() > gain.value() {
            Course::Sticks(reach)
        } else {
            let share = room / gain;
            Course::BreaksAway { share, force: before + reach * share }
        }
    }
}

/// Force at the end and mean force of an element that starts at `start` and tends to a limit that
/// moves from one place to another.
#[inline]
fn approach<S: Scalar>(start: S, (from, to): (S, S), weights: &Weights<S>) -> (S, S) {
    let (gap, rise) = (from - start, to - from);
    let after = start + gap * weights.covered + rise * (-weights.first).shift(S::Plain::one());
    let half = S::Plain::from_f64(0.5);
    (after, from - gap * weights.first + rise * (-weights.second).shift(half))
}
