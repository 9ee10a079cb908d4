//! LuGre (Canudas de Wit et al. 1995).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::dynamics::Bristle;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// LuGre: a bristle with a Stribeck curve; `a5` includes Coulomb friction.
    Lugre {
        /// Torque per deflection before sliding.
        bristle_stiffness: "a1" ["T/X"] 0.5 .. 2e6, start 50.0, Stiffness, Nonlinear;
        /// Torque per deflection rate.
        bristle_damping: "a2" ["T s/X"] 0.0 .. 1e3, start 0.0 drawn 0.0 .. 5.0, Damping, Rate;
        /// Torque per speed.
        viscous_friction: "a3" ["T s/X"] -1e3 .. 1e3, start 0.1 drawn 0.0 .. 10.0, Damping, Rate;
        /// Dry friction in full sliding.
        coulomb_friction: "a4" ["T"] 0.0 .. 1e5, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Dry friction at break-away, Coulomb friction included.
        static_friction: "a5" ["T"] 0.0 .. 1e2, start 0.7 drawn 0.0 .. 10.0, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "a6" ["X/s"]
            1e-4 .. 1e4, start 0.1 drawn 0.002 .. 20.0, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "a7" ["1"] 0.5 .. 4.0, start 2.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Lugre<S> {
    const INFO: LawInfo = LawInfo {
        id: "lugre",
        title: "LuGre",
        source: "Canudas de Wit et al. 1995, eqs 4-6; UR5e review 2024/25, table 3",
        formula: "a1 z + a2 dz/dt + a3 v; dz/dt = v - a1 |v|/g z; g = a4 + (a5 - a4) exp(-|v/a6|^a7)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "presliding"],
    };

    #[inline(always)]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            height: self.static_friction - self.coulomb_friction,
            shape: stribeck_curve(sample.velocity, self.stribeck_velocity, self.stribeck_exponent),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }

    #[inline]
    fn bristle(&self, _: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Option<Bristle<S>> {
        Some(Bristle::new(self.bristle_stiffness, self.bristle_damping))
    }
}
