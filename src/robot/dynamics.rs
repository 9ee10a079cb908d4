//! A robot of a size known at compile time.

use super::body::Body;
use super::coupling::Coupled;
use super::derivatives::LinkChange;
use super::state::{LinkState, Tree};
use crate::joint::{MassMatrix, Number};

/// A robot with `N` joints, on the stack.
///
/// ```
/// use stribeck::joint::{Matrix, Vector};
/// use stribeck::robot::{Body, Inertial, Movement, Pose, Robot};
///
/// // A pendulum: 2 kg at 0.5 m from a horizontal axis, hanging along -z at position 0.
/// let pendulum = Robot {
///     bodies: [Body {
///         parent: None,
///         movement: Movement::Revolute,
///         axis: Vector::from([0.0, 1.0, 0.0]),
///         placement: Pose::identity(),
///         inertial: Inertial::from_parameters([2.0, 0.0, 0.0, -1.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0]),
///         rotor: 0.1,
///     }],
///     gravity: [0.0, 0.0, -9.81],
///     coupling: None,
/// };
/// let level = [core::f64::consts::FRAC_PI_2];
/// let [torque] = pendulum.inverse_dynamics(&level, &[3.0], &[0.0]);
/// assert!((torque - 9.81).abs() < 1e-12);
/// assert!((pendulum.mass_matrix(&level)[(0, 0)] - 0.6).abs() < 1e-15);
/// let [falling] = pendulum.forward_dynamics(&level, &[3.0], &[0.0]).unwrap();
/// assert!((falling + 9.81 / 0.6).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Robot<P, const N: usize> {
    /// Links with their joints, parents first.
    pub bodies: [Body<P>; N],
    /// Acceleration of gravity in the frame of the base (m/s2).
    pub gravity: [P; 3],
    /// Motors that turn with several joints; `None`: each turns its own.
    pub coupling: Option<Coupled<P, N>>,
}

impl<P: Number, const N: usize> Robot<P, N> {
    /// The same on slices.
    #[must_use]
    pub fn tree(&self) -> Tree<'_, P> {
        Tree {
            bodies: &self.bodies,
            gravity: self.gravity,
            coupling: self.coupling.as_ref().map(Coupled::on_slices),
        }
    }

    /// Torques (N m or N) of the joints for a motion: recursive Newton-Euler.
    #[must_use]
    pub fn inverse_dynamics(
        &self,
        position: &[P; N],
        velocity: &[P; N],
        acceleration: &[P; N],
    ) -> [P; N] {
        let (mut links, mut torque) = ([LinkState::new(); N], [P::zero(); N]);
        self.tree().inverse_dynamics(position, velocity, acceleration, &mut links, &mut torque);
        torque
    }

    /// Torques (N m or N) that hold the robot against gravity.
    #[must_use]
    pub fn gravity_torque(&self, position: &[P; N]) -> [P; N] {
        let (mut links, mut torque) = ([LinkState::new(); N], [P::zero(); N]);
        self.tree().gravity_torque(position, &mut links, &mut torque);
        torque
    }

    /// The mass matrix with the rotors: composite rigid bodies.
    #[must_use]
    pub fn mass_matrix(&self, position: &[P; N]) -> MassMatrix<P, N> {
        let mut links = [LinkState::new(); N];
        let mut matrix = [[P::zero(); N]; N];
        self.tree().mass_matrix(position, &mut links, matrix.as_flattened_mut());
        MassMatrix::from(matrix)
    }

    /// Derivatives of the torques (N m or N) by the positions and by the velocities: one row a torque,
    /// one column a joint. Those by the accelerations are the mass matrix.
    #[must_use]
    pub fn inverse_dynamics_derivatives(
        &self,
        position: &[P; N],
        velocity: &[P; N],
        acceleration: &[P; N],
    ) -> [MassMatrix<P, N>; 2] {
        let (mut links, mut changes) = ([LinkState::new(); N], [LinkChange::new(); N]);
        let mut made = [[[P::zero(); N]; N]; 2];
        let [by_position, by_velocity] = &mut made;
        self.tree().inverse_dynamics_derivatives(
            position,
            velocity,
            acceleration,
            &mut links,
            &mut changes,
            by_position.as_flattened_mut(),
            by_velocity.as_flattened_mut(),
        );
        made.map(|rows| MassMatrix::from(rows).transpose())
    }

    /// Accelerations of the joints that torques (N m or N) cause, by factors of the mass matrix;
    /// `None` unless it is positive definite.
    #[must_use]
    pub fn forward_dynamics(
        &self,
        position: &[P; N],
        velocity: &[P; N],
        torque: &[P; N],
    ) -> Option<[P; N]> {
        let (mut links, mut found) = ([LinkState::new(); N], [P::zero(); N]);
        let mut matrix = [[P::zero(); N]; N];
        let room = matrix.as_flattened_mut();
        let tree = self.tree();
        tree.forward_dynamics(position, velocity, torque, &mut links, room, &mut found)
            .then_some(found)
    }
}
