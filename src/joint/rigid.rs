//! A joint with one inertia.

use super::body::{Body, Push};
use super::gravity::{Gravity, GravityAbout};
use crate::sample::Sample;
use crate::scalar::Scalar;

/// A revolute or prismatic joint with one inertia, optionally connected to a moving support by a
/// spring and a damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint<P> {
    /// Inertia or mass, including the motor's (T s2/X).
    pub inertia: P,
    /// Gravity.
    pub gravity: Gravity<P>,
    /// Stiffness between joint and support (T/X).
    pub stiffness: P,
    /// Damping between joint and support (T s/X).
    pub damping: P,
}

/// Position and velocity of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture<P> {
    /// Position (X).
    pub position: P,
    /// Velocity (X/s).
    pub velocity: P,
}

impl<P: Scalar + PartialOrd> Joint<P> {
    /// An inertia without gravity and support.
    #[must_use]
    pub fn free(inertia: P) -> Self {
        let zero = P::zero();
        Self { inertia, gravity: Gravity::none(), stiffness: zero, damping: zero }
    }

    /// A revolute joint with gravity `cos * cos q + sin * sin q` (T).
    #[must_use]
    pub fn revolute(inertia: P, cos: P, sin: P) -> Self {
        Self { gravity: Gravity { cos, sin, ..Gravity::none() }, ..Self::free(inertia) }
    }

    /// Kinetic and potential energy, including the spring (J).
    #[must_use]
    pub fn energy(&self, posture: &Posture<P>, support: P) -> P {
        let half = P::from_f64(0.5);
        let Posture { position, velocity } = *posture;
        let stretch = support - position;
        half * (self.inertia * velocity * velocity + self.stiffness * stretch * stretch)
            + self.gravity.potential(position)
    }

    /// The joint within a step.
    #[must_use]
    pub fn moving<'a>(&'a self, posture: Posture<P>, push: &'a Push<P>) -> Moving<'a, P> {
        let gravity = self.gravity.about(posture.position);
        Moving { joint: self, push, gravity, posture, elapsed: P::zero() }
    }
}

/// A joint within a step.
#[derive(Clone, Copy, Debug)]
pub struct Moving<'a, P> {
    joint: &'a Joint<P>,
    push: &'a Push<P>,
    gravity: GravityAbout<P>,
    /// Position and velocity reached so far.
    pub posture: Posture<P>,
    elapsed: P,
}

impl<P: Scalar + PartialOrd> Moving<'_, P> {
    /// Mean torque of spring and damper over a piece (T).
    fn support_torque(&self, velocity: P, h: P) -> P {
        let middle = self.elapsed + h * P::from_f64(0.5);
        let support = self.push.support + self.push.support_velocity * middle;
        let stretch = support - self.posture.position - velocity * h * P::from_f64(0.5);
        self.joint.stiffness * stretch
            + self.joint.damping * (self.push.support_velocity - velocity)
    }
}

impl<P: Scalar + PartialOrd> Body<P> for Moving<'_, P> {
    fn velocity(&self) -> P {
        self.posture.velocity
    }

    fn inertia(&self) -> P {
        self.joint.inertia
    }

    fn sample(&self, velocity: P, h: P) -> Sample<P> {
        let half = P::from_f64(0.5);
        let way = velocity * h;
        let acceleration = (velocity - self.posture.velocity) / (h * half);
        let external = self.push.external + self.support_torque(velocity, h);
        let gravity = self.gravity.mean(self.posture.position, way);
        Sample {
            velocity,
            position: self.posture.position + way * half,
            acceleration,
            temperature: self.push.temperature,
            load_torque: self.joint.inertia * acceleration + gravity - external,
            load_torque_curvature: P::zero(),
            temperature_rate: P::zero(),
            motor_torque: self.push.motor,
            external_torque: external - gravity,
            time: self.push.time + self.elapsed + h * half,
        }
    }

    fn advance(&mut self, velocity: P, h: P) {
        let Posture { position, velocity: before } = self.posture;
        self.posture =
            Posture { position: position + velocity * h, velocity: velocity + velocity - before };
        self.elapsed += h;
    }

    fn rest(&mut self) {
        self.posture.velocity = P::zero();
    }
}
