//! Drift of dry friction with time.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Dry friction that changes slowly with time.
    Drift {
        /// Relative change of dry friction from the start of the recording to its end.
        drift_change: "d" ["1"] -0.9 .. 3.0, start 0.1, None, Nonlinear;
        /// Duration of the recording in time constants; 0 for a linear change.
        drift_curvature: "kt" ["1"] 0.0 .. 30.0, start 2.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Drift<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "drift",
        group: "friction",
        title: "Drift",
        what: "Surfaces run in or wear and grease spreads, so dry friction changes slowly with \
               time, whatever the temperature.",
        formula: "D (1 + d (1 - exp(-kt t/duration))/(1 - exp(-kt)))",
        needs: "temperature that does not change steadily with time",
        beyond: None,
        channels: &[Channel::Time],
        constants: &["duration"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let share = sample.time / constants.duration;
        // `phi_1(x) = expm1(x)/x` gives the straight line at zero curvature.
        let curvature = -self.drift_curvature;
        let done = curvature.scale(share).phi(1).scale(share) / curvature.phi(1);
        let factor = (self.drift_change * done).shift(S::Plain::one());
        split.coulomb *= factor;
        split.height *= factor;
        split.load *= factor;
        split.smoothed_amplitude *= factor;
        split.smoothed_torque *= factor;
    }
}
