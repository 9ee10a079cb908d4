//! Stribeck curve and a power of speed (Wolf and Iskandar 2018).

use super::FrictionLaw;
use super::curves::signed_power;
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Stribeck curve and a power of speed; `a2` includes Coulomb friction.
    Wolf {
        /// Dry friction in full sliding.
        coulomb_friction: "a1" ["T"] -1e3 .. 1e3, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Dry friction at break-away, Coulomb friction included.
        static_friction: "a2" ["T"] -1e3 .. 1e3, start 0.7 drawn 0.0 .. 10.0, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "a3" ["X/s"]
            1e-4 .. 1e3, start 0.1 drawn 0.002 .. 20.0, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "a4" ["1"] 0.3 .. 4.0, start 2.0, None, Nonlinear;
        /// Torque per power of speed.
        power_friction: "a5" ["T (s/X)^a6"] 0.0 .. 1000.0, start 0.1, RootDamping, Rate;
        /// Exponent of speed.
        power_exponent: "a6" ["1"] 0.01 .. 5.0, start 1.0 drawn 0.05 .. 3.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Wolf<S> {
    const INFO: LawInfo = LawInfo {
        id: "wolf",
        title: "Wolf and Iskandar",
        source: "Wolf and Iskandar 2018; UR5e review 2024/25, table 1",
        formula: "(a1 + (a2 - a1) exp(-|v/a3|^a4)) sgn v + a5 |v|^a6 sgn v",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "nonlinear_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        Split {
            coulomb: self.coulomb_friction,
            height: self.static_friction - self.coulomb_friction,
            shape: stribeck_curve(v, self.stribeck_velocity, self.stribeck_exponent),
            rate: self.power_friction * signed_power(v, self.power_exponent),
            ..Split::zero()
        }
    }
}
