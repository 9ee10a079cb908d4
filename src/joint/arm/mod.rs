//! A planar arm with two joints in a horizontal plane (Indri et al., eq 4), with friction in both.
//!
//! The second angle is relative to the first link. With the coupling `h(q2)`,
//! `M = [[a + d + 2h, d + h], [d + h, d]]`. Over a step with mean velocities `w`, momentum changes
//! by `M+ v+ - M v`, and the second joint is loaded by the mean of `dT/dq2`,
//! `v+' N v dh/(2 dq2)` with `dM = N dh`: then kinetic energy changes exactly by the work of motors
//! and friction.

mod step;

use step::ArmStep;

use super::algebra::{MassMatrix, Number, Vector};
use super::coupling::JointStep;
use super::gravity::{Gravity, GravityAbout};
use crate::composed::Composed;
use crate::dynamics::State;

/// The inertial parameters of eq 12.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarArm<P> {
    /// `Gamma_1z + m2 l1^2`, link 1 with link 2 at its end (kg m2).
    pub inertia_1: P,
    /// `Gamma_2z`, link 2 about its joint (kg m2).
    pub inertia_2: P,
    /// `l1 m2 s_2x`, first moment of link 2 along it, times the length of link 1 (kg m2).
    pub moment_x: P,
    /// `l1 m2 s_2y`, the same across it (kg m2).
    pub moment_y: P,
}

/// Positions and velocities of both joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPosture<P> {
    /// Angles (rad).
    pub position: [P; 2],
    /// Velocities (rad/s).
    pub velocity: [P; 2],
}

/// The inputs of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPush<P> {
    /// Motor torques (N m), constant over the step.
    pub motor: [P; 2],
    /// Joint temperatures (degC).
    pub temperature: [P; 2],
    /// Time at the start of the step (s).
    pub time: P,
}

/// The start of a piece of a step.
#[derive(Clone, Copy)]
struct Beginning<P> {
    position: Vector<P, 2>,
    velocity: Vector<P, 2>,
    /// `h` there, and its slope as a function of the angle from there.
    coupling: P,
    slope: GravityAbout<P>,
    momentum: Vector<P, 2>,
}

impl<P: Number> PlanarArm<P> {
    /// `h` has the form of the potential of gravity, its slope that of its torque.
    fn coupling(&self) -> Gravity<P> {
        Gravity { constant: P::zero(), cos: -self.moment_y, sin: -self.moment_x }
    }

    /// `M11`, `M12` and `M22` at the second angle (kg m2).
    #[must_use]
    pub fn inertia(&self, second: P) -> [P; 3] {
        let mass = self.mass_matrix(self.coupling().potential(second));
        [mass.m11, mass.m12, mass.m22]
    }

    fn mass_matrix(&self, coupling: P) -> MassMatrix<P, 2> {
        let across = self.inertia_2 + coupling;
        MassMatrix::from([[self.inertia_1 + across + coupling, across], [across, self.inertia_2]])
    }

    /// Kinetic energy (J).
    #[must_use]
    pub fn energy(&self, posture: &ArmPosture<P>) -> P {
        let coupling = self.coupling().potential(posture.position[1]);
        let velocity = posture.velocity.into();
        P::from_f64(0.5) * P::dot(&self.momentum(coupling, &velocity), &velocity)
    }

    /// Forward dynamics: the accelerations (rad/s2) that these torques (N m) cause, those of friction
    /// subtracted; `None` unless the mass matrix is positive definite.
    ///
    /// ```
    /// use stribeck::joint::{ArmPosture, PlanarArm};
    ///
    /// let arm = PlanarArm { inertia_1: 3.0, inertia_2: 0.5, moment_x: 0.5, moment_y: 0.0 };
    /// let stretched = ArmPosture { position: [0.0, 0.0], velocity: [0.0, 0.0] };
    /// // M = [[4.5, 1], [1, 0.5]]
    /// let [first, second] = arm.acceleration(&stretched, [2.5, 1.0]).unwrap();
    /// assert!((first - 0.2_f64).abs() < 1e-15 && (second - 1.6).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn acceleration(&self, posture: &ArmPosture<P>, torque: [P; 2]) -> Option<[P; 2]> {
        let ([_, second], [v1, v2]) = (posture.position, posture.velocity);
        let coupling = self.coupling();
        let slope = coupling.mean(second, P::zero());
        // Coriolis and centrifugal torques, dM/dt v - dT/dq.
        let turning = Vector::from([(v1 + v1 + v2) * v2, -(v1 * v1)]) * slope;
        let mass = self.mass_matrix(coupling.potential(second));
        P::solve_definite(&mass, &(Vector::from(torque) - turning)).map(Into::into)
    }

    fn momentum(&self, coupling: P, velocity: &Vector<P, 2>) -> Vector<P, 2> {
        P::product(&self.mass_matrix(coupling), velocity)
    }

    fn beginning(&self, position: Vector<P, 2>, velocity: Vector<P, 2>) -> Beginning<P> {
        let coupling = self.coupling().potential(position.y);
        let momentum = self.momentum(coupling, &velocity);
        Beginning {
            position,
            velocity,
            coupling,
            slope: self.coupling().about(position.y),
            momentum,
        }
    }

    /// Mean torques that the motion over a piece of length `h` requires, at these mean velocities
    /// (N m).
    fn load(&self, from: &Beginning<P>, mean: &Vector<P, 2>, h: P) -> Vector<P, 2> {
        let (u, v) = (from.after(mean), from.velocity);
        let way = mean.y * h;
        let slope = from.slope.mean(from.position.y, way);
        let end = self.momentum(from.coupling + slope * way, &u);
        let turning = (u.x * v.x + u.x * v.x + u.x * v.y + u.y * v.x) * slope * P::from_f64(0.5);
        (end - from.momentum) / h - Vector::from([P::zero(), turning])
    }

    /// Advances the arm by `dt` (s) with the friction of both joints, and their states.
    pub fn step(
        &self,
        friction: [&Composed<P>; 2],
        states: &mut [State<P>; 2],
        posture: &mut ArmPosture<P>,
        push: &ArmPush<P>,
        dt: P,
    ) -> [JointStep<P>; 2] {
        let from = self.beginning(posture.position.into(), posture.velocity.into());
        let mut step = ArmStep { arm: self, friction, states, from, push, elapsed: P::zero() };
        let (result, [position, velocity]) = step.over(dt);
        *posture = ArmPosture { position: position.into(), velocity: velocity.into() };
        result
    }
}

impl<P: Number> Beginning<P> {
    /// Velocities at the end of a piece with these mean velocities (rad/s).
    fn after(&self, mean: &Vector<P, 2>) -> Vector<P, 2> {
        mean + mean - self.velocity
    }
}
