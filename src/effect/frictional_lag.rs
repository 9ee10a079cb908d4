//! Frictional lag (Hess and Soom 1990).

use super::FrictionEffect;
use crate::constants::Constants;
use crate::dynamics::{History, Interval, Lag};
use crate::sample::Split;
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// A Stribeck curve that lags the speed (Hess and Soom 1990), with a first-order lag
    /// (Armstrong-Helouvry, Dupont and Canudas de Wit 1994). No influence at constant speed.
    FrictionalLag {
        /// Time constant with which the Stribeck curve follows the speed.
        frictional_lag: "tau" ["s"] 0.0 .. 2.0, start 0.05, Time, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for FrictionalLag<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "frictional_lag",
        group: "friction",
        title: "Frictional lag",
        what: "A lubricant film takes time to build up and to break down, so the Stribeck curve \
               lags the speed.",
        formula: "D + dFs e; tau de/dt = exp(-|v/vs|^alpha) - e",
        needs: "slow motion that speeds up and slows down at different rates",
        beyond: Some("stribeck"),
        channels: &[],
        constants: &[],
        parameters: Self::TABLE,
    };

    const HAS_STATE: bool = true;

    #[inline]
    fn apply_over(
        &self,
        split: &mut Split<S>,
        history: &mut impl History<S>,
        interval: &Interval<S::Plain>,
        _: &Constants<S::Plain>,
    ) {
        let lag = Lag { time: self.frictional_lag };
        let value = lag.step_over(history, split.shape.value, interval);
        split.shape = split.shape.with_value(value);
    }
}
