//! A power of speed, and a transition from static to Coulomb friction (Zhou et al. 2024).

use super::FrictionLaw;
use super::curves::{saturation, signed_power};
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// A power of speed, and static friction that changes into Coulomb friction with speed.
    Zhou {
        /// Torque per power of speed.
        power_friction: "a1" ["T (s/X)^a2"] 0.0 .. 1000.0, start 0.1, RootDamping, Rate;
        /// Exponent of speed.
        power_exponent: "a2" ["1"] 0.01 .. 5.0, start 1.0 drawn 0.05 .. 3.0, None, Nonlinear;
        /// Dry friction in full sliding.
        coulomb_friction: "a3" ["T"] -1e3 .. 1e3, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Speed at which static friction has fallen to 1/e.
        stribeck_velocity: "a4" ["X/s"]
            1e-4 .. 1e4, start 0.1 drawn 0.002 .. 20.0, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "a5" ["1"] 0.1 .. 500.0, start 2.0 drawn 0.3 .. 4.0, None, Nonlinear;
        /// Dry friction at break-away, Coulomb friction included.
        static_friction: "a6" ["T"] -1e3 .. 1e3, start 0.7 drawn 0.0 .. 10.0, Torque, Dry;
    }
}

impl<S: Real> FrictionLaw<S> for Zhou<S> {
    const INFO: LawInfo = LawInfo {
        id: "zhou",
        title: "Zhou",
        source: "Zhou et al. 2024; UR5e review 2024/25, table 1",
        formula: "(a1 |v|^a2 + a3 (1 - E) + a6 E) sgn v, E = exp(-|v/a4|^a5)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "nonlinear_viscous"],
    };

    /// In the form of the formula, not with a height above Coulomb friction, so that a small static
    /// friction keeps its digits next to a large Coulomb friction.
    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let shape = stribeck_curve(v, self.stribeck_velocity, self.stribeck_exponent);
        Split {
            coulomb: self.coulomb_friction * saturation(shape.argument),
            height: self.static_friction,
            shape,
            rate: self.power_friction * signed_power(v, self.power_exponent),
            ..Split::zero()
        }
    }
}
