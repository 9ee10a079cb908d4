//! A cubic polynomial of speed.

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// A cubic polynomial of speed.
    HaoA {
        /// Dry friction, independent of speed.
        coulomb_friction: "a1" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Torque per speed.
        viscous_friction: "a2" ["T s/X"] 0.0 .. 20.0, start 0.1, Damping, Rate;
        /// Torque per square of speed.
        quadratic_friction: "a3" ["T s2/X2"] -20.0 .. 20.0, start 0.0, SquareDamping, Rate;
        /// Torque per cube of speed.
        cubic_friction: "a4" ["T s3/X3"] 0.0 .. 20.0, start 0.0, CubicDamping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for HaoA<S> {
    const INFO: LawInfo = LawInfo {
        id: "hao_a",
        title: "Hao (A)",
        source: "Hao et al. 2021; UR5e review 2024/25, table 1",
        formula: "a1 sgn v + a2 v + a3 v^2 sgn v + a4 v^3",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "nonlinear_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        Split {
            coulomb: self.coulomb_friction,
            rate: self.viscous_friction.scale(v)
                + self.quadratic_friction.scale(v * v.abs())
                + self.cubic_friction.scale(v * v * v),
            ..Split::zero()
        }
    }
}
