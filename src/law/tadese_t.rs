//! LuGre with temperature (Tadese et al. 2022).

use super::FrictionLaw;
use super::curves::{gaussian_curve, saturation};
use crate::constants::Constants;
use crate::dynamics::Bristle;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// LuGre with a viscous part that saturates and depends on temperature.
    TadeseT {
        /// Torque per deflection before sliding.
        bristle_stiffness: "a1" ["T/X"] 0.5 .. 2e6, start 50.0, Stiffness, Nonlinear;
        /// Torque per deflection rate.
        bristle_damping: "a2" ["T s/X"] 0.0 .. 1e3, start 0.0 drawn 0.0 .. 5.0, Damping, Rate;
        /// Dry friction in full sliding.
        coulomb_friction: "a3" ["T"] 0.0 .. 1e3, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Dry friction at break-away, Coulomb friction included.
        static_friction: "a4" ["T"] 0.0 .. 1e3, start 0.7 drawn 0.0 .. 10.0, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "a5" ["X/s"]
            1e-4 .. 1e3, start 0.1 drawn 0.002 .. 20.0, Speed, Nonlinear;
        /// Limit of the viscous part at high speed, at 0 degC.
        viscous_level: "a6" ["T"] -10.0 .. 10.0, start 0.5, Torque, Rate;
        /// Change of that level with temperature.
        viscous_level_slope: "a7" ["T/K"] -10.0 .. 10.0, start 0.0 drawn -0.2 .. 0.2, Torque, Rate;
        /// How fast the viscous part rises with speed at 0 degC.
        viscous_rise: "a8" ["s/X"]
            -1e4 .. 1e4, start 1.0 drawn -100.0 .. 100.0, InverseSpeed, Nonlinear;
        /// Change of that rise with temperature.
        viscous_rise_slope: "a9" ["s/X/K"]
            -1e5 .. 1e5, start 0.0 drawn -2.0 .. 2.0, InverseSpeed, Nonlinear;
        /// Exponent of speed in the viscous part at 0 degC.
        viscous_exponent: "a10" ["1"] -1e3 .. 1e3, start 1.0 drawn -10.0 .. 10.0, None, Nonlinear;
        /// Change of that exponent with temperature.
        viscous_exponent_slope: "a11" ["1/K"]
            -1e2 .. 1e2, start 0.0 drawn -0.2 .. 0.2, None, Nonlinear;
    }
}

impl<S: Real> TadeseT<S> {
    /// The viscous part, which jumps at rest where its exponent is negative.
    #[inline]
    fn viscous(&self, velocity: S::Plain, temperature: S::Plain) -> S {
        let at = |base: S, slope: S| base + slope.scale(temperature);
        let level = at(self.viscous_level, self.viscous_level_slope);
        let rise = at(self.viscous_rise, self.viscous_rise_slope);
        let exponent = at(self.viscous_exponent, self.viscous_exponent_slope);
        let reach = rise.scale(velocity).abs().powf(exponent);
        let torque = (level * saturation(reach)).along(velocity);
        S::choose(velocity.at_zero(), S::zero(), torque)
    }
}

impl<S: Real> FrictionLaw<S> for TadeseT<S> {
    const INFO: LawInfo = LawInfo {
        id: "tadese_t",
        title: "Tadese et al., temperature",
        source: "Tadese et al. 2022; UR5e review 2024/25, table 3, sgn v restored in fv",
        formula: "a1 z + a2 dz/dt + fv; dz/dt = v - a1 |v|/g z; g = a3 + (a4 - a3) exp(-(v/a5)^2); \
                  fv = sgn v (a6 + a7 T) (1 - exp(-|(a8 + a9 T) v|^(a10 + a11 T)))",
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
            "presliding",
        ],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            height: self.static_friction - self.coulomb_friction,
            shape: gaussian_curve(sample.velocity, self.stribeck_velocity),
            rate: self.viscous(sample.velocity, sample.temperature),
            ..Split::zero()
        }
    }

    #[inline]
    fn bristle(&self, _: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Option<Bristle<S>> {
        Some(Bristle::new(self.bristle_stiffness, self.bristle_damping))
    }
}
