//! Delay between torque and motion channels.

use super::FrictionEffect;
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// Torque and motion channels that were not recorded at the same instant. A delay shifts whole
    /// columns, which `batch` does; at one instant it has no influence.
    Delay {
        /// Time by which the torque channel lags the motion channels.
        delay: "tau" ["s"] -6.0 .. 6.0, start 0.0, SamplePeriod, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Delay<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "delay",
        group: "measurement",
        title: "Delay",
        what: "Torque and motion channels are not simultaneous.",
        formula: "tf(t) + (tf + tl)(t - tau) - (tf + tl)(t)",
        needs: "accelerated motion",
        beyond: None,
        channels: &[],
        constants: &[],
        parameters: Self::TABLE,
    };
}
