//! Warm-up of the amplifier that measures the torque.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// An amplifier of the torque channel whose gain and zero settle exponentially while it warms
    /// up. When it is warm both are right.
    WarmUp {
        /// Relative error of the measured torque at the start of the recording.
        warm_up: "g" ["1"] -0.5 .. 1.0, start 0.0, None, Nonlinear;
        /// Torque that is measured in excess at the start of the recording.
        warm_up_zero: "z" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Duration of the recording in time constants.
        warm_up_rate: "kt" ["1"] 1.0 .. 30.0, start 3.0 drawn 1.0 .. 10.0, None, Nonlinear;
    }
}

impl<S: Real> WarmUp<S> {
    /// The share of the error at the start that is left.
    #[inline]
    fn left(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> S {
        self.warm_up_rate.scale(-(sample.time / constants.duration)).exp()
    }
}

impl<S: Real> FrictionEffect<S> for WarmUp<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "warm_up",
        group: "measurement",
        title: "Warm-up",
        what: "The amplifier of the torque or current sensor warms up, so its gain and its zero \
               settle during the recording.",
        formula: "(1 + g e) (tl + tf + z e) - tl, e = exp(-kt t/duration)",
        needs: "a load torque that is known independently, and the same motions early and late",
        beyond: None,
        channels: &[Channel::Time, Channel::LoadTorque],
        constants: &["duration"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        split.additive += self.warm_up_zero * self.left(sample, constants);
    }

    #[inline]
    fn measured(
        &self,
        friction: S,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) -> S {
        let error = self.warm_up * self.left(sample, constants);
        friction + error * friction.shift(sample.load_torque)
    }
}
