//! Effects that can be missing from a law, one file each: what each does to a split.
//!
//! A new effect is one file here and one row in [`crate::catalog`], placed where it acts.

mod backlash;
mod delay;
mod direction;
mod drift;
mod elasticity;
mod factor;
mod frictional_lag;
mod gain;
mod gravity;
mod inertia;
mod load;
mod nonlinear_viscous;
mod offset;
mod position;
mod presliding;
mod quadrant;
mod ripple;
mod saturation;
mod spring;
mod stribeck;
mod temperature_dry;
mod temperature_viscous;

pub use backlash::Backlash;
pub use delay::Delay;
pub use direction::Direction;
pub use drift::Drift;
pub use elasticity::Elasticity;
pub use frictional_lag::FrictionalLag;
pub use gain::Gain;
pub use gravity::Gravity;
pub use inertia::Inertia;
pub use load::Load;
pub use nonlinear_viscous::NonlinearViscous;
pub use offset::Offset;
pub use position::Position;
pub use presliding::Presliding;
pub use quadrant::Quadrant;
pub use ripple::Ripple;
pub use saturation::Saturation;
pub use spring::Spring;
pub use stribeck::Stribeck;
pub use temperature_dry::TemperatureDry;
pub use temperature_viscous::TemperatureViscous;

use crate::constants::Constants;
use crate::dynamics::{Bristle, Interval, State};
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters};

/// What a file in this folder provides.
pub trait FrictionEffect<S: Real>: Parameters<S> {
    /// The effect's table.
    const INFO: EffectInfo;

    /// Whether it has a state of its own, beside a bristle's.
    const HAS_STATE: bool = false;

    /// Changes the split; effects that are no part of it (a bristle, a gain, a delay) leave it
    /// alone.
    #[inline]
    fn apply(
        &self,
        _split: &mut Split<S>,
        _sample: &Sample<S::Plain>,
        _constants: &Constants<S::Plain>,
    ) {
    }

    /// As [`apply`](Self::apply), at the end of an interval: what an effect with a state of its
    /// own does. In steady sliding it does what `apply` says.
    #[inline]
    fn apply_over(
        &self,
        split: &mut Split<S>,
        _state: &mut State<S>,
        interval: &Interval<S::Plain>,
        constants: &Constants<S::Plain>,
    ) {
        self.apply(split, &interval.sample, constants);
    }

    /// What the torque channel shows of `friction` where the way from the motor's current to a
    /// torque is wrong: it distorts all torque `tl + tf` alike, of which `tl` is known.
    #[inline]
    fn measured(
        &self,
        friction: S,
        _sample: &Sample<S::Plain>,
        _constants: &Constants<S::Plain>,
    ) -> S {
        friction
    }

    /// The bristle, if that is what the effect adds.
    #[inline]
    fn bristle(&self) -> Option<Bristle<S>> {
        None
    }
}
