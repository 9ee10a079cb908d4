//! What a law sees at one instant, and what it makes of it.

use crate::scalar::Real;

/// One instant. Rotary joints: rad, N m; prismatic joints: m, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<S> {
    /// Velocity `v` (X/s).
    pub velocity: S,
    /// Position `q` (X).
    pub position: S,
    /// Acceleration `a` (X/s2).
    pub acceleration: S,
    /// Joint temperature `T` (degC).
    pub temperature: S,
    /// Load torque `tl` (T): all at the joint that is not friction.
    pub load_torque: S,
    /// Motor torque `tm` (T).
    pub motor_torque: S,
}

impl<S: Real> Sample<S> {
    /// A sample where only the velocity matters; everything else is zero.
    #[inline]
    #[must_use]
    pub fn at(velocity: S) -> Self {
        let zero = S::zero();
        Self {
            velocity,
            position: zero,
            acceleration: zero,
            temperature: zero,
            load_torque: zero,
            motor_torque: zero,
        }
    }
}

/// A friction torque taken apart: `tf = dry * direction + rate + additive`.
///
/// The direction is `sgn(v)` in a static law and the bristle's deflection in a dynamic one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split<S> {
    /// Dry magnitude without the Stribeck part (T).
    pub coulomb: S,
    /// Height of the Stribeck curve above `coulomb` at rest (T).
    pub height: S,
    /// The Stribeck curve `E(v)`: 1 at rest, falling to 0 with speed; 0 where there is none.
    pub shape: S,
    /// What vanishes with the velocity and needs no direction, `V(v)` (T).
    pub rate: S,
    /// What does not care about motion (T): never dissipation.
    pub additive: S,
}

impl<S: Real> Split<S> {
    /// The dry magnitude `D = coulomb + height * shape` (T).
    #[inline]
    #[must_use]
    pub fn dry(&self) -> S {
        self.coulomb + self.height * self.shape
    }

    /// The torque where dry friction acts along `direction` (T).
    #[inline]
    #[must_use]
    pub fn torque(&self, direction: S::Plain) -> S {
        self.dry().scale(direction) + self.rate + self.additive
    }
}

/// The Stribeck curve `exp(-|v/vs|^alpha)`.
#[inline]
#[must_use]
pub fn stribeck_curve<S: Real>(velocity: S::Plain, stribeck_velocity: S, exponent: S) -> S {
    (-stribeck_velocity.divide(velocity).abs().powf(exponent)).exp()
}
