//! Temperature, load and direction in one dynamic law (Tadese et al. 2021).

use super::FrictionLaw;
use super::curves::saturation;
use crate::constants::Constants;
use crate::dynamics::Bristle;
use crate::sample::{Quadrant, Sample, Split};
use crate::scalar::{Mask, Real};
use crate::table::{Channel, LawInfo, Parameters, parameters};

parameters! {
    /// A bristle of constant strength per direction, with an algebraic thermal part per direction
    /// and an algebraic load part per quadrant that jumps at rest.
    TadeseFull {
        /// Torque per deflection before sliding.
        bristle_stiffness: "s0" ["T/X"] 0.5 .. 2e6, start 50.0, Stiffness, Nonlinear;
        /// Torque per deflection rate at rest.
        bristle_damping: "s1" ["T s/X"] 0.0 .. 100.0, start 0.0, Damping, Rate;
        /// Speed at which the bristle's damping has fallen to 1/e.
        damping_velocity: "vd" ["X/s"] 1e-4 .. 10.0, start 0.01, Speed, Nonlinear;
        /// Dry friction, v > 0.
        coulomb_friction_forward: "Fc_plus" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction, v < 0.
        coulomb_friction_backward: "Fc_minus" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Limit of the viscous part at high speed, at 0 degC, v > 0.
        viscous_level_forward: "s20_plus" ["T"] 0.0 .. 20.0, start 0.5, Torque, Rate;
        /// Change of that level with temperature, v > 0.
        viscous_level_slope_forward: "s2T_plus" ["T/K"] -0.5 .. 0.5, start 0.0, Torque, Rate;
        /// Speed over which the viscous part rises at 0 degC, v > 0.
        viscous_speed_forward: "s30_plus" ["X/s"] 0.0 .. 20.0, start 0.5, Speed, Nonlinear;
        /// Change of that speed with temperature, v > 0.
        viscous_speed_slope_forward: "s3T_plus" ["X/s/K"] -0.5 .. 0.5, start 0.0, Speed, Nonlinear;
        /// Limit of the viscous part at high speed, at 0 degC, v < 0.
        viscous_level_backward: "s20_minus" ["T"] 0.0 .. 20.0, start 0.5, Torque, Rate;
        /// Change of that level with temperature, v < 0.
        viscous_level_slope_backward: "s2T_minus" ["T/K"] -0.5 .. 0.5, start 0.0, Torque, Rate;
        /// Speed over which the viscous part rises at 0 degC, v < 0.
        viscous_speed_backward: "s30_minus" ["X/s"] 0.0 .. 20.0, start 0.5, Speed, Nonlinear;
        /// Change of that speed with temperature, v < 0.
        viscous_speed_slope_backward: "s3T_minus" ["X/s/K"]
            -0.5 .. 0.5, start 0.0, Speed, Nonlinear;
        /// Torque that any load adds at high speed, v > 0, tl > 0.
        load_rise_forward_motoring: "g1_1" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// How fast that rises with speed, v > 0, tl > 0.
        load_rise_rate_forward_motoring: "g2_1" ["s/X"]
            0.01 .. 1e3, start 3.0, InverseSpeed, Nonlinear;
        /// Torque that any load adds at any speed, v > 0, tl > 0.
        load_jump_forward_motoring: "g3_1" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// Torque per load near rest, v > 0, tl > 0.
        load_friction_forward_motoring: "l1_1" ["1"] -10.0 .. 10.0, start 0.05, None, Rate;
        /// Growth of that with speed, v > 0, tl > 0.
        load_viscous_forward_motoring: "l2_1" ["s/X"] -10.0 .. 10.0, start 0.0, InverseSpeed, Rate;
        /// Torque that any load adds at high speed, v < 0, tl > 0.
        load_rise_backward_generating: "g1_2" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// How fast that rises with speed, v < 0, tl > 0.
        load_rise_rate_backward_generating: "g2_2" ["s/X"]
            0.01 .. 1e3, start 3.0, InverseSpeed, Nonlinear;
        /// Torque that any load adds at any speed, v < 0, tl > 0.
        load_jump_backward_generating: "g3_2" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// Torque per load near rest, v < 0, tl > 0.
        load_friction_backward_generating: "l1_2" ["1"] -10.0 .. 10.0, start -0.05, None, Rate;
        /// Growth of that with speed, v < 0, tl > 0.
        load_viscous_backward_generating: "l2_2" ["s/X"]
            -10.0 .. 10.0, start 0.0, InverseSpeed, Rate;
        /// Torque that any load adds at high speed, v < 0, tl < 0.
        load_rise_backward_motoring: "g1_3" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// How fast that rises with speed, v < 0, tl < 0.
        load_rise_rate_backward_motoring: "g2_3" ["s/X"]
            0.01 .. 1e3, start 3.0, InverseSpeed, Nonlinear;
        /// Torque that any load adds at any speed, v < 0, tl < 0.
        load_jump_backward_motoring: "g3_3" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// Torque per load near rest, v < 0, tl < 0.
        load_friction_backward_motoring: "l1_3" ["1"] -10.0 .. 10.0, start 0.05, None, Rate;
        /// Growth of that with speed, v < 0, tl < 0.
        load_viscous_backward_motoring: "l2_3" ["s/X"] -10.0 .. 10.0, start 0.0, InverseSpeed, Rate;
        /// Torque that any load adds at high speed, v > 0, tl < 0.
        load_rise_forward_generating: "g1_4" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// How fast that rises with speed, v > 0, tl < 0.
        load_rise_rate_forward_generating: "g2_4" ["s/X"]
            0.01 .. 1e3, start 3.0, InverseSpeed, Nonlinear;
        /// Torque that any load adds at any speed, v > 0, tl < 0.
        load_jump_forward_generating: "g3_4" ["T"] -10.0 .. 10.0, start 0.0, Torque, Rate;
        /// Torque per load near rest, v > 0, tl < 0.
        load_friction_forward_generating: "l1_4" ["1"] -10.0 .. 10.0, start -0.05, None, Rate;
        /// Growth of that with speed, v > 0, tl < 0.
        load_viscous_forward_generating: "l2_4" ["s/X"]
            -10.0 .. 10.0, start 0.0, InverseSpeed, Rate;
    }
}

impl<S: Real> TadeseFull<S> {
    /// `s1 exp(-|v/vd|)`.
    #[inline]
    fn damping(&self, velocity: S::Plain) -> S {
        self.bristle_damping * (-self.damping_velocity.reciprocal_times(velocity).abs()).exp()
    }

    /// `s2(T) (1 - exp(-|v/s3(T)|))` along the direction of motion.
    #[inline]
    fn viscous(&self, velocity: S::Plain, temperature: S::Plain) -> S {
        let forward = || {
            [
                self.viscous_level_forward,
                self.viscous_level_slope_forward,
                self.viscous_speed_forward,
                self.viscous_speed_slope_forward,
            ]
        };
        let backward = || {
            [
                self.viscous_level_backward,
                self.viscous_level_slope_backward,
                self.viscous_speed_backward,
                self.viscous_speed_slope_backward,
            ]
        };
        let [level, level_slope, speed, speed_slope] =
            velocity.is_positive().either(forward, backward);
        let level = level + level_slope.scale(temperature);
        let speed = speed + speed_slope.scale(temperature);
        (level * saturation(speed.reciprocal_times(velocity).abs())).along(velocity)
    }

    /// `g1 (1 - exp(-|g2 v|)) + g3 + (l1 + l2 v) tl` of the quadrant.
    #[inline]
    fn load(&self, sample: &Sample<S::Plain>) -> S {
        let [rise, rise_rate, jump, friction, viscous] =
            sample.in_quadrant(|quadrant| match quadrant {
                Quadrant::First => [
                    self.load_rise_forward_motoring,
                    self.load_rise_rate_forward_motoring,
                    self.load_jump_forward_motoring,
                    self.load_friction_forward_motoring,
                    self.load_viscous_forward_motoring,
                ],
                Quadrant::Second => [
                    self.load_rise_backward_generating,
                    self.load_rise_rate_backward_generating,
                    self.load_jump_backward_generating,
                    self.load_friction_backward_generating,
                    self.load_viscous_backward_generating,
                ],
                Quadrant::Third => [
                    self.load_rise_backward_motoring,
                    self.load_rise_rate_backward_motoring,
                    self.load_jump_backward_motoring,
                    self.load_friction_backward_motoring,
                    self.load_viscous_backward_motoring,
                ],
                Quadrant::Fourth => [
                    self.load_rise_forward_generating,
                    self.load_rise_rate_forward_generating,
                    self.load_jump_forward_generating,
                    self.load_friction_forward_generating,
                    self.load_viscous_forward_generating,
                ],
            });
        let per_load = friction + viscous.scale(sample.velocity);
        let rise = rise * saturation(rise_rate.scale(sample.velocity).abs());
        rise + jump + per_load.scale(sample.load_torque)
    }
}

impl<S: Real> FrictionLaw<S> for TadeseFull<S> {
    const INFO: LawInfo = LawInfo {
        id: "tadese_full",
        title: "Tadese et al., temperature and load",
        source: "Tadese et al. 2021, eqs 8-18, sgn v restored in eq 13, arctangent of eq 16 dropped",
        formula: "s0 z + s1 exp(-|v/vd|) dz/dt + sgn v s2 (1 - exp(-|v/s3|)) + b_i + a_i tl; \
                  dz/dt = v - s0 |v|/Fc z; s2 = s20 + s2T T, s3 = s30 + s3T T; Fc, s2, s3 per \
                  direction (_plus, _minus); b_i = g1 (1 - exp(-|g2 v|)) + g3, a_i = l1 + l2 v; \
                  i = 1 where v > 0 and tl > 0; i = 2 where v < 0 and tl > 0; \
                  i = 3 where v < 0 and tl < 0; i = 4 where v > 0 and tl < 0; \
                  b_i = a_i = 0 where v = 0 or tl = 0",
        parameters: Self::TABLE,
        channels: &[Channel::Temperature, Channel::LoadTorque],
        constants: &[],
        pole: None,
        captures: &[
            "coulomb",
            "viscous",
            "nonlinear_viscous",
            "direction",
            "load",
            "quadrant",
            "temperature_viscous",
            "presliding",
        ],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        let coulomb = S::choose(
            v.is_negative(),
            self.coulomb_friction_backward,
            self.coulomb_friction_forward,
        );
        let moving = || self.viscous(v, sample.temperature) + self.load(sample);
        Split { coulomb, rate: v.at_zero().either(S::zero, moving), ..Split::zero() }
    }

    #[inline]
    fn bristle(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Option<Bristle<S>> {
        Some(Bristle::new(self.bristle_stiffness, self.damping(sample.velocity)))
    }
}
