//! A bristle with a smoothed sign, and damping that falls with speed (Indri et al. 2020).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::dynamics::Bristle;
use crate::sample::{Sample, Split, arctangent_sign};
use crate::scalar::Real;
use crate::table::{Channel, LawInfo, Parameters, parameters};

/// Below this speed the damping no longer grows (X/s).
const SLOWEST: f64 = 1e-30;

parameters! {
    /// A bristle with a smoothed sign, whose damping falls with speed and acceleration.
    IndriB {
        /// Torque per deflection before sliding.
        bristle_stiffness: "a1" ["T/X"] 0.5 .. 2e6, start 50.0, Stiffness, Nonlinear;
        /// Bristle damping times speed, where the damping falls with speed.
        damping_torque: "a2" ["T"] 0.0 .. 1e3, start 0.0, Torque, Rate;
        /// Weight of acceleration in that decrease.
        acceleration_weight: "a3" ["1"] 1e-6 .. 1e6, start 1.0, None, Nonlinear;
        /// Bristle damping at high speed.
        bristle_damping: "a4" ["T s/X"] 0.0 .. 100.0, start 0.0, Damping, Rate;
        /// Steepness of the smoothed sign.
        sign_steepness: "a5" ["s/X"] 1.0 .. 1e6, start 1e3, InverseSpeed, Nonlinear;
        /// Dry friction at rest.
        coulomb_friction: "a6" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Increase of dry friction at high speed.
        dry_growth: "a7" ["T"] 0.0 .. 1e3, start 0.1, Torque, Dry;
        /// How fast it increases with speed.
        dry_growth_rate: "a8" ["s/X"] 0.0 .. 1e3, start 1.0, InverseSpeed, Nonlinear;
        /// Torque per speed.
        viscous_friction: "a9" ["T s/X"] -100.0 .. 100.0, start 0.1, Damping, Rate;
        /// Torque per speed squared.
        quadratic_friction: "a10" ["T s2/X2"] -100.0 .. 100.0, start 0.0, SquareDamping, Rate;
    }
}

impl<S: Real> IndriB<S> {
    /// `(2/pi) atan(a5 v)`.
    #[inline]
    fn smooth_sign(&self, velocity: S::Plain) -> S {
        arctangent_sign(velocity, self.sign_steepness)
    }

    /// `f`; 0 where it is not finite close to rest, where there is no slip.
    #[inline]
    fn damping(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> S {
        let unit = constants.largest_velocity / constants.largest_acceleration;
        let speed = sample.velocity.abs();
        let slowest = S::Plain::from_f64(SLOWEST);
        let speed = S::Plain::choose(speed.is_above(slowest.plain()), speed, slowest);
        let ratio = (sample.acceleration * unit).abs() / speed;
        // Above this ratio the square overflows in single precision; the term is then negligible.
        let most = S::Plain::from_f64(1e15);
        let ratio = ratio.choose_below(most.plain(), ratio, most);
        let fall = self.acceleration_weight.scale(ratio * ratio).shift(S::Plain::one()).sqrt();
        self.damping_torque / fall.scale(speed) + self.bristle_damping
    }
}

impl<S: Real> FrictionLaw<S> for IndriB<S> {
    const INFO: LawInfo = LawInfo {
        id: "indri_b",
        title: "Indri et al. (B)",
        source: "Indri et al. 2020; UR5e review 2024/25, table 3, the acceleration in f restored",
        formula: "a1 z + f dz/dt + a9 v + a10 v^2 S0; dz/dt = S0^2 v - a1 S0 v/g z, \
                  S0 = (2/pi) atan(a5 v); g = a6 + a7 (2/pi) atan(a8 S0 v); \
                  f = a2/sqrt(a3 (a vmax/amax)^2 + v^2) + a4, f dz/dt = 0 at v = 0",
        parameters: Self::TABLE,
        channels: &[Channel::Acceleration],
        constants: &["largest_velocity", "largest_acceleration"],
        pole: None,
        captures: &["coulomb", "viscous", "nonlinear_viscous", "presliding"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let sign = self.smooth_sign(v);
        let growth = two_over_pi((self.dry_growth_rate * sign.scale(v)).atan());
        let dry = self.coulomb_friction + self.dry_growth * growth;
        Split {
            smoothed_amplitude: dry,
            smoothed_torque: dry * sign,
            rate: self.viscous_friction.scale(v) + self.quadratic_friction.scale(v * v) * sign,
            ..Split::zero()
        }
    }

    #[inline]
    fn bristle(
        &self,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) -> Option<Bristle<S>> {
        Some(Bristle {
            stiffness: self.bristle_stiffness,
            damping: self.damping(sample, constants),
            sign_steepness: Some(self.sign_steepness),
        })
    }
}

#[inline]
fn two_over_pi<S: Real>(x: S) -> S {
    x.scale(S::Plain::from_f64(core::f64::consts::FRAC_2_PI))
}
