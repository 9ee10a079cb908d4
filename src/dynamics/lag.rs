//! A quantity that follows its steady value with a first-order lag, stepped exactly.
//!
//! `tau de/dt = E - e`. The deviation `d = e - E` relaxes to 0: over a step at whose beginning `E`
//! has changed by `c`, it becomes `(d - c) exp(-dt/tau)`; where `E` changes linearly, it becomes
//! `d exp(-dt/tau) - c phi_1(-dt/tau)`. Then `e` lies between the values before, so a lag never makes
//! friction negative. Shares and shifts do not depend on `d`, so they are computed for many samples
//! in parallel.

use super::history::{History, Kept};
use super::{Interval, SATURATED};
use crate::scalar::{Mask, Real};

/// A first-order lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag<S> {
    /// Time constant `tau` (s); 0 for no lag.
    pub time: S,
}

impl<S: Real> Lag<S> {
    /// Steps over `interval`, at whose end the steady value is `steady`; the first step begins
    /// there. Where the interval has a mean velocity, the steady value changes linearly within the
    /// step.
    #[inline]
    pub fn step_over(
        &self,
        history: &mut impl History<S>,
        steady: S,
        interval: &Interval<S::Plain>,
    ) -> S {
        let [before, _] = history.follow(Kept::SteadyCurve, steady);
        let [share, late] =
            interval.dt.is_positive().either(|| self.weights(interval), || [S::zero(), S::one()]);
        let shift = -((steady - before) * late);
        let [_, deviation] = history.relax(Kept::CurveDeviation, share, shift);
        steady + deviation
    }

    /// The share of the deviation that is lost in a step, and that of the change that remains.
    #[inline]
    fn weights(&self, interval: &Interval<S::Plain>) -> [S; 2] {
        let dt = interval.dt;
        let linear = interval.mean_velocity.is_some();
        let steps = self.time.scale(S::Plain::one() / dt);
        let forgotten = self.time.plain() * S::Plain::from_f64(SATURATED);
        forgotten.is_above(dt.plain()).either(
            || {
                let y = self.time.reciprocal_times(-dt);
                let share = -y.expm1();
                [share, if linear { share * steps } else { y.exp() }]
            },
            || [S::one(), if linear { steps } else { S::zero() }],
        )
    }
}
