//! Laws with a sigmoid in place of the sign of the velocity (Gaz et al. 2018, 2019).

use super::FrictionLaw;
use super::curves::{logistic, saturation};
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Viscous friction, a constant torque and a sigmoid.
    GazA {
        /// Torque per speed.
        viscous_friction: "a1" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Torque in backward motion, without its viscous part.
        backward_level: "a2" ["T"] -20.0 .. 10.0, start -0.5, Torque, Additive;
        /// Additional torque in forward motion: twice the dry friction.
        sigmoid_height: "a3" ["T"] 0.0 .. 20.0, start 1.0, Torque, Dry;
        /// How fast the sigmoid rises with velocity.
        sigmoid_steepness: "a4" ["s/X"] 1.0 .. 1e5, start 50.0, InverseSpeed, Nonlinear;
        /// Minus the velocity in the middle of the sigmoid.
        velocity_offset: "a5" ["X/s"] -0.5 .. 0.5, start 0.0, Speed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for GazA<S> {
    const INFO: LawInfo = LawInfo {
        id: "gaz_a",
        title: "Gaz (A)",
        source: "Gaz et al. 2018; UR5e review 2024/25, table 1",
        formula: "a1 v + a2 + a3/(1 + exp(-a4 (v + a5)))",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "offset"],
    };

    /// `1/(1 + exp(-x)) = 1/2 + tanh(x/2)/2`: half the height is an offset, the other half
    /// friction.
    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let half = S::Plain::from_f64(0.5);
        let amplitude = self.sigmoid_height.scale(half);
        let x = self.sigmoid_steepness * self.velocity_offset.shift(sample.velocity);
        Split {
            smoothed_amplitude: amplitude,
            smoothed_torque: amplitude * x.scale(half).tanh(),
            rate: self.viscous_friction.scale(sample.velocity),
            additive: self.backward_level + amplitude,
            ..Split::zero()
        }
    }
}

parameters! {
    /// A sigmoid that passes through zero.
    GazB {
        /// Torque between the ends of the sigmoid: the sum of dry friction in both directions.
        sigmoid_height: "a1" ["T"] 0.0 .. 40.0, start 2.0, Torque, Dry;
        /// How fast the sigmoid rises with velocity.
        sigmoid_steepness: "a2" ["s/X"] 0.2 .. 1e5, start 5.0, InverseSpeed, Nonlinear;
        /// Minus the velocity in the middle of the sigmoid.
        velocity_offset: "a3" ["X/s"] -0.5 .. 0.5, start 0.0, Speed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for GazB<S> {
    const INFO: LawInfo = LawInfo {
        id: "gaz_b",
        title: "Gaz (B)",
        source: "Gaz et al. 2019; UR5e review 2024/25, table 1",
        formula: "a1/(1 + exp(-a2 (v + a3))) - a1/(1 + exp(-a2 a3))",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "direction"],
    };

    /// With `s` the sigmoid, `x = a2 |v|` and `w = a2 a3 sgn v`, the difference is
    /// `s(x + w) - s(w) = s(-w) s(x + w) (1 - exp(-x))`: a product without cancellation.
    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let x = self.sigmoid_steepness.scale(v.abs());
        let direction = S::Plain::choose(v.is_positive(), S::Plain::one(), -S::Plain::one());
        let w = (self.sigmoid_steepness * self.velocity_offset).scale(direction);
        let amplitude = self.sigmoid_height * logistic(-w);
        Split {
            smoothed_amplitude: amplitude,
            smoothed_torque: (amplitude * logistic(x + w) * saturation(x)).scale(direction),
            ..Split::zero()
        }
    }
}
