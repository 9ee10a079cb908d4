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
    /// Torque `te` that the environment exerts on the joint (T): minus the gravity and external
    /// part of `tl`, without inertia.
    pub external_torque: S,
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
            external_torque: zero,
        }
    }
}

/// A friction torque taken apart: dry friction times the direction of motion, a rate-dependent
/// part and an additive one.
///
/// The direction is `sgn(v)` in a static law and the bristle's deflection in a dynamic one. Some
/// laws write dry friction with `atan`, `tanh` or a sigmoid instead of the sign. A static model
/// takes that torque as it is; a bristle takes its amplitude and drops the smoothing, or it would
/// leak at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split<S> {
    /// Dry magnitude without the Stribeck part (T).
    pub coulomb: S,
    /// Height of the Stribeck curve above `coulomb` at rest (T).
    pub height: S,
    /// The Stribeck curve `E(v)`: 1 at rest, falling to 0 with speed; 0 where there is none.
    pub shape: S,
    /// Magnitude that dry friction with a smoothed sign tends to (T).
    pub smoothed_amplitude: S,
    /// Dry friction with a smoothed sign, the sign included (T).
    pub smoothed_torque: S,
    /// What vanishes with the velocity and needs no direction, `V(v)` (T).
    pub rate: S,
    /// What does not care about motion (T): never dissipation.
    pub additive: S,
}

impl<S: Real> Split<S> {
    /// No friction at all: what a law fills in.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        let zero = S::zero();
        Self {
            coulomb: zero,
            height: zero,
            shape: zero,
            smoothed_amplitude: zero,
            smoothed_torque: zero,
            rate: zero,
            additive: zero,
        }
    }

    /// The dry magnitude `D` (T).
    #[inline]
    #[must_use]
    pub fn dry(&self) -> S {
        self.coulomb + self.height * self.shape + self.smoothed_amplitude
    }

    /// Multiplies all dry friction.
    #[inline]
    pub fn scale_dry(&mut self, factor: S) {
        self.coulomb *= factor;
        self.height *= factor;
        self.smoothed_amplitude *= factor;
        self.smoothed_torque *= factor;
    }

    /// The torque in steady sliding along `direction`, the sign of the velocity (T).
    #[inline]
    #[must_use]
    pub fn torque(&self, direction: S::Plain) -> S {
        let sharp = (self.coulomb + self.height * self.shape).scale(direction);
        sharp + self.smoothed_torque + self.rate + self.additive
    }
}

/// The Stribeck curve `exp(-|v/vs|^alpha)`: 1 at rest, whatever the Stribeck velocity.
#[inline]
#[must_use]
pub fn stribeck_curve<S: Real>(velocity: S::Plain, stribeck_velocity: S, exponent: S) -> S {
    if velocity.value() == 0.0 {
        return S::one();
    }
    (-stribeck_velocity.divide(velocity).abs().powf(exponent)).exp()
}
