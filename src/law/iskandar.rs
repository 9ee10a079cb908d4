//! Stribeck curve and a power of speed with coefficients quadratic in temperature (Iskandar and
//! Wolf 2019).

use super::FrictionLaw;
use super::curves::{gaussian_curve, quadratic, signed_power};
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// Stribeck curve and a power of speed, their coefficients quadratic in temperature.
    Iskandar {
        /// Dry friction at break-away, Coulomb friction included.
        static_friction: "a1" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Dry friction in full sliding at 0 degC.
        coulomb_friction: "a2" ["T"] -50.0 .. 50.0, start 0.5, Torque, Dry;
        /// Its linear coefficient in temperature.
        coulomb_friction_slope: "a3" ["T/K"] -5.0 .. 5.0, start 0.0, Torque, Dry;
        /// Its quadratic coefficient in temperature.
        coulomb_friction_square: "a4" ["T/K2"] -0.1 .. 0.1, start 0.0, Torque, Dry;
        /// Stribeck velocity at 0 degC.
        stribeck_velocity: "a5" ["X/s"] -1e3 .. 1e3, start 0.1 drawn -5.0 .. 5.0, Speed, Nonlinear;
        /// Its linear coefficient in temperature.
        stribeck_velocity_slope: "a6" ["X/s/K"]
            -1e2 .. 1e2, start 0.0 drawn -0.25 .. 0.25, Speed, Nonlinear;
        /// Its quadratic coefficient in temperature.
        stribeck_velocity_square: "a7" ["X/s/K2"]
            -1.0 .. 1.0, start 0.0 drawn -0.005 .. 0.005, Speed, Nonlinear;
        /// Torque per power of speed at 0 degC.
        power_friction: "a8" ["T (s/X)^dv"]
            -1e3 .. 1e3, start 0.1 drawn -100.0 .. 100.0, RootDamping, Rate;
        /// Its linear coefficient in temperature.
        power_friction_slope: "a9" ["T (s/X)^dv/K"] -5.0 .. 5.0, start 0.0, RootDamping, Rate;
        /// Its quadratic coefficient in temperature.
        power_friction_square: "a10" ["T (s/X)^dv/K2"] -0.1 .. 0.1, start 0.0, RootDamping, Rate;
        /// Exponent dv of speed at 0 degC.
        power_exponent: "a11" ["1"] 0.0 .. 3.0, start 1.0, None, Nonlinear;
        /// Its linear coefficient in temperature.
        power_exponent_slope: "a12" ["1/K"] -0.02 .. 0.02, start 0.0, None, Nonlinear;
        /// Its quadratic coefficient in temperature.
        power_exponent_square: "a13" ["1/K2"] -2e-4 .. 2e-4, start 0.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Iskandar<S> {
    const INFO: LawInfo = LawInfo {
        id: "iskandar",
        title: "Iskandar and Wolf",
        source: "Iskandar and Wolf 2019; UR5e review 2024/25, table 2",
        formula: "(Fc + (a1 - Fc) exp(-(v/vs)^2)) sgn v + Fv |v|^dv sgn v, Fc = a2 + a3 T + a4 T^2, \
                  vs = a5 + a6 T + a7 T^2, Fv = a8 + a9 T + a10 T^2, dv = a11 + a12 T + a13 T^2",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature],
        constants: &[],
        pole: None,
        captures: &[
            "coulomb",
            "viscous",
            "stribeck",
            "nonlinear_viscous",
            "temperature_viscous",
            "temperature_dry",
        ],
    };

    /// At temperatures where `vs` crosses zero there is no Stribeck friction, the limit from both
    /// sides.
    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let at = |coefficients| quadratic(coefficients, sample.temperature);
        let coulomb =
            at([self.coulomb_friction, self.coulomb_friction_slope, self.coulomb_friction_square]);
        let stribeck_velocity = at([
            self.stribeck_velocity,
            self.stribeck_velocity_slope,
            self.stribeck_velocity_square,
        ]);
        let viscous =
            at([self.power_friction, self.power_friction_slope, self.power_friction_square]);
        let exponent =
            at([self.power_exponent, self.power_exponent_slope, self.power_exponent_square]);
        Split {
            coulomb,
            height: self.static_friction - coulomb,
            shape: gaussian_curve(v, stribeck_velocity),
            rate: viscous * signed_power(v, exponent),
            ..Split::zero()
        }
    }
}
