//! Load dependence per quadrant: motoring or generating.

use super::FrictionEffect;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Load dependence that differs between motoring and generating, and changes with speed.
    Quadrant {
        /// Half the difference of friction per load between motoring and generating, near rest.
        quadrant_coulomb: "qc" ["1"] -10.0 .. 10.0, start 0.0, None, Dry;
        /// Half the difference of friction between motoring and generating without load.
        quadrant_jump: "qj" ["T"] -10.0 .. 10.0, start 0.0, Torque, Dry;
        /// Growth with speed of half that difference per load.
        quadrant_viscous: "qv" ["s/X"] -10.0 .. 10.0, start 0.0, InverseSpeed, Dry;
        /// Growth with speed of friction per load, the same in all quadrants.
        quadrant_load_viscous: "ql" ["s/X"] -10.0 .. 10.0, start 0.0, InverseSpeed, Dry;
    }
}

impl<S: Real> FrictionEffect<S> for Quadrant<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "quadrant",
        group: "friction",
        title: "Quadrant",
        what: "Gear teeth carry load differently when the load drives the joint than when it is \
               driven, so friction under load differs between motoring and generating.",
        formula: "D + (qc + qv |v|) tl sgn v + qj sgn(v tl) + ql |v tl|",
        needs: "both signs of power flow, and a load torque that is known independently",
        beyond: Some("load"),
        channels: &[Channel::LoadTorque],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn apply(&self, split: &mut Split<S>, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) {
        let (speed, size) = (sample.velocity.abs(), sample.load_torque.abs());
        let motoring = sample.velocity.sign() * sample.load_torque.sign();
        split.load.add_scaled(&self.quadrant_coulomb, size * motoring);
        split.load.add_scaled(&self.quadrant_jump, motoring);
        split.load.add_scaled(&self.quadrant_viscous, speed * size * motoring);
        split.load.add_scaled(&self.quadrant_load_viscous, speed * size);
    }
}
