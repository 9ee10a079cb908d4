use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// A drive train that twists under the load torque, by `tl/k`, so that motor and joint do not
    /// accelerate alike.
    ///
    /// With the motion measured at the joint the motor turns `tl/k` further and its inertia `Jm`
    /// needs the torque `Jm/k d2(tl)/dt2`. With the motion measured at the motor the joint turns
    /// `tl/k` less and its inertia `Jl` asks for `-Jl/k d2(tl)/dt2`. The sign tells which, and
    /// `1/sqrt|c|` is the angular frequency of that inertia on the spring (Spong 1987). Taken to
    /// first order in `1/k`, with friction on the motor's side of the spring; that gravity acts at
    /// the shifted position is slow beside it, and left out.
    Elasticity {
        /// Inertia over stiffness: at the motor where positive, at the joint where negative.
        elasticity: "c" ["s2"] -1.0 .. 1.0, start 0.0, SquareTime, Additive;
    }
}

impl<S: Real> FrictionEffect<S> for Elasticity<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "elasticity",
        group: "drive",
        title: "Elasticity",
        what: "The drive train twists under the load torque, so motor and joint do not \
               accelerate alike.",
        formula: "tf + c d2(tl)/dt2",
        needs: "a load torque that changes fast, or positions on both sides of the drive train",
        beyond: None,
        channels: &[Channel::LoadTorqueCurvature],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        split.additive.add_scaled(&self.elasticity, sample.load_torque_curvature);
    }
}
