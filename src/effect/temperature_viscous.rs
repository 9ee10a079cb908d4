//! Temperature dependence of viscous friction.

use super::FrictionEffect;
use super::factor::temperature_factor;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Viscous friction that falls with temperature.
    TemperatureViscous {
        /// Relative decrease of viscous friction per kelvin at the reference temperature.
        temperature_viscous_slope: "sv" ["1/K"] 0.0 .. 0.3, start 0.01, None, Nonlinear;
        /// How fast that decrease levels off with temperature.
        temperature_viscous_curvature: "kv" ["1/K"] 0.0 .. 0.3, start 0.01, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for TemperatureViscous<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "temperature_viscous",
        group: "friction",
        title: "Temperature of viscous friction",
        what: "The lubricant thins as the joint warms, so viscous friction falls with temperature.",
        formula: "V (1 + sv/kv (exp(-kv (T - T0)) - 1))",
        needs: "a span of temperature",
        beyond: None,
        channels: &[Channel::Temperature],
        constants: &["reference_temperature"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        split.rate *= temperature_factor(
            self.temperature_viscous_slope,
            self.temperature_viscous_curvature,
            sample.temperature - constants.reference_temperature,
        );
    }
}
