//! Rate-dependent friction that is not proportional to speed.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// Rate-dependent friction that is not proportional to speed.
    NonlinearViscous {
        /// Torque per speed at the reference speed.
        nonlinear_viscous_coefficient: "nc" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Exponent of the speed: friction flattens below 1 and steepens above 1.
        nonlinear_viscous_exponent: "n" ["1"] 0.15 .. 4.0, start 2.0, None, Nonlinear;
        /// Speed around which the curve levels off; far above the motion it has no influence.
        nonlinear_viscous_saturation: "vl" ["X/s"] 0.01 .. 50.0, start 10.0, Speed, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for NonlinearViscous<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "nonlinear_viscous",
        group: "friction",
        title: "Nonlinear viscous friction",
        what: "The lubricant is shear-thinning, churns or becomes turbulent, so friction is not \
               proportional to speed.",
        formula: "V + nc (|v/vr| (1 + vr/vl)/(1 + |v/vl|))^n vr sgn v",
        needs: "a wide range of speed",
        beyond: None,
        channels: &[],
        constants: &["reference_velocity"],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(
        &self,
        split: &mut Split<S>,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let (v, reference) = (sample.velocity, constants.reference_velocity);
        let levelling = |speed| S::one() + S::from_plain(speed) / self.nonlinear_viscous_saturation;
        // The curve is 1 at the reference speed, or the coefficient would have no bound where it
        // levels off.
        let speed =
            S::from_plain((v / reference).abs()) * levelling(reference) / levelling(v.abs());
        let curve = speed.powf(self.nonlinear_viscous_exponent);
        let friction = self.nonlinear_viscous_coefficient * curve;
        let friction = S::choose(v.at_zero(), S::zero(), friction);
        split.rate.add_scaled(&friction, reference * v.sign());
    }
}
