//! Coulomb friction with the square of the load, and a root of speed with temperature
//! (Nevmerzhitskiy et al. 2019).

use super::FrictionLaw;
use super::curves::signed_root;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// Coulomb friction with the square of the load, and a root of speed that falls with
    /// temperature.
    Nevmerzhitskiy {
        /// Dry friction without load.
        coulomb_friction: "a1" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction per square of the load.
        load_square: "a2" ["1/T"] -10.0 .. 10.0, start 0.01 drawn 0.0 .. 10.0, InverseTorque, Dry;
        /// Torque per root of speed at high temperature.
        root_friction: "a3" ["T (s/X)^(1/2)"]
            -1e2 .. 1e2, start 0.1 drawn 0.0 .. 100.0, RootDamping, Rate;
        /// Additional torque per root of speed at 0 degC.
        root_friction_cold: "a4" ["T (s/X)^(1/2)"]
            -1e3 .. 1e3, start 0.1 drawn 0.0 .. 50.0, RootDamping, Rate;
        // The printed 309.89 has the torque of any value above 2 at room temperature: none.
        /// Relative decrease of that per kelvin.
        thinning: "a5" ["1/K"] 1e-3 .. 5.0, start 0.03 drawn 0.001 .. 0.3, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Nevmerzhitskiy<S> {
    const INFO: LawInfo = LawInfo {
        id: "nevmerzhitskiy",
        title: "Nevmerzhitskiy",
        source: "Nevmerzhitskiy et al. 2019; UR5e review 2024/25, table 2",
        formula: "(a1 + a2 tl^2 + (a3 + a4 exp(-a5 T)) sqrt(|v|)) sgn v",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature, Channel::LoadTorque],
        constants: &[],
        pole: None,
        captures: &["coulomb", "nonlinear_viscous", "load", "temperature_viscous"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let thinned = self.thinning.scale(-sample.temperature).exp();
        let root = self.root_friction + self.root_friction_cold * thinned;
        Split {
            coulomb: self.coulomb_friction,
            load: self.load_square.scale(sample.load_torque * sample.load_torque),
            rate: root.scale(signed_root(sample.velocity)),
            ..Split::zero()
        }
    }
}
