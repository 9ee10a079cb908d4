//! Bittencourt's law of Coulomb, Stribeck and viscous friction (Bittencourt et al. 2012).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Coulomb, Stribeck and viscous friction; `a2` is the height above `a1`.
    BittencourtA {
        /// Dry friction in full sliding.
        coulomb_friction: "a1" ["T"] -1e3 .. 1e3, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Height of the Stribeck curve above Coulomb friction at rest.
        stribeck_height: "a2" ["T"] -1e3 .. 1e3, start 0.2 drawn 0.0 .. 10.0, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "a3" ["X/s"]
            1e-4 .. 1e3, start 0.1 drawn 0.002 .. 20.0, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "a4" ["1"] 0.5 .. 4.0, start 2.0, None, Nonlinear;
        /// Torque per speed.
        viscous_friction: "a5" ["T s/X"] -1e3 .. 1e3, start 0.1 drawn 0.0 .. 10.0, Damping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for BittencourtA<S> {
    const INFO: LawInfo = LawInfo {
        id: "bittencourt_a",
        title: "Bittencourt and Gunnarsson (A)",
        source: "Bittencourt et al. 2012; UR5e review 2024/25, table 1",
        formula: "(a1 + a2 exp(-|v/a3|^a4)) sgn v + a5 v",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck"],
    };

    #[inline(always)]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            height: self.stribeck_height,
            shape: stribeck_curve(sample.velocity, self.stribeck_velocity, self.stribeck_exponent),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}
