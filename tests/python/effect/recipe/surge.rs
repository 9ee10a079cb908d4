//! Dry friction that grows with the size of the acceleration.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Dry friction that grows with the size of the acceleration.
    Surge {
        /// Dry friction per acceleration.
        surge: "k" ["T s2/X"] 0.0 .. 10.0, start 0.05, Inertia, Dry;
    }
}

impl<S: Real> FrictionEffect<S> for Surge<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "surge",
        group: "friction",
        title: "Surge",
        what: "Dry friction grows with the size of the acceleration.",
        formula: "D + k |a|",
        needs: "accelerated motion",
        beyond: None,
        channels: &[Channel::Acceleration],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        split.load.add_scaled(&self.surge, sample.acceleration.abs());
    }
}
