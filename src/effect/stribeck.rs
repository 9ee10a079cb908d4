//! The Stribeck effect.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// Dry friction that falls with speed at low speed.
    Stribeck {
        /// Height of the Stribeck curve above Coulomb friction at rest.
        stribeck_height: "dFs" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "alpha" ["1"] 0.5 .. 4.0, start 2.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Stribeck<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "stribeck",
        group: "friction",
        title: "Stribeck effect",
        what: "The surfaces separate as a lubricant film builds up, so dry friction falls with speed \
               at low speed.",
        formula: "D + dFs exp(-|v/vs|^alpha)",
        needs: "slow motion in both directions",
        beyond: None,
        channels: &[],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        split.height += self.stribeck_height;
        split.shape =
            stribeck_curve(sample.velocity, self.stribeck_velocity, self.stribeck_exponent);
    }
}
