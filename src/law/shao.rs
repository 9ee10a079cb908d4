//! Coulomb friction with a smoothed sign (Shao et al. 2023).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split, arctangent_sign};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Coulomb friction with a smoothed sign, and viscous friction.
    Shao {
        /// Torque per speed.
        viscous_friction: "a1" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Dry friction in full sliding.
        coulomb_friction: "a2" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// How fast dry friction rises from rest.
        sign_steepness: "a3" ["s/X"] 0.5 .. 1e5, start 100.0, InverseSpeed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Shao<S> {
    const INFO: LawInfo = LawInfo {
        id: "shao",
        title: "Shao",
        source: "Shao et al. 2023; UR5e review 2024/25, table 1",
        formula: "a1 v + (2 a2/pi) atan(a3 v)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let sign = arctangent_sign(sample.velocity, self.sign_steepness);
        Split {
            smoothed_amplitude: self.coulomb_friction,
            smoothed_torque: self.coulomb_friction * sign,
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}
