//! Coulomb and quadratic friction with smoothed signs (Indri et al. 2013).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split, arctangent_sign};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Coulomb and quadratic friction with a smoothed sign, a second arc tangent, and viscous
    /// friction.
    IndriA {
        /// Dry friction with the first smoothed sign.
        coulomb_friction: "a1" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Torque per radian of the second arc tangent; negative for a Stribeck curve.
        arctangent_friction: "a2" ["T"] -10.0 .. 10.0, start 0.1, Torque, Dry;
        /// How fast the second arc tangent rises with speed.
        arctangent_steepness: "a3" ["s/X"] 0.5 .. 1e5, start 20.0, InverseSpeed, Nonlinear;
        /// Torque per speed.
        viscous_friction: "a4" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Torque per square of speed.
        quadratic_friction: "a5" ["T s2/X2"] -20.0 .. 20.0, start 0.0, SquareDamping, Rate;
        /// How fast the first smoothed sign rises with speed.
        sign_steepness: "a6" ["s/X"] 0.5 .. 1e5, start 100.0, InverseSpeed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for IndriA<S> {
    const INFO: LawInfo = LawInfo {
        id: "indri_a",
        title: "Indri (A)",
        source: "Indri et al. 2013; UR5e review 2024/25, table 1",
        formula: "a1 S0 + a2 atan(a3 v) + a4 v + a5 v^2 S0, S0 = (2/pi) atan(a6 v)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "nonlinear_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let sign = arctangent_sign(v, self.sign_steepness);
        let curve = self.arctangent_steepness.scale(v).atan();
        let quarter = S::Plain::from_f64(core::f64::consts::FRAC_PI_2);
        Split {
            smoothed_amplitude: self.coulomb_friction + self.arctangent_friction.scale(quarter),
            smoothed_torque: self.coulomb_friction * sign + self.arctangent_friction * curve,
            rate: self.viscous_friction.scale(v) + self.quadratic_friction.scale(v * v) * sign,
            ..Split::zero()
        }
    }
}
