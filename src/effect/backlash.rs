//! Backlash between motor and joint (Nordin and Gutman 2002).

use super::FrictionEffect;
use crate::constants::Constants;
use crate::dynamics::{Gap, History, Interval};
use crate::sample::Split;
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Backlash between motor and joint. When the load torque changes its sign the teeth leave one
    /// flank, and until they meet the other the motor does not carry the load (Nordin and Gutman
    /// 2002, section 2).
    ///
    /// The motion of the load in the gap decides the rest. Where friction holds the load, the motor
    /// crosses the gap at its own speed (exponent 1) and the load has lost no momentum at the end
    /// (return 0). Where the load moves freely, the time follows from its inertia and depends
    /// little on the speed (exponent towards 0), and as the flanks meet the motor restores the
    /// missing momentum (return 1). The gap generates no momentum: what is restored never exceeds
    /// what was not carried. The gap closes gradually, as real teeth do and as a fit needs it. The
    /// load is the complete load torque, including the inertia of the motor.
    Backlash {
        /// Travel over which the gap closes to 1/e, at the reference speed.
        backlash_gap: "b" ["X"] 1e-4 .. 0.5, start 0.02, Position, Nonlinear;
        /// Exponent of the speed at which the gap closes.
        backlash_exponent: "n" ["1"] 0.0 .. 1.0, start 0.5, None, Nonlinear;
        /// Share of the momentum that is restored as the flanks meet.
        backlash_return: "r" ["1"] 0.0 .. 1.0, start 0.5, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Backlash<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "backlash",
        group: "drive",
        title: "Backlash",
        what: "Teeth have backlash: when the load torque changes its sign they cross a gap, in which \
               the motor does not carry the load.",
        formula: "tf - tl g + P h, g = exp(-(w/b)^2), dP/dt = r tl g - P h, h = -dg/dt/g, \
                  dw/dt = |v|^n vr^(1 - n) since tl last changed its sign",
        needs: "a load torque that changes its sign in motion",
        beyond: None,
        channels: &[Channel::LoadTorque],
        constants: &["reference_velocity"],
        parameters: Self::TABLE,
    };

    const HAS_STATE: bool = true;

    #[inline]
    fn apply_over(
        &self,
        split: &mut Split<S>,
        history: &mut impl History<S>,
        interval: &Interval<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let gap = Gap {
            width: self.backlash_gap,
            exponent: self.backlash_exponent,
            reference: constants.reference_velocity,
            returned: self.backlash_return,
        };
        split.additive += gap.step_over(history, interval);
    }
}
