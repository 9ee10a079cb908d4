//! Inertia missing from the load torque.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Inertia that the load torque does not include.
    Inertia {
        /// Torque per acceleration.
        inertia: "J" ["T s2/X"] -10.0 .. 10.0, start 0.0, Inertia, Additive;
    }
}

impl<S: Real> FrictionEffect<S> for Inertia<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "inertia",
        group: "rigid body",
        title: "Inertia",
        what: "The inertia used for the load torque has an error, or none was used.",
        formula: "tf + J a",
        needs: "acceleration",
        beyond: None,
        channels: &[Channel::Acceleration],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        split.additive.add_scaled(&self.inertia, sample.acceleration);
    }
}
