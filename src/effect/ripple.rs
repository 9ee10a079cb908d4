//! Torque ripple: a torque that is periodic in position.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// A torque that is periodic in position, with the same sign in both directions.
    Ripple {
        /// Amplitude along the cosine of the phase.
        ripple_cos: "c1" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Amplitude along the sine of the phase.
        ripple_sin: "s1" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Amplitude along the cosine of twice the phase.
        ripple_second_cos: "c2" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Amplitude along the sine of twice the phase.
        ripple_second_sin: "s2" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Additional periods over the length, relative to the estimated period.
        ripple_detuning: "d" ["1"] -1.0 .. 1.0, start 0.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Ripple<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "ripple",
        group: "actuator",
        title: "Ripple",
        what: "Magnets, poles or gear teeth pull at the joint (cogging, torque ripple), with a \
               torque that repeats with position and does not change sign with the direction.",
        formula: "tf + c1 cos th + s1 sin th + c2 cos 2 th + s2 sin 2 th, \
                  th = 2 pi (x/period + d (x/length - 1/2)), x = q - start",
        needs: "several periods, passed in both directions",
        beyond: None,
        channels: &[Channel::Position],
        constants: &["position_start", "position_length", "ripple_period"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let turn = S::Plain::from_f64(core::f64::consts::TAU);
        let way = sample.position - constants.position_start;
        let from_middle = way / constants.position_length - S::Plain::from_f64(0.5);
        let phase = self
            .ripple_detuning
            .scale(turn * from_middle)
            .shift(turn * way / constants.ripple_period);
        let (sin, cos) = phase.sin_cos();
        let (second_sin, second_cos) = (sin * cos + sin * cos, cos * cos - sin * sin);
        split.additive += self.ripple_cos * cos + self.ripple_sin * sin;
        split.additive += self.ripple_second_cos * second_cos + self.ripple_second_sin * second_sin;
    }
}
