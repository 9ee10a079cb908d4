//! Stribeck curve and Coulomb friction as hyperbolic tangents (Makkar et al. 2005).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Hyperbolic tangents: a Stribeck curve as the difference of two, Coulomb friction; and
    /// viscous friction.
    Makkar {
        /// Torque of the Stribeck curve between its rise and its fall.
        stribeck_height: "a1" ["T"] -10.0 .. 10.0, start 0.2, Torque, Dry;
        /// How fast the Stribeck curve rises from rest.
        stribeck_rise: "a2" ["s/X"] 0.2 .. 1e5, start 100.0, InverseSpeed, Nonlinear;
        /// How fast the Stribeck curve falls again.
        stribeck_fall: "a3" ["s/X"]
            -1e3 .. 1e3, start 10.0 drawn -30.0 .. 30.0, InverseSpeed, Nonlinear;
        /// Dry friction in full sliding.
        coulomb_friction: "a4" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// How fast Coulomb friction rises from rest.
        sign_steepness: "a5" ["s/X"] 0.5 .. 1e6, start 100.0, InverseSpeed, Nonlinear;
        /// Torque per speed.
        viscous_friction: "a6" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for Makkar<S> {
    const INFO: LawInfo = LawInfo {
        id: "makkar",
        title: "Makkar",
        source: "Makkar et al. 2005; UR5e review 2024/25, table 1",
        formula: "a1 (tanh(a2 v) - tanh(a3 v)) + a4 tanh(a5 v) + a6 v",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck"],
    };

    /// The smoothed signs are `tanh(a2 v)` and `tanh(a5 v)`; `tanh(a3 v)` is the fall of the
    /// Stribeck curve and stays in the magnitude.
    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let rise = self.stribeck_rise.scale(v).tanh();
        let fall = self.stribeck_fall.scale(v).tanh();
        let sign = self.sign_steepness.scale(v).tanh();
        let left = S::one() - fall.along(v);
        Split {
            smoothed_amplitude: self.coulomb_friction + self.stribeck_height * left,
            smoothed_torque: self.stribeck_height * (rise - fall) + self.coulomb_friction * sign,
            rate: self.viscous_friction.scale(v),
            ..Split::zero()
        }
    }
}
