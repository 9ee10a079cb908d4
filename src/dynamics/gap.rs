//! Backlash: a gap between two flanks that opens when the load torque changes its sign and closes
//! with the motion.
//!
//! `w` is the travel since the change of sign, `dw = |v|^n vr^(1 - n) dt`. `g = exp(-(w/b)^2)` is
//! the share of the load torque that is not carried. The momentum `P` that the load has lost
//! meanwhile is restored as the flanks meet: where `g` falls by the factor `e^-h` in a step,
//! `P (1 - e^-h)/dt` on average over the step.

use super::Interval;
use super::history::{History, Kept};
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

impl<S: Real> Gap<S> {
    /// The part of the load torque that the gap takes away over `interval` (T).
    #[inline]
    pub fn step_over(&self, history: &mut impl History<S>, interval: &Interval<S::Plain>) -> S {
        let zero = S::zero();
        let load = S::from_plain(interval.sample.load_torque);
        // A load torque of 0 has no sign: the one before stays.
        let [earlier, _] = history.hold(Kept::Load, load.at_zero().not(), load);
        let lasts = interval.dt.is_positive();
        let crossed = lasts.and((load * earlier).is_negative());
        let [_, parted] = history.hold(Kept::GapParted, crossed, S::one());
        let parted = parted.at_zero().not();
        let way = parted.and(lasts).either(|| self.way(interval), || zero);
        // Within the step the load torque changes linearly.
        let crosses = || way * (load / (load - earlier));
        let [start, end] = history.count(Kept::GapWay, crossed, crosses, way);
        let start = S::choose(crossed, zero, start);
        let [left, met, lacking] = parted.either(
            || self.course(load, [start / self.width, end / self.width], interval),
            || [zero; 3],
        );
        let [momentum, _] = history.relax(Kept::GapMomentum, met, lacking);
        let made_up =
            lasts.either(|| (momentum * met).scale(S::Plain::one() / interval.dt), || zero);
        made_up - left
    }

    /// The part of the load torque that is not carried (T), the share of the momentum that is made
    /// up in the step, and what is added to it (T s), for a travel from `start` to `end`, in widths.
    #[inline]
    fn course(&self, load: S, [start, end]: [S; 2], interval: &Interval<S::Plain>) -> [S; 3] {
        let dt = interval.dt;
        let left = load * (-(end * end)).exp();
        let closes = || {
            let met = -(start * start - end * end).expm1();
            [left, met, (left * self.returned).scale(dt)]
        };
        dt.is_positive().either(closes, || [left, S::zero(), S::zero()])
    }

    /// The travel over which the gap closes in a step (X).
    #[inline]
    fn way(&self, interval: &Interval<S::Plain>) -> S {
        let ratio = interval.velocity().abs() / self.reference;
        self.exponent.exp_with_base(ratio).scale(self.reference * interval.dt)
    }
}
