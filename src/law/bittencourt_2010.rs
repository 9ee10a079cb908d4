//! The Stribeck law M0 and its extension by load, M1 (Bittencourt et al. 2010). The exponent is
//! fixed unless asked for: a held parameter of M0, a constant of M1.

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// Stribeck curve and viscous friction; `Fs` is the height above `Fc`.
    M0 {
        /// Dry friction in full sliding.
        coulomb_friction: "Fc" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Height of the Stribeck curve above Coulomb friction at rest.
        stribeck_height: "Fs" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Torque per speed.
        viscous_friction: "Fv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 10.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve; fixed in a fit unless it is given bounds.
        stribeck_exponent: "alpha" ["1"] 0.5 .. 4.0, start 1.3, None, Held;
    }
}

impl<S: Real> FrictionLaw<S> for M0<S> {
    const INFO: LawInfo = LawInfo {
        id: "m0",
        title: "Stribeck, M0",
        source: "Bittencourt et al. 2010, M0",
        formula: "(Fc + Fs exp(-|v/vs|^alpha)) sgn v + Fv v",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let (velocity, exponent) = (self.stribeck_velocity, self.stribeck_exponent);
        Split {
            coulomb: self.coulomb_friction,
            height: self.stribeck_height,
            shape: stribeck_curve(sample.velocity, velocity, exponent),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}

parameters! {
    /// Coulomb friction and a Stribeck height that grow with the load.
    M1 {
        /// Dry friction in full sliding without load.
        coulomb_friction: "Fc0" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction in full sliding per load.
        load_coulomb: "Fc_load" ["1"] 0.0 .. 10.0, start 0.05, None, Dry;
        /// Height of the Stribeck curve above Coulomb friction at rest without load.
        stribeck_height: "Fs0" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Height of the Stribeck curve per load.
        load_stribeck: "Fs_load" ["1"] 0.0 .. 10.0, start 0.02, None, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 10.0, start 0.1, Speed, Nonlinear;
        /// Torque per speed.
        viscous_friction: "Fv" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

impl<S: Real> FrictionLaw<S> for M1<S> {
    const INFO: LawInfo = LawInfo {
        id: "m1",
        title: "Stribeck with load, M1",
        source: "Bittencourt et al. 2010, M1",
        formula: "(Fc0 + Fc_load |tl| + (Fs0 + Fs_load |tl|) exp(-|v/vs|^alpha)) sgn v + Fv v",
        parameters: Self::TABLE,
        channels: &[Channel::LoadTorque],
        constants: &["stribeck_exponent"],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "load"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S> {
        let exponent = S::from_plain(constants.stribeck_exponent);
        let shape = stribeck_curve(sample.velocity, self.stribeck_velocity, exponent);
        let share = self.load_coulomb + self.load_stribeck * shape.value;
        Split {
            coulomb: self.coulomb_friction,
            height: self.stribeck_height,
            shape,
            load: share.scale(sample.load_torque.abs()),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }
}
