//! Static friction map of a gantry's ball screw (Gantry, Valdiero group, eq 2).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split, StribeckCurve};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Static map of a ball screw: Stribeck curve, and viscous friction per direction.
    GantryMap {
        /// Dry friction in full sliding.
        coulomb_friction: "Fc" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction at break-away, Coulomb friction included.
        static_friction: "Fs" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Torque per speed while moving forward.
        viscous_friction_forward: "s2_plus" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Torque per speed while moving backward.
        viscous_friction_backward: "s2_minus" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for GantryMap<S> {
    const INFO: LawInfo = LawInfo {
        id: "gantry_map",
        title: "Static map of a gantry's ball screw",
        source: "Gantry (Valdiero group), eq 2",
        formula: "(Fc + (Fs - Fc) exp(-(v/vs)^2)) sgn v + s2 v, s2 = s2_plus for v > 0, s2_minus for v < 0",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "direction"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let ratio = self.stribeck_velocity.reciprocal_times(v);
        let (forward, backward) = (self.viscous_friction_forward, self.viscous_friction_backward);
        let viscous = S::choose(v.is_positive(), forward, backward);
        Split {
            coulomb: self.coulomb_friction,
            height: self.static_friction - self.coulomb_friction,
            shape: StribeckCurve::new(ratio * ratio, S::from_f64(2.0)),
            rate: viscous.scale(v),
            ..Split::zero()
        }
    }
}
