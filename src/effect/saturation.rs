//! Saturation of the motor.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::Sample;
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

/// Ratio to the reference torque above which the excess no longer grows: far outside any motor, and
/// the power cannot overflow.
const LARGEST_RATIO: f64 = 1e6;

parameters! {
    /// A torque constant that falls as the current grows.
    Saturation {
        /// Relative excess of the measured torque over the real one, at the reference torque.
        saturation: "s" ["1"] 0.0 .. 1.0, start 0.05, None, Nonlinear;
        /// Exponent with which that excess grows.
        saturation_exponent: "sp" ["1"] 1.0 .. 8.0, start 2.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Saturation<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "saturation",
        group: "actuator",
        title: "Saturation",
        what: "Iron saturates and magnets weaken at high current, so the motor delivers less torque \
               than the nominal torque constant predicts.",
        formula: "h(tl + tf) - tl, h(x) = x (1 + s |x/xr|^sp)",
        needs: "high torque, and a load torque that is known independently",
        beyond: None,
        channels: &[Channel::LoadTorque],
        constants: &["reference_torque"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn measured(
        &self,
        friction: S,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) -> S {
        let total = friction.shift(sample.load_torque);
        let ratio = total.abs().scale(S::Plain::one() / constants.reference_torque);
        let largest = S::Plain::from_f64(LARGEST_RATIO);
        let bounded = ratio.choose_below(largest, ratio, S::from_plain(largest));
        let excess = self.saturation * bounded.powf(self.saturation_exponent) * total;
        friction + S::choose(ratio.at_zero(), S::zero(), excess)
    }
}
