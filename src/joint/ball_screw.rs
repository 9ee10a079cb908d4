//! A linear axis with a ball screw (Gantry, eq 3).

use super::gravity::Gravity;
use super::rigid::Joint;
use crate::scalar::Scalar;

/// A prismatic joint that a motor drives through a ball screw (Gantry, eq 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallScrew<P> {
    /// Moving mass `M` (kg).
    pub mass: P,
    /// Inertia of motor and screw, `J` (kg m2).
    pub rotor_inertia: P,
    /// Lead of the screw, `p` (m per turn).
    pub pitch: P,
    /// Force of gravity along the axis (N).
    pub gravity: P,
}

impl<P: Scalar + PartialOrd> BallScrew<P> {
    /// Motor angle per travel, `2 pi/p` (rad/m); also axial force per motor torque.
    #[must_use]
    pub fn ratio(&self) -> P {
        P::from_f64(core::f64::consts::TAU) / self.pitch
    }

    /// `M_eq = M + J (2 pi/p)^2` (kg).
    #[must_use]
    pub fn equivalent_mass(&self) -> P {
        self.mass + self.rotor_inertia * self.ratio() * self.ratio()
    }

    /// The equivalent joint, driven by the force at the nut.
    #[must_use]
    pub fn joint(&self) -> Joint<P> {
        Joint {
            gravity: Gravity { constant: self.gravity, ..Gravity::none() },
            ..Joint::free(self.equivalent_mass())
        }
    }
}
