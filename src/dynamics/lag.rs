//! A quantity that follows its steady value late, by a first-order lag stepped exactly.
//!
//! `tau de/dt = E - e`. Over a step that holds `E`, `e` goes to `E + (e - E) exp(-dt/tau)`; where
//! `E` moves evenly from `E0` to `E1` it goes to
//! `E1 + (e - E0) exp(-dt/tau) - (E1 - E0) phi_1(-dt/tau)`. Both lie between what was there before,
//! so a lag never makes friction negative.

use super::{Interval, SATURATED};
use crate::scalar::{Real, Scalar};

/// A first-order lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag<S> {
    /// Time constant `tau` (s): at 0 nothing lags.
    pub time: S,
}

/// Where a quantity that lags stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lagging<S> {
    /// `e`.
    value: S,
    /// `E`, at the end of the step before.
    steady: S,
}

impl<S: Scalar> Lag<S> {
    /// Steps over `interval`, at whose end the steady value is `steady`; without a state there it
    /// begins. A mean velocity means that the motion changes within the step, and the steady value
    /// with it: evenly.
    #[inline]
    pub fn over(
        &self,
        state: &mut Option<Lagging<S>>,
        steady: S,
        interval: &Interval<S::Plain>,
    ) -> S {
        let value = match *state {
            None => steady,
            Some(before) if interval.dt.value() <= 0.0 => before.value,
            Some(before) => {
                let (decay, late) = self.weights(interval);
                steady + (before.value - before.steady) * decay - (steady - before.steady) * late
            }
        };
        *state = Some(Lagging { value, steady });
        value
    }

    /// What is left of the lag before, and of a change over the step.
    #[inline]
    fn weights(&self, interval: &Interval<S::Plain>) -> (S, S) {
        let dt = interval.dt;
        let steps = self.time.scale(S::Plain::one() / dt);
        let (decay, late) = if self.time.value() * SATURATED <= dt.value() {
            (S::zero(), steps)
        } else {
            let y = self.time.divide(-dt);
            (y.exp(), -(y.expm1() * steps))
        };
        (decay, if interval.mean_velocity.is_some() { late } else { decay })
    }
}
