//! A constant torque.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// A constant torque.
    Offset {
        /// Torque that does not depend on the motion.
        offset: "t0" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
    }
}

impl<S: Real> FrictionEffect<S> for Offset<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "offset",
        group: "measurement",
        title: "Offset",
        what: "The torque or current sensor has a zero error, or a constant torque was left out.",
        formula: "tf + t0",
        needs: "motion in both directions",
        beyond: None,
        channels: &[],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, _: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        split.additive += self.offset;
    }
}
