//! Gain error of the torque channel.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::Sample;
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// A torque channel with a gain error, which applies to the whole torque, load included.
    Gain {
        /// Relative error of the measured torque.
        gain: "g" ["1"] -0.5 .. 1.0, start 0.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Gain<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "gain",
        group: "measurement",
        title: "Gain",
        what: "The torque constant or gear ratio by which torque was computed has an error, which \
               grows with the motor torque.",
        formula: "(1 + g) (tl + tf) - tl",
        needs: "a load torque that is known independently, and varies",
        beyond: None,
        channels: &[Channel::LoadTorque],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn measured(&self, friction: S, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> S {
        friction + self.gain * friction.shift(sample.load_torque)
    }
}
