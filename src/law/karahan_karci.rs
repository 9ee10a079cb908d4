//! A Stribeck law for each combination of signs of velocity and acceleration (Karahan and Karci).

use super::FrictionLaw;
use super::curves::gaussian_curve;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::{Mask, Real};
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// A Stribeck law for each of the four combinations of signs of velocity and acceleration.
    ///
    /// Taken from its description in the UR5e review, section 2.1: a decreasing exponential, with
    /// each parameter defined for the four conditions. The description does not give the exponent;
    /// the usual 2 is used. Where the acceleration is 0 the joint counts as accelerating.
    KarahanKarci {
        /// Dry friction in full sliding, v > 0, a >= 0.
        coulomb_friction_forward_accelerating: "Fc_pp" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction at break-away, v > 0, a >= 0.
        static_friction_forward_accelerating: "Fs_pp" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Torque per speed, v > 0, a >= 0.
        viscous_friction_forward_accelerating: "Fv_pp" ["T s/X"]
            0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Speed at which the Stribeck curve has fallen to 1/e, v > 0, a >= 0.
        stribeck_velocity_forward_accelerating: "vs_pp" ["X/s"]
            0.002 .. 10.0, start 0.1, Speed, Nonlinear;
        /// Dry friction in full sliding, v > 0, a < 0.
        coulomb_friction_forward_decelerating: "Fc_pm" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction at break-away, v > 0, a < 0.
        static_friction_forward_decelerating: "Fs_pm" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Torque per speed, v > 0, a < 0.
        viscous_friction_forward_decelerating: "Fv_pm" ["T s/X"]
            0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Speed at which the Stribeck curve has fallen to 1/e, v > 0, a < 0.
        stribeck_velocity_forward_decelerating: "vs_pm" ["X/s"]
            0.002 .. 10.0, start 0.1, Speed, Nonlinear;
        /// Dry friction in full sliding, v < 0, a <= 0.
        coulomb_friction_backward_accelerating: "Fc_mm" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction at break-away, v < 0, a <= 0.
        static_friction_backward_accelerating: "Fs_mm" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Torque per speed, v < 0, a <= 0.
        viscous_friction_backward_accelerating: "Fv_mm" ["T s/X"]
            0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Speed at which the Stribeck curve has fallen to 1/e, v < 0, a <= 0.
        stribeck_velocity_backward_accelerating: "vs_mm" ["X/s"]
            0.002 .. 10.0, start 0.1, Speed, Nonlinear;
        /// Dry friction in full sliding, v < 0, a > 0.
        coulomb_friction_backward_decelerating: "Fc_mp" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction at break-away, v < 0, a > 0.
        static_friction_backward_decelerating: "Fs_mp" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Torque per speed, v < 0, a > 0.
        viscous_friction_backward_decelerating: "Fv_mp" ["T s/X"]
            0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Speed at which the Stribeck curve has fallen to 1/e, v < 0, a > 0.
        stribeck_velocity_backward_decelerating: "vs_mp" ["X/s"]
            0.002 .. 10.0, start 0.1, Speed, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for KarahanKarci<S> {
    const INFO: LawInfo = LawInfo {
        id: "karahan_karci",
        title: "Karahan and Karci",
        source: "Karahan and Karci, by the UR5e review 2024/25, section 2.1; exponent 2",
        formula: "(Fc + (Fs - Fc) exp(-(v/vs)^2)) sgn v + Fv v, each by the signs of v and a: _pp, \
                  _pm, _mp, _mm; a = 0 counts as the sign of v",
        parameters: Self::TABLE,
        channels: &[Channel::Acceleration],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "direction", "frictional_lag"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let [coulomb, static_friction, viscous, stribeck_velocity] = self.set(sample);
        Split {
            coulomb,
            height: static_friction - coulomb,
            shape: gaussian_curve(v, stribeck_velocity),
            rate: viscous.scale(v),
            ..Split::zero()
        }
    }
}

impl<S: Real> KarahanKarci<S> {
    /// Coulomb, static and viscous friction and Stribeck velocity of the sample's condition.
    #[inline]
    fn set(&self, sample: &Sample<S::Plain>) -> [S; 4] {
        let forward = sample.velocity.is_positive();
        let a = sample.acceleration;
        let accelerating =
            forward.and(a.is_negative().not()).or(forward.not().and(a.is_positive().not()));
        let of = |pp, pm, mm, mp| {
            let forwards = S::choose(accelerating, pp, pm);
            let backwards = S::choose(accelerating, mm, mp);
            S::choose(forward, forwards, backwards)
        };
        [
            of(
                self.coulomb_friction_forward_accelerating,
                self.coulomb_friction_forward_decelerating,
                self.coulomb_friction_backward_accelerating,
                self.coulomb_friction_backward_decelerating,
            ),
            of(
                self.static_friction_forward_accelerating,
                self.static_friction_forward_decelerating,
                self.static_friction_backward_accelerating,
                self.static_friction_backward_decelerating,
            ),
            of(
                self.viscous_friction_forward_accelerating,
                self.viscous_friction_forward_decelerating,
                self.viscous_friction_backward_accelerating,
                self.viscous_friction_backward_decelerating,
            ),
            of(
                self.stribeck_velocity_forward_accelerating,
                self.stribeck_velocity_forward_decelerating,
                self.stribeck_velocity_backward_accelerating,
                self.stribeck_velocity_backward_decelerating,
            ),
        ]
    }
}
