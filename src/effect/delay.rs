use super::FrictionEffect;
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// Torque and motion that were not recorded at the same instant. It shifts whole columns,
    /// so `batch` carries it out; at one instant it does nothing.
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
