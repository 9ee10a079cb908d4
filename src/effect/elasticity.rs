//! Elasticity of the drive train (Spong 1987).

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// A drive train that twists under the load torque, by `tl/k`, so that motor and joint have
    /// different accelerations.
    ///
    /// With the motion measured at the joint the motor turns `tl/k` further and its inertia `Jm`
    /// needs the torque `Jm/k d2(tl)/dt2`. With the motion measured at the motor the joint turns
    /// `tl/k` less and its inertia `Jl` adds `-Jl/k d2(tl)/dt2`. The sign of `c` tells which, and
    /// `1/sqrt|c|` is the angular frequency of that inertia on the spring (Spong 1987). Friction is on
    /// the motor's side of the spring; the change of gravity with the twist is slow in comparison and
    /// neglected.
    ///
    /// Where the load torque changes faster than the drive train can follow, the joint oscillates
    /// about the motor, and the torque `ts` of the spring takes the place of the load torque: `tl`
    /// behind a resonance with the period `2 pi/wn` and the share `zeta` of critical damping. A spring
    /// may harden with a cubic part (Tuttle and Seering 1996), and the inertia `Jm` of the motor does
    /// not oscillate. With a period of 0 the effect is the first order in `1/k`. The column holds the
    /// second derivative of `ts`, for a spring that hardens of its linear part; the constants only
    /// tell how it was made.
    Elasticity {
        /// Inertia over stiffness: positive for the motor's inertia, negative for the joint's.
        elasticity: "c" ["s2"] -1.0 .. 1.0, start 0.0, SquareTime, Additive;
    }
}

impl<S: Real> FrictionEffect<S> for Elasticity<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "elasticity",
        group: "drive",
        title: "Elasticity",
        what: "The drive train twists under the load torque, so motor and joint have \
               different accelerations.",
        formula: "tf + c d2(ts)/dt2; \
                  tl - Jm a = ts (1 + (ts/tk)^2) + 2 zeta/wn dts/dt + 1/wn^2 d2(ts)/dt2",
        needs: "a load torque that changes fast, or positions on both sides of the drive train",
        beyond: None,
        channels: &[Channel::LoadTorqueCurvature],
        constants: &[
            "resonance_period",
            "resonance_damping",
            "resonance_hardening",
            "resonance_motor_inertia",
        ],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        split.additive.add_scaled(&self.elasticity, sample.load_torque_curvature);
    }
}
