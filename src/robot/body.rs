//! A link with the joint that moves it.

use super::pose::{Pose, about, product, zero};
use crate::joint::{Matrix, Number, Vector};

/// What a joint does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Movement {
    /// It turns about its axis (rad).
    Revolute,
    /// It slides along its axis (m).
    Prismatic,
}

/// The ten inertial parameters of a link, in its frame. Torques are linear in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial<P> {
    /// Mass (kg).
    pub mass: P,
    /// Mass times the position of the centre of mass (kg m).
    pub moment: Vector<P, 3>,
    /// Inertia about the origin of the frame: xx, xy, yy, xz, yz, zz (kg m2).
    pub inertia: [P; 6],
}

/// Inertial parameters of a link, and the rotor inertia of its drive.
pub const PARAMETERS: usize = 11;

impl<P: Number> Inertial<P> {
    /// From mass, first moment and inertia in the order of the regressor's columns.
    #[must_use]
    pub fn from_parameters(values: [P; 10]) -> Self {
        let [mass, x, y, z, xx, xy, yy, xz, yz, zz] = values;
        Self { mass, moment: Vector::from([x, y, z]), inertia: [xx, xy, yy, xz, yz, zz] }
    }

    /// The inertia as a matrix.
    #[must_use]
    pub(super) fn matrix(&self) -> Matrix<P, 3, 3> {
        let [xx, xy, yy, xz, yz, zz] = self.inertia;
        Matrix::from([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    }
}

/// A link with the joint that moves it.
///
/// The joint turns or slides about the axis in the frame `placement`, which is fixed to the parent;
/// the frame of the link is that frame, moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<P> {
    /// Index of the link that carries it, smaller than its own; `None`: the base.
    pub parent: Option<usize>,
    /// What the joint does.
    pub movement: Movement,
    /// Unit vector along the axis of the joint, in the frame of the link.
    pub axis: Vector<P, 3>,
    /// The frame of the link at position 0, in the frame of the parent.
    pub placement: Pose<P>,
    /// Inertial parameters of the link.
    pub inertial: Inertial<P>,
    /// Inertia of the rotor through the gear, seen by its motor's coordinate (kg m2 or kg): that of
    /// the joint, unless motors are coupled.
    pub rotor: P,
}

/// A velocity, or a joint's axis: angular, and linear of the frame's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twist<P> {
    pub angular: Vector<P, 3>,
    pub linear: Vector<P, 3>,
}

/// Torque about the frame's origin, and force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wrench<P> {
    pub torque: Vector<P, 3>,
    pub force: Vector<P, 3>,
}

impl<P: Number> Twist<P> {
    pub(super) fn zero() -> Self {
        Self { angular: zero(), linear: zero() }
    }

    /// The motion of a frame that is fixed to this one at a pose.
    #[inline]
    pub(super) fn at(&self, pose: &Pose<P>) -> Self {
        let linear = self.linear + self.angular.cross(&pose.translation);
        Self { angular: pose.turned_back(&self.angular), linear: pose.turned_back(&linear) }
    }
}

impl<P: Number> Wrench<P> {
    /// The wrench on the outer frame of a wrench on a frame with this pose in it.
    #[inline]
    pub(super) fn carried(&self, pose: &Pose<P>) -> Self {
        let force = pose.turned(&self.force);
        let torque = pose.turned(&self.torque) + pose.translation.cross(&force);
        Self { torque, force }
    }

    #[inline]
    pub(super) fn add(&mut self, other: &Self) {
        self.torque += other.torque;
        self.force += other.force;
    }
}

impl<P: Number> Body<P> {
    /// The frame of the link at a position of its joint, in the frame of the parent.
    #[inline]
    #[must_use]
    pub fn pose(&self, position: P) -> Pose<P> {
        let Pose { rotation, translation } = self.placement;
        match self.movement {
            Movement::Revolute => {
                let turned = about(&self.axis, position);
                Pose { rotation: product(&rotation, &turned), translation }
            }
            Movement::Prismatic => {
                let slid = self.placement.turned(&(self.axis * position));
                Pose { rotation, translation: translation + slid }
            }
        }
    }

    /// The motion of the link per unit of its joint's velocity.
    #[inline]
    pub(super) fn twist(&self) -> Twist<P> {
        match self.movement {
            Movement::Revolute => Twist { angular: self.axis, linear: zero() },
            Movement::Prismatic => Twist { angular: zero(), linear: self.axis },
        }
    }

    /// The joint's torque or force that a wrench on the link asks for.
    #[inline]
    pub(super) fn torque(&self, wrench: &Wrench<P>) -> P {
        match self.movement {
            Movement::Revolute => P::dot(&self.axis, &wrench.torque),
            Movement::Prismatic => P::dot(&self.axis, &wrench.force),
        }
    }
}
