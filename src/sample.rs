//! What a law sees at one instant, and what it makes of it.

use crate::scalar::Real;
use crate::table::Channel;

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
    /// Second derivative of the load torque by time (T/s2).
    pub load_torque_curvature: S,
    /// Motor torque `tm` (T).
    pub motor_torque: S,
    /// Torque `te` that the environment exerts on the joint (T): minus the gravity and external
    /// part of `tl`, without inertia.
    pub external_torque: S,
    /// Time since the start of the recording (s).
    pub time: S,
}

impl<S: Copy> Sample<S> {
    /// One of its channels.
    #[inline]
    #[must_use]
    pub fn channel(&self, channel: Channel) -> S {
        match channel {
            Channel::Velocity => self.velocity,
            Channel::Position => self.position,
            Channel::Acceleration => self.acceleration,
            Channel::Temperature => self.temperature,
            Channel::LoadTorque => self.load_torque,
            Channel::LoadTorqueCurvature => self.load_torque_curvature,
            Channel::MotorTorque => self.motor_torque,
            Channel::ExternalTorque => self.external_torque,
            Channel::Time => self.time,
        }
    }
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
            load_torque_curvature: zero,
            motor_torque: zero,
            external_torque: zero,
            time: zero,
        }
    }

    /// The quadrant of velocity and load torque; at rest or without load there is none.
    #[inline]
    #[must_use]
    pub fn quadrant(&self) -> Option<Quadrant> {
        let (v, tl) = (self.velocity.value(), self.load_torque.value());
        match (v > 0.0, tl > 0.0) {
            _ if v == 0.0 || tl == 0.0 => None,
            (true, true) => Some(Quadrant::First),
            (false, true) => Some(Quadrant::Second),
            (false, false) => Some(Quadrant::Third),
            (true, false) => Some(Quadrant::Fourth),
        }
    }
}

/// Which way a joint moves and which way it is loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quadrant {
    /// Forward against the load: motoring.
    First,
    /// Backward with a positive load: generating.
    Second,
    /// Backward against the load: motoring.
    Third,
    /// Forward with a negative load: generating.
    Fourth,
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
    /// The Stribeck curve that `height` multiplies.
    pub shape: StribeckCurve<S>,
    /// Dry magnitude that the load adds (T).
    pub load: S,
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
            shape: StribeckCurve::flat(),
            load: zero,
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
        self.sharp() + self.smoothed_amplitude
    }

    /// Dry magnitude whose direction is the plain sign of the velocity (T).
    #[inline]
    fn sharp(&self) -> S {
        self.coulomb + self.height * self.shape.value + self.load
    }

    /// The torque in steady sliding along `direction`, the sign of the velocity (T).
    #[inline]
    #[must_use]
    pub fn torque(&self, direction: S::Plain) -> S {
        self.sharp().scale(direction) + self.smoothed_torque + self.rate + self.additive
    }
}

/// Below this value a Stribeck curve has come to its end.
const LOWEST: f64 = 1e-30;

/// A Stribeck curve `E = exp(-x)`, `x = |v/vs|^alpha`: 1 at rest, falling to 0 with speed.
///
/// Argument and exponent are kept, so that an effect can move the Stribeck velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StribeckCurve<S> {
    /// `E`.
    pub value: S,
    /// `x`.
    pub argument: S,
    /// `alpha`.
    pub exponent: S,
}

impl<S: Real> StribeckCurve<S> {
    /// The curve with this argument, for a law that has a shorter way to it.
    #[inline]
    #[must_use]
    pub fn of(argument: S, exponent: S) -> Self {
        Self { value: (-argument).exp(), argument, exponent }
    }

    /// What a law without a Stribeck curve has.
    #[inline]
    #[must_use]
    pub fn flat() -> Self {
        Self { value: S::one(), argument: S::zero(), exponent: S::one() }
    }

    /// The curve with another value, as at another speed.
    #[inline]
    #[must_use]
    pub fn displaced(&self, value: S) -> Self {
        let argument = if self.value.value() > LOWEST {
            self.argument - (value / self.value).ln()
        } else if value.value() > LOWEST {
            -value.ln()
        } else {
            self.argument
        };
        Self { value, argument, exponent: self.exponent }
    }

    /// The curve with the Stribeck velocity multiplied by `factor`, whose sign does not matter.
    #[inline]
    #[must_use]
    pub fn widened(&self, factor: S) -> Self {
        let argument = self.argument.value();
        if argument == 0.0 || !argument.is_finite() {
            return *self;
        }
        // The inverse first: a power that underflows is 0, one that overflows leaves inf/inf.
        let narrowed = factor.abs().divide(S::Plain::one()).powf(self.exponent);
        Self::of(self.argument * narrowed, self.exponent)
    }
}

/// The Stribeck curve at `velocity`: 1 at rest, whatever the Stribeck velocity.
#[inline]
#[must_use]
pub fn stribeck_curve<S: Real>(
    velocity: S::Plain,
    stribeck_velocity: S,
    exponent: S,
) -> StribeckCurve<S> {
    let argument = if velocity.value() == 0.0 {
        S::zero()
    } else {
        stribeck_velocity.divide(velocity).abs().powf(exponent)
    };
    StribeckCurve::of(argument, exponent)
}
