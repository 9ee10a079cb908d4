//! Friction cancelled: a share of what a model of it says.

use crate::composed::Composed;
use crate::dynamics::State;
use crate::sample::Sample;
use crate::scalar::Scalar;

/// Cancels a share of friction by a model of it, whose state is its own and not the joint's.
#[derive(Clone, Copy, Debug)]
pub struct Compensator<'a, P: Scalar + PartialOrd> {
    model: &'a Composed<P>,
    factor: P,
    state: State<P>,
}

impl<'a, P: Scalar<Plain = P> + PartialOrd> Compensator<'a, P> {
    /// A joint without tension, of which this share of the friction is cancelled.
    #[must_use]
    pub fn new(model: &'a Composed<P>, factor: P) -> Self {
        Self { model, factor, state: State::default() }
    }

    /// The torque to add, sampled: the velocity has been held for `dt` (s).
    pub fn torque(&mut self, sample: &Sample<P>, dt: P) -> P {
        self.factor * self.model.step(&mut self.state, sample, dt).torque
    }
}
