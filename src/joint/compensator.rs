//! Friction compensation with a model of the friction.

use crate::composed::Composed;
use crate::dynamics::State;
use crate::sample::Sample;
use crate::scalar::Scalar;

/// Compensates a share of friction with a model, whose state is separate from the joint's.
#[derive(Clone, Copy, Debug)]
pub struct Compensator<'a, P: Scalar + PartialOrd> {
    model: &'a Composed<P>,
    factor: P,
    state: State<P>,
}

impl<'a, P: Scalar<Plain = P> + PartialOrd> Compensator<'a, P> {
    /// A compensator of this share of the friction, with a relaxed state.
    #[must_use]
    pub fn new(model: &'a Composed<P>, factor: P) -> Self {
        Self { model, factor, state: State::default() }
    }

    /// The torque to add (T); the velocity of `sample` was held for `dt` (s).
    pub fn torque(&mut self, sample: &Sample<P>, dt: P) -> P {
        self.factor * self.model.step(&mut self.state, sample, dt).torque
    }
}
