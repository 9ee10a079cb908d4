use super::FrictionEffect;
use super::factor::temperature_factor;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Dry friction that changes with temperature.
    TemperatureDry {
        /// Relative fall of dry friction per kelvin at the reference temperature.
        temperature_dry_slope: "sd" ["1/K"] -0.1 .. 0.1, start 0.005, None, Nonlinear;
        /// How fast that fall levels off with temperature.
        temperature_dry_curvature: "kd" ["1/K"] -0.1 .. 0.2, start 0.01, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for TemperatureDry<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "temperature_dry",
        group: "friction",
        title: "Temperature of dry friction",
        what: "Preload, seals and boundary lubrication change as the joint warms, so dry friction \
               changes with temperature.",
        formula: "D (1 + sd/kd (exp(-kd (T - T0)) - 1))",
        needs: "a span of temperature",
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
        let factor = temperature_factor(
            self.temperature_dry_slope,
            self.temperature_dry_curvature,
            sample.temperature - constants.reference_temperature,
        );
        split.scale_dry(factor);
    }
}
