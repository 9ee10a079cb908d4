//! Dry friction that grows with the load.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Dry friction that grows with the load.
    Load {
        /// Coulomb friction per load, at the reference load.
        load_coulomb: "lc" ["1"] 0.0 .. 10.0, start 0.05, None, Dry;
        /// Exponent of the load.
        load_exponent: "lp" ["1"] 0.4 .. 2.5, start 1.0, None, Nonlinear;
        /// Height of the Stribeck curve per load, at the reference load.
        load_stribeck: "ls" ["1"] 0.0 .. 10.0, start 0.02, None, Dry, WithStribeck;
        /// Ratio of the Stribeck velocity of that height to the one without load.
        load_stribeck_ratio: "lv" ["1"] 0.1 .. 10.0, start 1.0, None, Nonlinear, WithStribeck;
    }
}

impl<S: Real> FrictionEffect<S> for Load<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "load",
        group: "friction",
        title: "Load",
        what: "The load presses teeth and bearings together, so dry friction grows with its size.",
        formula: "D + (lc + ls exp(-|v/(lv vs)|^alpha)) |tl/tr|^lp tr",
        needs: "load varied independently of speed, motion with and against it",
        beyond: None,
        channels: &[Channel::LoadTorque],
        constants: &["reference_load"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let reference = constants.reference_load;
        let ratio = (sample.load_torque / reference).abs();
        let load = self.load_exponent.exp_with_base(ratio).scale(reference);
        let mut share = self.load_coulomb;
        if !self.load_stribeck.is_zero() {
            share += self.load_stribeck
                * split.shape.with_scaled_velocity(self.load_stribeck_ratio).value;
        }
        split.load += share * load;
    }
}
