//! Coulomb friction that builds up and static friction that decays with speed (Dong et al. 2021).

use super::FrictionLaw;
use super::curves::saturation;
use crate::constants::Constants;
use crate::sample::{Sample, Split, StribeckCurve};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Viscous friction, Coulomb friction that builds up with speed, static friction that decays.
    Dong {
        /// Torque per speed.
        viscous_friction: "a1" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Dry friction in full sliding.
        coulomb_friction: "a2" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// How fast Coulomb friction builds up with speed.
        coulomb_steepness: "a3" ["s/X"] 0.5 .. 2000.0, start 20.0, InverseSpeed, Nonlinear;
        /// Dry friction at break-away.
        static_friction: "a4" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// How fast static friction decays with speed.
        stribeck_steepness: "a5" ["s/X"] 0.5 .. 2000.0, start 20.0, InverseSpeed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Dong<S> {
    const INFO: LawInfo = LawInfo {
        id: "dong",
        title: "Dong",
        source: "Dong et al. 2021; UR5e review 2024/25, table 1",
        formula: "a1 v + (a2 (1 - exp(-a3 |v|)) + a4 exp(-a5 |v|)) sgn v",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let speed = sample.velocity.abs();
        Split {
            coulomb: self.coulomb_friction * saturation(self.coulomb_steepness.scale(speed)),
            height: self.static_friction,
            shape: StribeckCurve::new(self.stribeck_steepness.scale(speed), S::one()),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}
