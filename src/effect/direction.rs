//! Friction that depends on the direction of motion.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// Coefficients that differ between the two directions.
    Direction {
        /// Half the difference of dry friction between forward and backward motion.
        direction_coulomb: "dc" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry, WithoutOffset;
        /// Half the difference of viscous friction between forward and backward motion.
        direction_viscous: "dv" ["T s/X"] -10.0 .. 10.0, start 0.0, Damping, Rate;
    }
}

impl<S: Real> FrictionEffect<S> for Direction<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "direction",
        group: "friction",
        title: "Direction",
        what: "Teeth, seals or screw flanks carry load differently in the two directions, so the \
               coefficients differ between them.",
        formula: "D + dc sgn v, V + dv |v|",
        needs: "motion in both directions",
        beyond: None,
        channels: &[],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        split.coulomb.add_scaled(&self.direction_coulomb, sample.velocity.sign());
        split.rate.add_scaled(&self.direction_viscous, sample.velocity.abs());
    }
}
