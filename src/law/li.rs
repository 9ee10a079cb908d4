//! Load squared, powers of speed and temperature (Li et al. 2024).

use super::FrictionLaw;
use super::curves::{signed_power, signed_root};
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, Pole, parameters};

parameters! {
    /// Offset, Coulomb friction with the square of the load, and two powers of speed, one of them a
    /// rational function of temperature.
    Li {
        /// Constant torque.
        offset: "a1" ["T"] -10.0 .. 10.0, start 0.0, Torque, Additive;
        /// Dry friction without load.
        coulomb_friction: "a2" ["T"] -1e2 .. 1e2, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Torque per power of speed.
        power_friction: "a3" ["T (s/X)^a4"] 0.0 .. 1000.0, start 0.1, RootDamping, Rate;
        /// Exponent of speed.
        power_exponent: "a4" ["1"] 0.01 .. 5.0, start 1.0 drawn 0.05 .. 3.0, None, Nonlinear;
        /// Torque per root of speed, without the next two terms.
        root_friction: "a5" ["T (s/X)^(1/2)"] -100.0 .. 100.0, start 0.0, RootDamping, Rate;
        /// Its increase per kelvin.
        root_friction_slope: "a6" ["T (s/X)^(1/2)/K"] -5.0 .. 5.0, start 0.0, RootDamping, Rate;
        /// Its increase per inverse cube of temperature.
        root_friction_inverse_cube: "a7" ["T (s/X)^(1/2) K3"]
            -1e6 .. 1e6, start 0.0, RootDamping, Rate;
        /// Dry friction per square of the load.
        load_square: "a8" ["1/T"] -10.0 .. 10.0, start 0.01 drawn 0.0 .. 10.0, InverseTorque, Dry;
    }
}

impl<S: Real> FrictionLaw<S> for Li<S> {
    const INFO: LawInfo = LawInfo {
        id: "li",
        title: "Li",
        source: "Li et al. 2024; UR5e review 2024/25, table 2",
        formula: "a1 + (a2 + a3 |v|^a4 + sqrt(|v|) (a5 + a6 T + a7 T^-3) + a8 tl^2) sgn v",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature, Channel::LoadTorque],
        constants: &[],
        pole: Some(Pole::Zero),
        captures: &[
            "coulomb",
            "viscous",
            "nonlinear_viscous",
            "load",
            "temperature_viscous",
            "offset",
        ],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let (v, temperature) = (sample.velocity, sample.temperature);
        let inverse = S::Plain::one() / temperature;
        // One factor at a time: a coefficient of 0 gives 0 however close the pole is.
        let cold = self.root_friction_inverse_cube.scale(inverse).scale(inverse).scale(inverse);
        let root = self.root_friction + self.root_friction_slope.scale(temperature) + cold;
        Split {
            coulomb: self.coulomb_friction,
            load: self.load_square.scale(sample.load_torque * sample.load_torque),
            rate: self.power_friction * signed_power(v, self.power_exponent)
                + root.scale(signed_root(v)),
            additive: self.offset,
            ..Split::zero()
        }
    }
}
