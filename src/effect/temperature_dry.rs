//! Temperature dependence of dry friction.

use super::FrictionEffect;
use super::factor::temperature_factor;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Dry friction that changes with temperature.
    TemperatureDry {
        /// Relative decrease of dry friction per kelvin at the reference temperature.
        temperature_dry_slope: "sd" ["1/K"] -0.1 .. 0.1, start 0.005, None, Nonlinear;
        /// How fast that decrease levels off with temperature.
        temperature_dry_curvature: "kd" ["1/K"] -0.1 .. 0.2, start 0.01, None, Nonlinear;
        /// Relative increase of the Stribeck height per kelvin, beyond that of all dry friction.
        temperature_dry_height: "sh" ["1/K"] -0.2 .. 0.2, start 0.0, None, Nonlinear, WithStribeck;
        /// Relative increase of the Stribeck velocity per kelvin.
        temperature_dry_velocity: "sw" ["1/K"] -0.2 .. 0.2, start 0.0, None, Nonlinear, WithStribeck;
        /// Share of that change that applies to load-dependent friction: 0 none, 1 all.
        temperature_dry_load: "sl" ["1"] 0.0 .. 1.0, start 1.0, None, Nonlinear, WithLoad;
    }
}

impl<S: Real> FrictionEffect<S> for TemperatureDry<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "temperature_dry",
        group: "friction",
        title: "Temperature of dry friction",
        what: "Preload, seals and boundary lubrication change as the joint warms, so dry friction \
               changes with temperature.",
        formula: "D F, F = 1 + sd/kd (exp(-kd (T - T0)) - 1); in D, height (1 + sh (T - T0)), \
                  vs (1 + sw (T - T0)), what load adds (1 - sl + sl F)/F",
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
        let above = sample.temperature - constants.reference_temperature;
        let one = S::Plain::one();
        let factor =
            temperature_factor(self.temperature_dry_slope, self.temperature_dry_curvature, above);
        split.coulomb *= factor;
        split.smoothed_amplitude *= factor;
        split.smoothed_torque *= factor;
        split.load *= (self.temperature_dry_load * factor.shift(-one)).shift(one);
        if !split.height.is_zero() {
            split.height *= factor * self.temperature_dry_height.scale(above).shift(one);
            split.shape = split
                .shape
                .with_scaled_velocity(self.temperature_dry_velocity.scale(above).shift(one));
        }
    }
}
