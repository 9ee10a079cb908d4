//! Coulomb and viscous friction.

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Coulomb and viscous friction.
    Coulomb {
        /// Torque per speed.
        viscous_friction: "a1" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Dry friction, independent of speed.
        coulomb_friction: "a2" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
    }
}

impl<S: Real> FrictionLaw<S> for Coulomb<S> {
    const INFO: LawInfo = LawInfo {
        id: "coulomb",
        title: "Coulomb and viscous",
        source: "UR5e review 2024/25, table 1",
        formula: "a1 v + a2 sgn v",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}
