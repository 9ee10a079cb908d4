//! A Stribeck curve without Coulomb friction, and temperature (Madsen et al. 2021).

use super::FrictionLaw;
use super::curves::signed_root;
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, Pole, parameters};

parameters! {
    /// A Stribeck curve that falls to zero, a root of speed that depends on temperature, and a
    /// cubic polynomial.
    Madsen {
        /// Dry friction at break-away; it falls to zero in full sliding.
        static_friction: "a1" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Speed at which dry friction has fallen to 1/e.
        stribeck_velocity: "a2" ["X/s"]
            0.002 .. 1000.0, start 1.0 drawn 0.002 .. 20.0, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "a3" ["1"] 0.3 .. 4.0, start 1.0, None, Nonlinear;
        /// Torque per root of speed and kelvin above the base temperature.
        root_friction_slope: "a4" ["T (s/X)^(1/2)/K"] -5.0 .. 5.0, start 0.0, RootDamping, Rate;
        /// Torque per root of speed times the cube of the kelvins above the base temperature.
        root_friction_inverse_cube: "a5" ["T (s/X)^(1/2) K3"]
            -1e6 .. 1e6, start 0.0, RootDamping, Rate;
        /// Torque per speed.
        viscous_friction: "a6" ["T s/X"] 0.0 .. 20.0, start 0.1, Damping, Rate;
        /// Torque per square of speed.
        quadratic_friction: "a7" ["T s2/X2"] -20.0 .. 20.0, start 0.0, SquareDamping, Rate;
        /// Torque per cube of speed.
        cubic_friction: "a8" ["T s3/X3"] 0.0 .. 20.0, start 0.0, CubicDamping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for Madsen<S> {
    const INFO: LawInfo = LawInfo {
        id: "madsen",
        title: "Madsen",
        source: "Madsen et al. 2021; UR5e review 2024/25, table 2",
        formula: "(a1 exp(-(|v|/a2)^a3) + sqrt(|v|) (a4 (T - T0) + a5 (T - T0)^-3)) sgn v + a6 v \
                  + a7 |v| v + a8 v^3",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature],
        constants: &["base_temperature"],
        pole: Some(Pole::Base),
        captures: &["coulomb", "viscous", "stribeck", "nonlinear_viscous", "temperature_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let above = sample.temperature - constants.base_temperature;
        let inverse = S::Plain::one() / above;
        // One factor at a time: a coefficient of 0 gives 0 however close the pole is.
        let cold = self.root_friction_inverse_cube.scale(inverse).scale(inverse).scale(inverse);
        let root = self.root_friction_slope.scale(above) + cold;
        Split {
            height: self.static_friction,
            shape: stribeck_curve(v, self.stribeck_velocity, self.stribeck_exponent),
            rate: root.scale(signed_root(v))
                + self.viscous_friction.scale(v)
                + self.quadratic_friction.scale(v * v.abs())
                + self.cubic_friction.scale(v * v * v),
            ..Split::zero()
        }
    }
}
