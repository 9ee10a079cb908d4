//! The torque that nobody has accounted for, from velocities alone.

use crate::scalar::Scalar;

/// Observes the torque that acts against a known inertia besides what is known to act: `D' = w (tau
/// - J a - D)`, from velocities alone and exact for torques that are held over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer<P> {
    inertia: P,
    bandwidth: P,
    /// What it takes that torque to be (T), against positive motion.
    pub estimate: P,
}

impl<P: Scalar<Plain = P> + PartialOrd> Observer<P> {
    /// Of an inertia (T s2/X), by a first-order filter of this bandwidth (1/s).
    #[must_use]
    pub fn new(inertia: P, bandwidth: P) -> Self {
        Self { inertia, bandwidth, estimate: P::zero() }
    }

    /// Takes in a step of `dt` (s), over which `known` (T) acted and the velocity changed from
    /// `before` to `after`.
    pub fn update(&mut self, known: P, (before, after): (P, P), dt: P) {
        let seen = known - self.inertia * (after - before) / dt;
        let share = -(-(self.bandwidth * dt)).expm1();
        self.estimate += share * (seen - self.estimate);
    }
}
