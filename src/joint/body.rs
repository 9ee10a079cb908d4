//! The mechanisms that friction acts on, and the inputs of a step.

use crate::sample::Sample;
use crate::scalar::Scalar;

/// The inputs of a joint over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push<P> {
    /// Motor torque at the joint side (T), constant over the step.
    pub motor: P,
    /// External torque (T), constant over the step.
    pub external: P,
    /// Position of the support at the start of the step (X).
    pub support: P,
    /// Velocity of the support (X/s).
    pub support_velocity: P,
    /// Joint temperature (degC).
    pub temperature: P,
    /// Time at the start of the step (s).
    pub time: P,
}

impl<P: Scalar + PartialOrd> Push<P> {
    /// A motor torque alone.
    #[must_use]
    pub fn by_motor(motor: P) -> Self {
        let zero = P::zero();
        Self {
            motor,
            external: zero,
            support: zero,
            support_velocity: zero,
            temperature: zero,
            time: zero,
        }
    }
}

/// A mechanism over one step, in its one coordinate with friction. `sample` predicts a piece of the
/// step and `advance` performs it.
pub trait Body<P: Scalar + PartialOrd> {
    /// Velocity of the coordinate (X/s).
    fn velocity(&self) -> P;

    /// Inertia for a sudden force at the coordinate (T s2/X).
    fn inertia(&self) -> P;

    /// Means over a piece of length `h` (s) in which the coordinate has the mean velocity
    /// `velocity`. The motion requires the friction `motor_torque - load_torque`, which falls with
    /// the velocity.
    fn sample(&self, velocity: P, h: P) -> Sample<P>;

    /// Advances by such a piece.
    fn advance(&mut self, velocity: P, h: P);

    /// Sets the coordinate to rest, at the end of a piece.
    fn rest(&mut self);
}
