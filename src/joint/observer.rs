//! A disturbance observer: it estimates an unknown torque from velocities.

use crate::scalar::Scalar;

/// Estimates the unknown torque on a known inertia: `D' = w (tau - J a - D)`, from velocities alone
/// and exact for torques that are constant over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer<P> {
    inertia: P,
    bandwidth: P,
    /// The estimate (T), positive against positive motion.
    pub estimate: P,
}

impl<P: Scalar<Plain = P> + PartialOrd> Observer<P> {
    /// An observer for an inertia (T s2/X), a first-order filter of this bandwidth (1/s).
    #[must_use]
    pub fn new(inertia: P, bandwidth: P) -> Self {
        Self { inertia, bandwidth, estimate: P::zero() }
    }

    /// Updates the estimate after a step of `dt` (s) in which the torque `known` (T) acted and the
    /// velocity changed from `before` to `after`.
    pub fn update(&mut self, known: P, (before, after): (P, P), dt: P) {
        let seen = known - self.inertia * (after - before) / dt;
        let share = -(-(self.bandwidth * dt)).expm1();
        self.estimate += share * (seen - self.estimate);
    }
}
