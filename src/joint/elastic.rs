//! A motor that drives its load through a spring with backlash.
//!
//! Friction acts at the motor. The twist is `d = theta - q`, and `e` is the part of it beyond the
//! backlash on either side: `U(e) = k e^2/2`. Over a step the mean torque is
//! `(U(e+) - U(e))/(d+ - d)`, and the damper's `c (e+ - e)/h (e+ - e)/(d+ - d)`: the first
//! conserves energy exactly, the second only dissipates. The load follows from a scalar equation
//! inside that of the motor.

use super::body::{Body, Push};
use super::rigid::{Joint, Moving, Posture};
use super::root::Equation;
use crate::sample::Sample;
use crate::scalar::Scalar;

/// A spring and a damper in series with backlash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmission<P> {
    /// Stiffness `k` (T/X).
    pub stiffness: P,
    /// Damping `c` while the flanks touch (T s/X).
    pub damping: P,
    /// Backlash, from one flank to the other (X).
    pub backlash: P,
}

impl<P: Scalar + PartialOrd> Transmission<P> {
    /// The part of a twist that stretches the spring.
    fn stretch(&self, twist: P) -> P {
        let side = self.backlash * P::from_f64(0.5);
        if twist > side {
            twist - side
        } else if twist < -side {
            twist + side
        } else {
            P::zero()
        }
    }

    /// Mean torque on the load as the twist changes by `change` within `h` (T).
    #[must_use]
    pub fn mean(&self, twist: P, change: P, h: P) -> P {
        let (before, after) = (self.stretch(twist), self.stretch(twist + change));
        let (taken_up, play) = (after - before, self.backlash.is_zero());
        let share = if play || before.sign() * after.sign() > P::zero() {
            P::one()
        } else if change.is_zero() {
            P::zero()
        } else {
            taken_up / change
        };
        let mean = (before + after) * P::from_f64(0.5);
        (self.stiffness * mean + self.damping * taken_up / h) * share
    }

    /// Energy in the spring (J).
    #[must_use]
    pub fn potential(&self, twist: P) -> P {
        let stretch = self.stretch(twist);
        P::from_f64(0.5) * self.stiffness * stretch * stretch
    }
}

/// A motor and a load with a transmission between them; motor quantities at the joint side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticJoint<P> {
    /// Inertia of the motor (T s2/X).
    pub motor_inertia: P,
    /// The transmission between motor and load.
    pub transmission: Transmission<P>,
    /// The load, without the motor.
    pub load: Joint<P>,
}

/// Positions and velocities of motor and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticPosture<P> {
    /// The motor.
    pub motor: Posture<P>,
    /// The load.
    pub load: Posture<P>,
    /// Position of the motor minus that of the load (X), integrated separately: with a stiff spring
    /// the rounding error of the difference would matter.
    pub twist: P,
}

impl<P: Scalar + PartialOrd> ElasticPosture<P> {
    /// Motor and load with the same position and velocity.
    #[must_use]
    pub fn aligned(posture: Posture<P>) -> Self {
        Self { motor: posture, load: posture, twist: P::zero() }
    }
}

impl<P: Scalar + PartialOrd> ElasticJoint<P> {
    /// Kinetic and potential energy, including the springs (J).
    #[must_use]
    pub fn energy(&self, posture: &ElasticPosture<P>, support: P) -> P {
        let speed = posture.motor.velocity;
        P::from_f64(0.5) * self.motor_inertia * speed * speed
            + self.transmission.potential(posture.twist)
            + self.load.energy(&posture.load, support)
    }

    /// The joint within a step; external inputs act on the load.
    #[must_use]
    pub fn moving<'a>(
        &'a self,
        posture: ElasticPosture<P>,
        push: &'a Push<P>,
    ) -> MovingElastic<'a, P> {
        let ElasticPosture { motor, load, twist } = posture;
        MovingElastic { joint: self, push, motor, load: self.load.moving(load, push), twist }
    }
}

/// Motor and load within a step.
#[derive(Clone, Copy, Debug)]
pub struct MovingElastic<'a, P> {
    joint: &'a ElasticJoint<P>,
    push: &'a Push<P>,
    motor: Posture<P>,
    load: Moving<'a, P>,
    twist: P,
}

impl<P: Scalar + PartialOrd> MovingElastic<'_, P> {
    /// Positions and velocities reached so far.
    #[must_use]
    pub fn posture(&self) -> ElasticPosture<P> {
        ElasticPosture { motor: self.motor, load: self.load.posture, twist: self.twist }
    }

    /// Mean torque of the transmission at these mean velocities (T).
    fn transmission_torque(&self, motor: P, load: P, h: P) -> P {
        self.joint.transmission.mean(self.twist, (motor - load) * h, h)
    }

    /// Mean velocity of the load for a mean velocity of the motor.
    fn load_velocity(&self, motor: P, h: P) -> P {
        let start = self.load.velocity();
        let slope = self.load.inertia() / (h * P::from_f64(0.5));
        let (pull, sample) =
            (self.transmission_torque(motor, start, h), self.load.sample(start, h));
        let value = sample.load_torque - pull;
        let size = pull.abs() + sample.external_torque.abs() + slope * start.abs();
        Equation { start, value, slope, size }.solve(|velocity| {
            self.load.sample(velocity, h).load_torque - self.transmission_torque(motor, velocity, h)
        })
    }
}

impl<P: Scalar + PartialOrd> Body<P> for MovingElastic<'_, P> {
    fn velocity(&self) -> P {
        self.motor.velocity
    }

    fn inertia(&self) -> P {
        self.joint.motor_inertia
    }

    fn sample(&self, velocity: P, h: P) -> Sample<P> {
        let half = P::from_f64(0.5);
        let acceleration = (velocity - self.motor.velocity) / (h * half);
        let load = self.load.sample(self.load_velocity(velocity, h), h);
        let pull = self.transmission_torque(velocity, load.velocity, h);
        Sample {
            velocity,
            position: self.motor.position + velocity * h * half,
            acceleration,
            temperature: self.push.temperature,
            load_torque: self.joint.motor_inertia * acceleration + pull,
            load_torque_curvature: P::zero(),
            temperature_rate: P::zero(),
            motor_torque: self.push.motor,
            external_torque: -pull,
            time: load.time,
        }
    }

    fn advance(&mut self, velocity: P, h: P) {
        let load = self.load_velocity(velocity, h);
        self.twist += (velocity - load) * h;
        self.load.advance(load, h);
        let Posture { position, velocity: before } = self.motor;
        self.motor =
            Posture { position: position + velocity * h, velocity: velocity + velocity - before };
    }

    fn rest(&mut self) {
        self.motor.velocity = P::zero();
    }
}
