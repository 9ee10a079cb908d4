//! A quantity that follows its steady value late, by a first-order lag stepped exactly.
//!
//! `tau de/dt = E - e`. Over a step that holds `E`, `e` goes to `E + (e - E) exp(-dt/tau)`; where
//! `E` moves evenly from `E0` to `E1` it goes to
//! `E1 + (e - E0) exp(-dt/tau) - (E1 - E0) phi_1(-dt/tau)`. Both lie between what was there before,
//! so a lag never makes friction negative.

use super::{Interval, SATURATED};
use crate::scalar::{Mask, Real};

/// A first-order lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag<S> {
    /// Time constant `tau` (s): at 0 nothing lags.
    pub time: S,
}

/// Where a quantity that lags stands.
#[derive(Clone, Copy, Debug)]
pub struct Lagging<S: Real> {
    /// Whether it has begun: before its first step it stands nowhere.
    pub(super) begun: S::Mask,
    /// `e`.
    pub(super) value: S,
    /// `E`, at the end of the step before.
    pub(super) steady: S,
}

impl<S: Real> Default for Lagging<S> {
    fn default() -> Self {
        Self { begun: S::Mask::of(false), value: S::zero(), steady: S::zero() }
    }
}

impl<S: Real> Lag<S> {
    /// Steps over `interval`, at whose end the steady value is `steady`; the first step begins
    /// there. A mean velocity means that the motion changes within the step, and the steady value
    /// with it: evenly.
    #[inline]
    pub fn over(&self, state: &mut Lagging<S>, steady: S, interval: &Interval<S::Plain>) -> S {
        let before = *state;
        let follows = || {
            let (decay, late) = self.weights(interval);
            steady + (before.value - before.steady) * decay - (steady - before.steady) * late
        };
        let goes_on = || interval.dt.is_positive().either(follows, || before.value);
        let value = before.begun.either(goes_on, || steady);
        *state = Lagging { begun: S::Mask::of(true), value, steady };
        value
    }

    /// What is left of the lag before, and of a change over the step.
    #[inline]
    fn weights(&self, interval: &Interval<S::Plain>) -> (S, S) {
        let dt = interval.dt;
        let steps = self.time.scale(S::Plain::one() / dt);
        let forgotten = self.time.plain() * S::Plain::from_f64(SATURATED);
        let [decay, late] = forgotten.is_above(dt.plain()).either(
            || {
                let y = self.time.divide(-dt);
                [y.exp(), -(y.expm1() * steps)]
            },
            || [S::zero(), steps],
        );
        (decay, if interval.mean_velocity.is_some() { late } else { decay })
    }
}
