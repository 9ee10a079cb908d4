use super::gravity::Gravity;
use super::rigid::Joint;
use crate::scalar::Scalar;

/// A prismatic joint that a motor moves by a ball screw (Gantry, eq 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallScrew<P> {
    /// Mass that is moved, `M` (kg).
    pub mass: P,
    /// Inertia of motor and screw, `J` (kg m2).
    pub rotor_inertia: P,
    /// Travel a turn, `p` (m).
    pub pitch: P,
    /// Force of gravity along the axis (N).
    pub gravity: P,
}

impl<P: Scalar + PartialOrd> BallScrew<P> {
    /// Angle a travel, `2 pi/p` (rad/m): force at the joint per torque of the motor, too.
    #[must_use]
    pub fn ratio(&self) -> P {
        P::from_f64(core::f64::consts::TAU) / self.pitch
    }

    /// `M_eq = M + J (2 pi/p)^2` (kg).
    #[must_use]
    pub fn equivalent_mass(&self) -> P {
        self.mass + self.rotor_inertia * self.ratio() * self.ratio()
    }

    /// The joint as the force at the nut moves it.
    #[must_use]
    pub fn joint(&self) -> Joint<P> {
        Joint {
            gravity: Gravity { constant: self.gravity, ..Gravity::none() },
            ..Joint::free(self.equivalent_mass())
        }
    }
}
