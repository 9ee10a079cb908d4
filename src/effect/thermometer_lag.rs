//! Lag of the thermometer.

use super::FrictionEffect;
use crate::sample::Sample;
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// A thermometer on the housing that follows the temperature of the contacts with a first-order
    /// lag. From `tau dT/dt = T_c - T` the temperature of the contacts is `T_c = T + tau dT/dt`. No
    /// influence on friction that does not depend on temperature.
    ThermometerLag {
        /// Time constant with which the thermometer follows the temperature of the contacts.
        thermometer_lag: "tau" ["s"] 0.0 .. 0.5, start 0.02 drawn 0.0 .. 0.2, Duration, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for ThermometerLag<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "thermometer_lag",
        group: "measurement",
        title: "Thermometer lag",
        what: "The thermometer is not at the contacts, and follows their temperature late.",
        formula: "tf(T + tau dT/dt)",
        needs: "friction that changes with temperature, and a temperature that rises or falls at \
                different rates",
        beyond: None,
        channels: &[Channel::Temperature, Channel::TemperatureRate],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline(always)]
    fn put_right(&self, sample: &mut Sample<S::Plain>) {
        sample.temperature += self.thermometer_lag.plain() * sample.temperature_rate;
        // Without a rate, so that a sample which is put right twice stays the same.
        sample.temperature_rate = S::Plain::zero();
    }
}
