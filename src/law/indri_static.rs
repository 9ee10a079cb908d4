//! Static friction map of a direct-drive arm (Indri et al., eqs 3, 6, 7).

use super::FrictionLaw;
use super::curves::saturation;
use crate::constants::Constants;
use crate::sample::{Sample, Split, StribeckCurve};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Two exponentials of speed and a quadratic, with separate coefficients for each direction.
    IndriStatic {
        /// Dry friction between the two exponentials, while moving forward.
        coulomb_friction_forward: "c0_plus" ["T"]
            -100.0 .. 100.0, start 0.5 drawn -10.0 .. 10.0, Torque, Dry;
        /// Dry friction that decays with speed.
        stribeck_height_forward: "c1_plus" ["T"]
            -100.0 .. 100.0, start 0.2 drawn -10.0 .. 10.0, Torque, Dry;
        /// Dry friction that builds up with speed.
        coulomb_rise_forward: "c2_plus" ["T"]
            -100.0 .. 100.0, start 0.0 drawn -10.0 .. 10.0, Torque, Dry;
        /// Torque per speed.
        viscous_friction_forward: "c3_plus" ["T s/X"]
            -10.0 .. 10.0, start 0.1 drawn 0.0 .. 10.0, Damping, Rate;
        /// Torque per square of speed, with the same sign in both directions.
        quadratic_friction_forward: "c4_plus" ["T s2/X2"]
            -10.0 .. 10.0, start 0.0, SquareDamping, Rate;
        /// Speed at which the first exponential has fallen to 1/e.
        stribeck_velocity_forward: "w1_plus" ["X/s"] 0.002 .. 10.0, start 0.1, Speed, Nonlinear;
        /// Speed at which the second exponential has fallen to 1/e.
        rise_velocity_forward: "w2_plus" ["X/s"] 0.002 .. 10.0, start 0.2, Speed, Nonlinear;
        /// Dry friction between the two exponentials, while moving backward.
        coulomb_friction_backward: "c0_minus" ["T"]
            -100.0 .. 100.0, start 0.5 drawn -10.0 .. 10.0, Torque, Dry;
        /// Dry friction that decays with speed.
        stribeck_height_backward: "c1_minus" ["T"]
            -100.0 .. 100.0, start 0.2 drawn -10.0 .. 10.0, Torque, Dry;
        /// Dry friction that builds up with speed.
        coulomb_rise_backward: "c2_minus" ["T"]
            -100.0 .. 100.0, start 0.0 drawn -10.0 .. 10.0, Torque, Dry;
        /// Torque per speed.
        viscous_friction_backward: "c3_minus" ["T s/X"]
            -10.0 .. 10.0, start 0.1 drawn 0.0 .. 10.0, Damping, Rate;
        /// Torque per square of speed, with the same sign in both directions.
        quadratic_friction_backward: "c4_minus" ["T s2/X2"]
            -10.0 .. 10.0, start 0.0, SquareDamping, Rate;
        /// Speed at which the first exponential has fallen to 1/e.
        stribeck_velocity_backward: "w1_minus" ["X/s"] 0.002 .. 10.0, start 0.1, Speed, Nonlinear;
        /// Speed at which the second exponential has fallen to 1/e.
        rise_velocity_backward: "w2_minus" ["X/s"] 0.002 .. 10.0, start 0.2, Speed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for IndriStatic<S> {
    const INFO: LawInfo = LawInfo {
        id: "indri_static",
        title: "Static map of a direct-drive arm",
        source: "Indri et al., direct-drive manipulators, eqs 3, 6, 7",
        formula: "(c0 + c1 exp(-|v|/w1) + c2 (1 - exp(-|v|/w2))) sgn v + c3 v + c4 v^2, each _plus \
                  for v > 0, _minus for v < 0",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "nonlinear_viscous", "direction"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let set = self.set(v.is_positive());
        Split {
            coulomb: set.coulomb
                + set.rise * saturation(set.rise_velocity.reciprocal_times(v.abs())),
            height: set.height,
            shape: StribeckCurve::new(set.stribeck_velocity.reciprocal_times(v.abs()), S::one()),
            rate: set.viscous.scale(v) + set.quadratic.scale(v * v),
            ..Split::zero()
        }
    }
}

/// Coefficients of one direction.
struct Set<S> {
    coulomb: S,
    height: S,
    rise: S,
    viscous: S,
    quadratic: S,
    stribeck_velocity: S,
    rise_velocity: S,
}

impl<S: Real> IndriStatic<S> {
    #[inline]
    fn set(&self, forward: S::Mask) -> Set<S> {
        let of = |plus, minus| S::choose(forward, plus, minus);
        Set {
            coulomb: of(self.coulomb_friction_forward, self.coulomb_friction_backward),
            height: of(self.stribeck_height_forward, self.stribeck_height_backward),
            rise: of(self.coulomb_rise_forward, self.coulomb_rise_backward),
            viscous: of(self.viscous_friction_forward, self.viscous_friction_backward),
            quadratic: of(self.quadratic_friction_forward, self.quadratic_friction_backward),
            stribeck_velocity: of(self.stribeck_velocity_forward, self.stribeck_velocity_backward),
            rise_velocity: of(self.rise_velocity_forward, self.rise_velocity_backward),
        }
    }
}
