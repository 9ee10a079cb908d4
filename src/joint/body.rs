use crate::sample::Sample;
use crate::scalar::Scalar;

/// What acts on a joint over a step, besides what it is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push<P> {
    /// Motor torque at the joint side (T), held.
    pub motor: P,
    /// External torque (T), held.
    pub external: P,
    /// Where the far end of the joint's spring stands at the start of the step (X).
    pub support: P,
    /// How fast it moves (X/s).
    pub support_velocity: P,
    /// Joint temperature (degC).
    pub temperature: P,
    /// Time at the start of the step (s).
    pub time: P,
}

impl<P: Scalar + PartialOrd> Push<P> {
    /// A motor torque, and nothing else.
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

/// A mechanism over one step, seen from its one coordinate with friction. It can be asked what a
/// piece of the step would be like, and told to go through it.
pub trait Body<P: Scalar + PartialOrd> {
    /// Velocity of the coordinate (X/s).
    fn velocity(&self) -> P;

    /// Inertia that the coordinate feels at once (T s2/X).
    fn inertia(&self) -> P;

    /// Means over a piece of length `h` (s) in which the coordinate moves at `velocity` on average.
    /// Friction must be `motor_torque - load_torque` for that: it falls with the velocity.
    fn sample(&self, velocity: P, h: P) -> Sample<P>;

    /// Goes through such a piece.
    fn advance(&mut self, velocity: P, h: P);

    /// The coordinate has come to rest at the end of the piece before.
    fn rest(&mut self);
}
