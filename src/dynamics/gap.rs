//! Backlash: a gap between two flanks that opens when the load torque changes its sign and closes
//! with the motion.
//!
//! `w` is the travel since the change of sign, `dw = |v|^n vr^(1 - n) dt`. `g = exp(-(w/b)^2)` is
//! the share of the load torque that is not carried. The momentum `P` that the load has lost
//! meanwhile is restored as the flanks meet: where `g` falls by the factor `e^-h` in a step,
//! `P (1 - e^-h)/dt` on average over the step.

use super::Interval;
use crate::scalar::{Mask, Real};

/// Parameters of a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap<S: Real> {
    /// `b` (X): travel over which it closes to 1/e.
    pub width: S,
    /// `n`: 1 if it closes with the travel of the motor, 0 if it takes the same time at any speed.
    pub exponent: S,
    /// Speed `vr` (X/s) at which the exponent has no influence.
    pub reference: S::Plain,
    /// Share of the momentum that is restored.
    pub returned: S,
}

/// State of the gap.
#[derive(Clone, Copy, Debug)]
pub struct Flanks<S: Real> {
    /// Whether there was a step before.
    pub(super) begun: S::Mask,
    /// Load torque at the end of the step before (T).
    pub(super) load: S,
    /// Whether the load torque has changed its sign; before that the flanks touch.
    pub(super) parted: S::Mask,
    /// `w` (X).
    pub(super) way: S,
    /// `P` (T s).
    pub(super) momentum: S,
}

impl<S: Real> Default for Flanks<S> {
    fn default() -> Self {
        let (no, zero) = (S::Mask::of(false), S::zero());
        Self { begun: no, load: zero, parted: no, way: zero, momentum: zero }
    }
}

impl<S: Real> Gap<S> {
    /// The part of the load torque that the gap takes away over `interval` (T).
    #[inline]
    pub fn step_over(&self, state: &mut Flanks<S>, interval: &Interval<S::Plain>) -> S {
        let before = *state;
        let load = S::from_plain(interval.sample.load_torque);
        let earlier = S::choose(before.begun, before.load, load);
        let lasts = interval.dt.is_positive();
        let crossed = lasts.and((load * earlier).is_negative());
        let parted = before.parted.or(crossed);
        let start = S::choose(crossed, S::zero(), before.way);
        // Within the step the load torque changes linearly.
        let crosses = || self.way(interval) * (load / (load - earlier));
        let goes_on = || before.way + self.way(interval);
        let end = parted.and(lasts).either(|| crossed.either(crosses, goes_on), || before.way);
        let [taken, momentum] = parted.either(
            || self.taken(load, [start / self.width, end / self.width], before.momentum, interval),
            || [S::zero(), before.momentum],
        );
        // A load torque of 0 has no sign: the one before stays.
        let signed = S::choose(load.at_zero(), earlier, load);
        *state = Flanks { begun: S::Mask::of(true), load: signed, parted, way: end, momentum };
        taken
    }

    /// The part of the load torque taken away (T) and the momentum still missing afterwards (T s),
    /// for a travel from `start` to `end`, in widths.
    #[inline]
    fn taken(
        &self,
        load: S,
        [start, end]: [S; 2],
        momentum: S,
        interval: &Interval<S::Plain>,
    ) -> [S; 2] {
        let dt = interval.dt;
        let left = load * (-(end * end)).exp();
        let closes = || {
            let met = (start * start - end * end).expm1();
            let made_up = -(momentum * met);
            let lacking = (left * self.returned).scale(dt) + momentum - made_up;
            [-left + made_up.scale(S::Plain::one() / dt), lacking]
        };
        dt.is_positive().either(closes, || [-left, momentum])
    }

    /// The travel over which the gap closes in a step (X).
    #[inline]
    fn way(&self, interval: &Interval<S::Plain>) -> S {
        let ratio = interval.velocity().abs() / self.reference;
        self.exponent.exp_with_base(ratio).scale(self.reference * interval.dt)
    }
}
