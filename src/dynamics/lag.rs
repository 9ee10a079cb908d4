//! A quantity that follows its steady value with a first-order lag, stepped exactly.
//!
//! `tau de/dt = E - e`. Over a step with constant `E`, `e` becomes `E + (e - E) exp(-dt/tau)`;
//! where `E` changes linearly from `E0` to `E1` it becomes
//! `E1 + (e - E0) exp(-dt/tau) - (E1 - E0) phi_1(-dt/tau)`. Both lie between the values before, so
//! a lag never makes friction negative.

use super::{Interval, SATURATED};
use crate::scalar::{Mask, Real};

/// A first-order lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag<S> {
    /// Time constant `tau` (s); 0 for no lag.
    pub time: S,
}

/// State of a lagging quantity.
#[derive(Clone, Copy, Debug)]
pub struct Lagging<S: Real> {
    /// Whether it has a value: it has none before the first step.
    pub(super) begun: S::Mask,
    /// `e`.
    pub(super) value: S,
    /// `E` at the end of the step before.
    pub(super) steady: S,
}

impl<S: Real> Default for Lagging<S> {
    fn default() -> Self {
        Self { begun: S::Mask::of(false), value: S::zero(), steady: S::zero() }
    }
}

impl<S: Real> Lag<S> {
    /// Steps over `interval`, at whose end the steady value is `steady`; the first step begins
    /// there. Where the interval has a mean velocity, the steady value changes linearly within the
    /// step.
    #[inline]
    pub fn step_over(&self, state: &mut Lagging<S>, steady: S, interval: &Interval<S::Plain>) -> S {
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

    /// The weights of the earlier deviation and of the change over the step.
    #[inline]
    fn weights(&self, interval: &Interval<S::Plain>) -> (S, S) {
        let dt = interval.dt;
        let steps = self.time.scale(S::Plain::one() / dt);
        let forgotten = self.time.plain() * S::Plain::from_f64(SATURATED);
        let [decay, late] = forgotten.is_above(dt.plain()).either(
            || {
                let y = self.time.reciprocal_times(-dt);
                [y.exp(), -(y.expm1() * steps)]
            },
            || [S::zero(), steps],
        );
        (decay, if interval.mean_velocity.is_some() { late } else { decay })
    }
}
