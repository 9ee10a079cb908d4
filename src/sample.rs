//! The input of a law at one instant, and its torque by parts.

use crate::scalar::{Mask, Real};
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
    /// Time derivative of the temperature (K/s).
    pub temperature_rate: S,
    /// Load torque `tl` (T): all torque at the joint except friction.
    pub load_torque: S,
    /// Second time derivative of the load torque (T/s2); behind a resonance that of the spring's.
    pub load_torque_curvature: S,
    /// Motor torque `tm` (T).
    pub motor_torque: S,
    /// External torque `te` that the environment exerts on the joint (T): minus the gravity and
    /// external part of `tl`, without inertia.
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
            Channel::TemperatureRate => self.temperature_rate,
            Channel::LoadTorque => self.load_torque,
            Channel::LoadTorqueCurvature => self.load_torque_curvature,
            Channel::MotorTorque => self.motor_torque,
            Channel::ExternalTorque => self.external_torque,
            Channel::Time => self.time,
        }
    }
}

impl<S> Sample<S> {
    /// A sample from the value of each channel.
    #[inline]
    #[must_use]
    pub fn of(channel: impl Fn(Channel) -> S) -> Self {
        Self {
            velocity: channel(Channel::Velocity),
            position: channel(Channel::Position),
            acceleration: channel(Channel::Acceleration),
            temperature: channel(Channel::Temperature),
            temperature_rate: channel(Channel::TemperatureRate),
            load_torque: channel(Channel::LoadTorque),
            load_torque_curvature: channel(Channel::LoadTorqueCurvature),
            motor_torque: channel(Channel::MotorTorque),
            external_torque: channel(Channel::ExternalTorque),
            time: channel(Channel::Time),
        }
    }
}

impl<S: Real> Sample<S> {
    /// A sample with this velocity; all other channels are zero.
    #[inline]
    #[must_use]
    pub fn at(velocity: S) -> Self {
        let zero = S::zero();
        Self {
            velocity,
            position: zero,
            acceleration: zero,
            temperature: zero,
            temperature_rate: zero,
            load_torque: zero,
            load_torque_curvature: zero,
            motor_torque: zero,
            external_torque: zero,
            time: zero,
        }
    }

    /// The numbers of the quadrant that velocity and load torque are in; zeros at rest and without
    /// load.
    #[inline(always)]
    #[must_use]
    pub(crate) fn in_quadrant<T, const N: usize>(&self, of: impl Fn(Quadrant) -> [T; N]) -> [T; N]
    where
        T: Real<Plain = S, Mask = S::Mask>,
    {
        let (v, tl) = (self.velocity, self.load_torque);
        let loaded = tl.is_positive();
        let forward = || loaded.either(|| of(Quadrant::First), || of(Quadrant::Fourth));
        let backward = || loaded.either(|| of(Quadrant::Second), || of(Quadrant::Third));
        let moving = || v.is_positive().either(forward, backward);
        v.at_zero().or(tl.at_zero()).either(|| [T::zero(); N], moving)
    }
}

/// A combination of signs of velocity and load torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Quadrant {
    /// Forward against the load: motoring.
    First,
    /// Backward with a positive load: generating.
    Second,
    /// Backward against the load: motoring.
    Third,
    /// Forward with a negative load: generating.
    Fourth,
}

/// A friction torque by parts: dry friction times the direction of motion, a rate-dependent part
/// and an additive part.
///
/// The direction is `sgn(v)` in a static law and the deflection of the bristle in a dynamic one.
/// Some laws use `atan`, `tanh` or a sigmoid in place of the sign. A static model uses that
/// smoothed torque; a bristle uses its amplitude without the smoothing, or dry friction would
/// vanish at rest.
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
    /// Limit of the dry friction with a smoothed sign at high speed (T).
    pub smoothed_amplitude: S,
    /// Dry friction with a smoothed sign, the sign included (T).
    pub smoothed_torque: S,
    /// Friction that vanishes with the velocity, `V(v)`; its sign is included (T).
    pub rate: S,
    /// Torque independent of the motion (T): not dissipative.
    pub additive: S,
}

impl<S: Real> Split<S> {
    /// No friction, as the initial value of a law.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        let zero = S::zero();
        Self {
            coulomb: zero,
            height: zero,
            shape: StribeckCurve::constant(),
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

    /// Dry magnitude that is multiplied by the sign of the velocity (T).
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

/// Below this value a Stribeck curve counts as zero.
const LOWEST: f64 = 1e-30;

/// A Stribeck curve `E = exp(-x)`, `x = |v/vs|^alpha`: 1 at rest, falling to 0 with speed.
///
/// Argument and exponent are kept, so that an effect can change the Stribeck velocity.
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
    /// The curve with this argument.
    #[inline]
    #[must_use]
    pub fn new(argument: S, exponent: S) -> Self {
        Self { value: (-argument).exp(), argument, exponent }
    }

    /// A constant curve, for a law without a Stribeck curve.
    #[inline]
    #[must_use]
    pub fn constant() -> Self {
        Self { value: S::one(), argument: S::zero(), exponent: S::one() }
    }

    /// The curve with another value, as at another speed.
    #[inline]
    #[must_use]
    pub fn with_value(&self, value: S) -> Self {
        let lowest = S::Plain::from_f64(LOWEST);
        let moved = self.argument - (value / self.value).ln();
        let from_value = S::choose(value.is_above(lowest), -value.ln(), self.argument);
        let argument = S::choose(self.value.is_above(lowest), moved, from_value);
        Self { value, argument, exponent: self.exponent }
    }

    /// The curve with the Stribeck velocity multiplied by `factor`; the sign of `factor` has no
    /// influence.
    #[inline]
    #[must_use]
    pub fn with_scaled_velocity(&self, factor: S) -> Self {
        // The reciprocal first: if the power underflows it gives 0, and never inf/inf.
        let scaled = factor.abs().reciprocal_times(S::Plain::one()).powf(self.exponent);
        let argument = self.argument;
        let fixed = argument.at_zero().or(argument.is_finite().not());
        let moved = Self::new(argument * scaled, self.exponent);
        Self {
            value: S::choose(fixed, self.value, moved.value),
            argument: S::choose(fixed, argument, moved.argument),
            exponent: self.exponent,
        }
    }
}

/// The Stribeck curve at `velocity`: 1 at rest, whatever the Stribeck velocity.
#[inline(always)]
#[must_use]
pub(crate) fn stribeck_curve<S: Real>(
    velocity: S::Plain,
    stribeck_velocity: S,
    exponent: S,
) -> StribeckCurve<S> {
    let ratio = stribeck_velocity.reciprocal_times(velocity).abs();
    let argument = velocity.at_zero().either(S::zero, || ratio.powf(exponent));
    StribeckCurve::new(argument, exponent)
}

/// `(2/pi) atan(k v)`: the sign of the velocity, smoothed over `1/k`.
#[inline]
#[must_use]
pub(crate) fn arctangent_sign<S: Real>(velocity: S::Plain, steepness: S) -> S {
    steepness.scale(velocity).atan().scale(S::Plain::from_f64(core::f64::consts::FRAC_2_PI))
}
