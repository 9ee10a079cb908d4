//! Coulomb friction that depends on the direction of power flow (Clochiatti et al. 2024).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// Viscous friction, and smoothed Coulomb friction that depends on the direction of power flow.
    Clochiatti {
        /// Torque per speed.
        viscous_friction: "a1" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Dry friction while the motor drives the joint.
        coulomb_friction_motoring: "a2" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction while the load drives the joint.
        coulomb_friction_generating: "a3" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
    }
}

impl<S: Real> FrictionLaw<S> for Clochiatti<S> {
    const INFO: LawInfo = LawInfo {
        id: "clochiatti",
        title: "Clochiatti",
        source: "Clochiatti et al. 2024; UR5e review 2024/25, table 1",
        formula: "a1 v + A tanh(v/eps), A = a2 for v tm > 0, a3 for v tm < 0, 0 for v tm = 0",
        parameters: Self::TABLE,
        channels: &[Channel::MotorTorque],
        constants: &["smoothing_velocity"],
        pole: None,
        captures: &["coulomb", "viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let flow = v.sign() * sample.motor_torque.sign();
        let (generating, motoring) =
            (self.coulomb_friction_generating, self.coulomb_friction_motoring);
        let amplitude = S::choose(flow.is_negative(), generating, motoring);
        // Without motor torque there is no power flow and, by the formula, no dry friction.
        let sign = (v / constants.smoothing_velocity).tanh() * flow.abs();
        Split {
            smoothed_amplitude: amplitude,
            smoothed_torque: amplitude.scale(sign),
            rate: self.viscous_friction.scale(v),
            ..Split::zero()
        }
    }
}
