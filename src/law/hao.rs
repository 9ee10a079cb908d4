//! Cubic polynomials of speed, with a factor that is linear in temperature (Hao et al. 2021; Simoni
//! et al. 2019).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// A cubic polynomial of speed.
    HaoA {
        /// Dry friction, independent of speed.
        coulomb_friction: "a1" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Torque per speed.
        viscous_friction: "a2" ["T s/X"] 0.0 .. 20.0, start 0.1, Damping, Rate;
        /// Torque per square of speed.
        quadratic_friction: "a3" ["T s2/X2"] -20.0 .. 20.0, start 0.0, SquareDamping, Rate;
        /// Torque per cube of speed.
        cubic_friction: "a4" ["T s3/X3"] 0.0 .. 20.0, start 0.0, CubicDamping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for HaoA<S> {
    const INFO: LawInfo = LawInfo {
        id: "hao_a",
        title: "Hao (A)",
        source: "Hao et al. 2021; UR5e review 2024/25, table 1",
        formula: "a1 sgn v + a2 v + a3 v^2 sgn v + a4 v^3",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "nonlinear_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let rates = [self.viscous_friction, self.quadratic_friction, self.cubic_friction];
        Split {
            coulomb: self.coulomb_friction,
            rate: cubic(rates, sample.velocity),
            ..Split::zero()
        }
    }
}

parameters! {
    /// A cubic polynomial of speed, with all friction linear in temperature.
    HaoB {
        /// Dry friction at the base temperature.
        coulomb_friction: "a1" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Torque per speed at the base temperature.
        viscous_friction: "a2" ["T s/X"] 0.0 .. 20.0, start 0.1, Damping, Rate;
        /// Torque per square of speed at the base temperature.
        quadratic_friction: "a3" ["T s2/X2"] -20.0 .. 20.0, start 0.0, SquareDamping, Rate;
        /// Torque per cube of speed at the base temperature.
        cubic_friction: "a4" ["T s3/X3"] 0.0 .. 20.0, start 0.0, CubicDamping, Rate;
        /// Relative increase of all friction per kelvin.
        temperature_slope: "a5" ["1/K"] -0.2 .. 0.2, start 0.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for HaoB<S> {
    const INFO: LawInfo = LawInfo {
        id: "hao_b",
        title: "Hao (B)",
        source: "Hao et al. 2021; UR5e review 2024/25, table 2",
        formula: "(a1 sgn v + a2 v + a3 v^2 sgn v + a4 v^3) (1 + a5 (T - T0))",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature],
        constants: &["base_temperature"],
        pole: None,
        captures: &[
            "coulomb",
            "viscous",
            "nonlinear_viscous",
            "temperature_viscous",
            "temperature_dry",
        ],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S> {
        let above = sample.temperature - constants.base_temperature;
        let factor = self.temperature_slope.scale(above).shift(S::Plain::one());
        let rates = [self.viscous_friction, self.quadratic_friction, self.cubic_friction];
        Split {
            coulomb: self.coulomb_friction * factor,
            rate: cubic(rates, sample.velocity) * factor,
            ..Split::zero()
        }
    }
}

parameters! {
    /// A cubic polynomial of speed times a linear function of temperature.
    Simoni {
        /// Dry friction at the base temperature, for a scale of 1.
        coulomb_friction: "a1" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Torque per speed at the base temperature, for a scale of 1.
        viscous_friction: "a2" ["T s/X"] 0.0 .. 20.0, start 0.1, Damping, Rate;
        /// Torque per square of speed at the base temperature, for a scale of 1.
        quadratic_friction: "a3" ["T s2/X2"] -20.0 .. 20.0, start 0.0, SquareDamping, Rate;
        /// Torque per cube of speed at the base temperature, for a scale of 1.
        cubic_friction: "a4" ["T s3/X3"] 0.0 .. 20.0, start 0.0, CubicDamping, Rate;
        /// Scale of all friction at the base temperature; fixed at 1 in a fit.
        scale: "a5" ["1"] 0.0 .. 10.0, start 1.0, None, Held;
        /// Increase of that scale per kelvin.
        scale_slope: "a6" ["1/K"] -0.2 .. 0.2, start 0.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Simoni<S> {
    const INFO: LawInfo = LawInfo {
        id: "simoni",
        title: "Simoni",
        source: "Simoni et al. 2019; UR5e review 2024/25, table 2",
        formula: "(a1 sgn v + a2 v + a3 v^2 sgn v + a4 v^3) (a5 + a6 (T - T0))",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature],
        constants: &["base_temperature"],
        pole: None,
        captures: &[
            "coulomb",
            "viscous",
            "nonlinear_viscous",
            "temperature_viscous",
            "temperature_dry",
        ],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S> {
        let above = sample.temperature - constants.base_temperature;
        let factor = self.scale + self.scale_slope.scale(above);
        let rates = [self.viscous_friction, self.quadratic_friction, self.cubic_friction];
        Split {
            coulomb: self.coulomb_friction * factor,
            rate: cubic(rates, sample.velocity) * factor,
            ..Split::zero()
        }
    }
}

/// `a v + b v^2 sgn v + c v^3`.
#[inline]
fn cubic<S: Real>([a, b, c]: [S; 3], v: S::Plain) -> S {
    a.scale(v) + b.scale(v * v.abs()) + c.scale(v * v * v)
}
