//! Torques of all joints for a planned motion: rigid bodies and friction.

use super::dynamics::Robot;
use crate::dynamics::State;
use crate::feedforward::Friction;
use crate::joint::Number;
use crate::sample::Sample;

/// A robot with the friction of every joint, evaluated cycle by cycle: the torques that a planned
/// motion takes.
///
/// The load of each joint is the torque of the rigid bodies in the same cycle. Every call takes the
/// same time. A motion that is not finite makes the torques, and the states of laws that have one,
/// not finite: check it first, or call [`reset`](Self::reset).
///
/// ```
/// use stribeck::law::Coulomb;
/// use stribeck::joint::Vector;
/// use stribeck::robot::{ArmFeedforward, Body, Inertial, Movement, Pose, Robot};
/// use stribeck::{FixedLaw, Sample};
///
/// // 2 kg at 0.5 m from a horizontal axis, hanging along -z at position 0.
/// let pendulum = Robot {
///     bodies: [Body {
///         parent: None,
///         movement: Movement::Revolute,
///         axis: Vector::from([0.0_f32, 1.0, 0.0]),
///         placement: Pose::identity(),
///         inertial: Inertial::from_parameters([2.0, 0.0, 0.0, -1.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0]),
///         rotor: 0.1,
///     }],
///     gravity: [0.0, 0.0, -9.81],
///     coupling: None,
/// };
/// let friction = FixedLaw::new(Coulomb { viscous_friction: 0.5_f32, coulomb_friction: 2.0 });
/// let mut arm = ArmFeedforward::new(pendulum, [friction]);
/// let moving = Sample { acceleration: 1.0, ..Sample::at(1.0) };
/// let [torque] = arm.torque(&[moving], 1e-3);
/// assert!((torque - (0.6 + 2.5)).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ArmFeedforward<F, P: Number, const N: usize> {
    robot: Robot<P, N>,
    friction: [F; N],
    states: [State<P>; N],
}

impl<F: Friction<P>, P: Number, const N: usize> ArmFeedforward<F, P, N> {
    /// A robot whose friction is relaxed.
    #[must_use]
    pub fn new(robot: Robot<P, N>, friction: [F; N]) -> Self {
        Self { robot, friction, states: [State::default(); N] }
    }

    /// The torques (N m or N) at the end of a cycle of `dt` (s): gravity, inertia and friction.
    ///
    /// Each joint has a sample with its position, velocity and acceleration, and the channels that
    /// its law reads. The load torque in it is not read. Where motors are coupled, torques and
    /// friction are those of the motors.
    #[inline]
    pub fn torque(&mut self, planned: &[Sample<P>; N], dt: P) -> [P; N] {
        let mut position = planned.each_ref().map(|sample| sample.position);
        let mut velocity = planned.each_ref().map(|sample| sample.velocity);
        let mut acceleration = planned.each_ref().map(|sample| sample.acceleration);
        let mut torque = self.robot.inverse_dynamics(&position, &velocity, &acceleration);
        if let Some(coupled) = &self.robot.coupling {
            let coupling = coupled.on_slices();
            for moved in [&mut position, &mut velocity, &mut acceleration] {
                let joints = *moved;
                coupling.motors(&joints, moved);
            }
            let at_joints = torque;
            coupling.motor_torque(&at_joints, &mut torque);
        }
        let motion = position.into_iter().zip(velocity).zip(acceleration);
        let joints = self.friction.iter().zip(&mut self.states).zip(planned.iter().zip(motion));
        for (((friction, state), (sample, motion)), torque) in joints.zip(&mut torque) {
            let ((position, velocity), acceleration) = motion;
            let load_torque = *torque;
            let sample = Sample { position, velocity, acceleration, load_torque, ..*sample };
            *torque += friction.torque(state, &sample, dt);
        }
        torque
    }

    /// Relaxes the friction.
    pub fn reset(&mut self) {
        self.states = [State::default(); N];
    }

    /// The rigid bodies.
    #[must_use]
    pub const fn robot(&self) -> &Robot<P, N> {
        &self.robot
    }

    /// The states of the laws.
    #[must_use]
    pub const fn states(&self) -> &[State<P>; N] {
        &self.states
    }
}
