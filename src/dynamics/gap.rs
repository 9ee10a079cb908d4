//! A gap between two flanks, which opens when the load torque changes its sign and closes with the
//! motion.
//!
//! `w` is the way since the sign changed, `dw = |v|^n vr^(1 - n) dt`, and `g = exp(-(w/b)^2)` says
//! how far the gap is open: that share of the load torque is not carried. What the load has lacked
//! in momentum meanwhile, `P`, is made up for as the flanks meet, `g` falling by the factor `e^-h`
//! in a step: `P (1 - e^-h)/dt` on average over the step.

use super::Interval;
use crate::scalar::{Real, Scalar};

/// A gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap<S: Scalar> {
    /// `b` (X): way in which it closes to 1/e.
    pub width: S,
    /// `n`: 1 where it closes with the way of the motor, 0 where it takes the same time at any
    /// speed.
    pub exponent: S,
    /// Speed `vr` (X/s) at which the exponent plays no role.
    pub reference: S::Plain,
    /// Share of the momentum that is made up for.
    pub returned: S,
}

/// Where the flanks stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flanks<S> {
    /// Load torque at the end of the step before (T).
    load: S,
    /// `w` (X); none before the load torque first changes its sign: the flanks touch.
    way: Option<S>,
    /// `P` (T s).
    momentum: S,
}

impl<S: Scalar> Gap<S> {
    /// What a gap takes from the load torque over `interval` (T).
    #[inline]
    pub fn over(&self, state: &mut Option<Flanks<S>>, interval: &Interval<S::Plain>) -> S {
        let load = S::from_plain(interval.sample.load_torque);
        let zero = S::zero();
        let before = state.unwrap_or(Flanks { load, way: None, momentum: zero });
        let dt = interval.dt;
        let (start, end) = if dt.value() <= 0.0 {
            (before.way, before.way)
        } else if load.value() * before.load.value() < 0.0 {
            // Within the step the load torque changes evenly.
            let after = load / (load - before.load);
            (Some(zero), Some(self.way(interval) * after))
        } else {
            (before.way, before.way.map(|way| way + self.way(interval)))
        };
        // A load torque of 0 has no sign: what it had before counts.
        let signed = if load.value() == 0.0 { before.load } else { load };
        let mut after = Flanks { load: signed, way: end, momentum: before.momentum };
        let mut taken = zero;
        if let (Some(start), Some(end)) = (start, end) {
            let (start, end) = (start / self.width, end / self.width);
            let left = load * (-(end * end)).exp();
            taken = -left;
            if dt.value() > 0.0 {
                let met = (start * start - end * end).expm1();
                let made_up = -(before.momentum * met);
                after.momentum = (left * self.returned).scale(dt) + before.momentum - made_up;
                taken += made_up.scale(S::Plain::one() / dt);
            }
        }
        *state = Some(after);
        taken
    }

    /// How much further the gap closes in a step (X).
    #[inline]
    fn way(&self, interval: &Interval<S::Plain>) -> S {
        let ratio = interval.velocity().abs() / self.reference;
        self.exponent.exponent_of(ratio).scale(self.reference * interval.dt)
    }
}
