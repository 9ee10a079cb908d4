//! Load and temperature in one Stribeck law: M* (Bittencourt et al. 2010) and its later form
//! (Bittencourt and Gunnarsson 2012).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// Two Stribeck curves, one of load and one of temperature, and viscous friction that falls
    /// with temperature.
    BittencourtB {
        /// Dry friction in full sliding without load.
        coulomb_friction: "a1" ["T"] -1e2 .. 1e2, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Dry friction in full sliding per load.
        load_coulomb: "a2" ["1"] -10.0 .. 10.0, start 0.05 drawn 0.0 .. 10.0, None, Dry;
        /// Height of the load's Stribeck curve per load.
        load_stribeck: "a3" ["1"] -10.0 .. 10.0, start 0.02 drawn 0.0 .. 10.0, None, Dry;
        /// Speed at which the load's Stribeck curve has fallen to 1/e.
        load_stribeck_velocity: "a4" ["X/s"]
            1e-4 .. 1e3, start 0.1 drawn 0.002 .. 20.0, Speed, Nonlinear;
        /// Exponent of both Stribeck curves.
        stribeck_exponent: "a5" ["1"] 0.1 .. 2e3, start 1.3 drawn 0.3 .. 4.0, None, Nonlinear;
        /// Height of the temperature's Stribeck curve at 0 degC.
        stribeck_height: "a6" ["T"] -1e2 .. 1e2, start 0.2 drawn -10.0 .. 10.0, Torque, Dry;
        /// Growth of that height per kelvin.
        stribeck_height_slope: "a7" ["T/K"] -5.0 .. 5.0, start 0.0 drawn -0.5 .. 0.5, Torque, Dry;
        /// Stribeck velocity of the temperature's curve at 0 degC.
        stribeck_velocity: "a8" ["X/s"] -1e3 .. 1e3, start 0.1 drawn -2.0 .. 2.0, Speed, Nonlinear;
        /// Growth of that Stribeck velocity per kelvin.
        stribeck_velocity_slope: "a9" ["X/s/K"]
            -1e3 .. 1e3, start 0.0 drawn -0.05 .. 0.05, Speed, Nonlinear;
        /// Torque per speed at high temperature.
        viscous_friction: "a10" ["T s/X"] -1e2 .. 1e2, start 0.1 drawn 0.0 .. 10.0, Damping, Rate;
        /// Additional torque per speed at 0 degC.
        viscous_friction_cold: "a11" ["T s/X"]
            -1e3 .. 1e3, start 0.1 drawn 0.0 .. 50.0, Damping, Rate;
        /// Temperature over which that falls to 1/e.
        thinning_temperature: "a12" ["K"]
            1.0 .. 500.0, start 20.0 drawn 3.0 .. 500.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for BittencourtB<S> {
    const INFO: LawInfo = LawInfo {
        id: "bittencourt_b",
        title: "Bittencourt and Gunnarsson (B)",
        source: "Bittencourt and Gunnarsson 2012; UR5e review 2024/25, table 2, its signs mended",
        formula: "(a1 + a2 |tl| + a3 |tl| exp(-|v/a4|^a5) + (a6 + a7 T) exp(-|v/(a8 + a9 T)|^a5)) \
                  sgn v + (a10 + a11 exp(-T/a12)) v",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature, Channel::LoadTorque],
        constants: &[],
        pole: None,
        captures: CAPTURES,
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let terms = Terms {
            coulomb: self.coulomb_friction,
            load_coulomb: self.load_coulomb,
            load_stribeck: self.load_stribeck,
            load_stribeck_velocity: self.load_stribeck_velocity,
            height: [self.stribeck_height, self.stribeck_height_slope],
            velocity: [self.stribeck_velocity, self.stribeck_velocity_slope],
            viscous: [self.viscous_friction, self.viscous_friction_cold],
            thinning_temperature: self.thinning_temperature,
        };
        terms.split(self.stribeck_exponent, sample)
    }
}

parameters! {
    /// The extended model M* of 2010, with a constant exponent.
    MStar {
        /// Dry friction in full sliding without load.
        coulomb_friction: "Fc0" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction in full sliding per load.
        load_coulomb: "Fc_load" ["1"] 0.0 .. 10.0, start 0.05, None, Dry;
        /// Height of the load's Stribeck curve per load.
        load_stribeck: "Fs_load" ["1"] 0.0 .. 10.0, start 0.02, None, Dry;
        /// Speed at which the load's Stribeck curve has fallen to 1/e.
        load_stribeck_velocity: "vs_load" ["X/s"]
            1e-4 .. 1e3, start 0.1 drawn 0.002 .. 10.0, Speed, Nonlinear;
        /// Height of the temperature's Stribeck curve at 0 degC.
        stribeck_height: "Fs0" ["T"] -1e2 .. 1e2, start 0.2, Torque, Dry;
        /// Growth of that height per kelvin.
        stribeck_height_slope: "Fs_T" ["T/K"] -5.0 .. 5.0, start 0.0, Torque, Dry;
        /// Stribeck velocity of the temperature's curve at 0 degC.
        stribeck_velocity: "vs0" ["X/s"] -1e2 .. 1e2, start 0.1 drawn -2.0 .. 2.0, Speed, Nonlinear;
        /// Growth of that Stribeck velocity per kelvin.
        stribeck_velocity_slope: "vs_T" ["X/s/K"]
            -10.0 .. 10.0, start 0.0 drawn -0.05 .. 0.05, Speed, Nonlinear;
        /// Torque per speed at high temperature.
        viscous_friction: "Fv0" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Additional torque per speed at 0 degC.
        viscous_friction_cold: "Fv_T" ["T s/X"] 0.0 .. 50.0, start 0.1, Damping, Rate;
        /// Temperature over which that falls to 1/e.
        thinning_temperature: "TV" ["K"] 3.0 .. 500.0, start 20.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for MStar<S> {
    const INFO: LawInfo = LawInfo {
        id: "m_star",
        title: "Load and temperature, M*",
        source: "Bittencourt et al. 2010, M*",
        formula: "(Fc0 + Fc_load |tl| + Fs_load |tl| exp(-|v/vs_load|^alpha) + (Fs0 + Fs_T T) \
                  exp(-|v/(vs0 + vs_T T)|^alpha)) sgn v + (Fv0 + Fv_T exp(-T/TV)) v",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature, Channel::LoadTorque],
        constants: &["stribeck_exponent"],
        pole: None,
        captures: CAPTURES,
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S> {
        let terms = Terms {
            coulomb: self.coulomb_friction,
            load_coulomb: self.load_coulomb,
            load_stribeck: self.load_stribeck,
            load_stribeck_velocity: self.load_stribeck_velocity,
            height: [self.stribeck_height, self.stribeck_height_slope],
            velocity: [self.stribeck_velocity, self.stribeck_velocity_slope],
            viscous: [self.viscous_friction, self.viscous_friction_cold],
            thinning_temperature: self.thinning_temperature,
        };
        terms.split(S::from_plain(constants.stribeck_exponent), sample)
    }
}

const CAPTURES: &[&str] =
    &["coulomb", "viscous", "stribeck", "load", "temperature_viscous", "temperature_dry"];

/// The common form of the two laws.
struct Terms<S> {
    coulomb: S,
    load_coulomb: S,
    load_stribeck: S,
    load_stribeck_velocity: S,
    height: [S; 2],
    velocity: [S; 2],
    viscous: [S; 2],
    thinning_temperature: S,
}

impl<S: Real> Terms<S> {
    /// Where the Stribeck velocity crosses zero with temperature there is no Stribeck friction, the
    /// limit from both sides.
    #[inline]
    fn split(&self, exponent: S, sample: &Sample<S::Plain>) -> Split<S> {
        let (v, temperature) = (sample.velocity, sample.temperature);
        let along = |[at_zero, slope]: [S; 2]| at_zero + slope.scale(temperature);
        let by_load = stribeck_curve(v, self.load_stribeck_velocity, exponent);
        let share = self.load_coulomb + self.load_stribeck * by_load.value;
        let thinned = self.thinning_temperature.reciprocal_times(-temperature).exp();
        let [hot, cold] = self.viscous;
        Split {
            coulomb: self.coulomb,
            load: share.scale(sample.load_torque.abs()),
            height: along(self.height),
            shape: stribeck_curve(v, along(self.velocity), exponent),
            rate: (hot + cold * thinned).scale(v),
            ..Split::zero()
        }
    }
}
