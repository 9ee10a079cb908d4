//! Gravity missing from the load torque.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Gravity that the load torque does not include.
    Gravity {
        /// Gravity torque at zero angle.
        gravity_cos: "gc" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Gravity torque at a right angle.
        gravity_sin: "gs" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
    }
}

impl<S: Real> FrictionEffect<S> for Gravity<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "gravity",
        group: "rigid body",
        title: "Gravity",
        what: "The mass, centre of mass or zero angle used for the load torque has an error.",
        formula: "tf + gc cos q + gs sin q",
        needs: "a range of position",
        beyond: None,
        channels: &[Channel::Position],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        let (sin, cos) = sample.position.sin_cos();
        split.additive.add_scaled(&self.gravity_cos, cos);
        split.additive.add_scaled(&self.gravity_sin, sin);
    }
}
