//! Coulomb and viscous friction with a third, nonlinear term (Grotjahn et al. 2001).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Coulomb and viscous friction and the cube root of speed.
    GrotjahnA {
        /// Torque per speed.
        viscous_friction: "a1" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Dry friction, independent of speed.
        coulomb_friction: "a2" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Torque per cube root of speed.
        cube_root_friction: "a3" ["T (s/X)^(1/3)"] 0.0 .. 20.0, start 0.1, RootDamping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for GrotjahnA<S> {
    const INFO: LawInfo = LawInfo {
        id: "grotjahn_a",
        title: "Grotjahn (A)",
        source: "Grotjahn et al. 2001; UR5e review 2024/25, table 1",
        formula: "a1 v + a2 sgn v + a3 cbrt(v)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "nonlinear_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        Split {
            coulomb: self.coulomb_friction,
            rate: self.viscous_friction.scale(v) + self.cube_root_friction.scale(v.cbrt()),
            ..Split::zero()
        }
    }
}

parameters! {
    /// Coulomb and viscous friction and the arc tangent of speed.
    GrotjahnB {
        /// Torque per speed.
        viscous_friction: "a1" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Dry friction, independent of speed.
        coulomb_friction: "a2" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Torque per radian of the arc tangent.
        arctangent_friction: "a3" ["T"] -10.0 .. 10.0, start 0.1, Torque, Rate;
        /// How fast the arc tangent rises with speed.
        arctangent_steepness: "a4" ["s/X"] 0.5 .. 1e4, start 20.0, InverseSpeed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for GrotjahnB<S> {
    const INFO: LawInfo = LawInfo {
        id: "grotjahn_b",
        title: "Grotjahn (B)",
        source: "Grotjahn et al. 2001; UR5e review 2024/25, table 1",
        formula: "a1 v + a2 sgn v + a3 atan(a4 v)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "nonlinear_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let curve = self.arctangent_steepness.scale(v).atan();
        Split {
            coulomb: self.coulomb_friction,
            rate: self.viscous_friction.scale(v) + self.arctangent_friction * curve,
            ..Split::zero()
        }
    }
}
