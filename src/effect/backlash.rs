use super::FrictionEffect;
use crate::constants::Constants;
use crate::dynamics::{Gap, Interval, State};
use crate::sample::Split;
use crate::scalar::Real;
use crate::table::{Channel, EffectInfo, Parameters, parameters};

parameters! {
    /// Play between motor and joint. When the load torque changes its sign the teeth leave one
    /// flank, and until they meet the other the motor does not carry the load (Nordin and Gutman
    /// 2002, section 2).
    ///
    /// How that goes depends on what moves the load meanwhile. Where friction holds it, the motor
    /// crosses the gap at its own speed (exponent 1) and the load is lacking no momentum at the end
    /// (return 0). Where it moves freely, the time follows from its inertia and hardly from the
    /// speed (exponent towards 0), and as the flanks meet the motor makes up for the momentum that
    /// it did not give (return 1). So the gap yields no torque of its own: in time, what is given
    /// back never exceeds what was not carried. The gap closes gradually, as teeth and a fit need
    /// it, and the load is the whole load torque: a motor's inertia in it counts as load.
    Backlash {
        /// Way in which the gap closes to 1/e, at the reference speed.
        backlash_gap: "b" ["X"] 1e-4 .. 0.5, start 0.02, Position, Nonlinear;
        /// Exponent of the speed with which it closes.
        backlash_exponent: "n" ["1"] 0.0 .. 1.0, start 0.5, None, Nonlinear;
        /// Share of the momentum that is given back as the flanks meet.
        backlash_return: "r" ["1"] 0.0 .. 1.0, start 0.5, None, Nonlinear;
    }
}

impl<S: Real> FrictionEffect<S> for Backlash<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "backlash",
        group: "drive",
        title: "Backlash",
        what: "Teeth have play: when the load torque changes its sign they cross a gap, in which \
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
        state: &mut State<S>,
        interval: &Interval<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        let gap = Gap {
            width: self.backlash_gap,
            exponent: self.backlash_exponent,
            reference: constants.reference_velocity,
            returned: self.backlash_return,
        };
        split.additive += gap.over(&mut state.flanks, interval);
    }
}
