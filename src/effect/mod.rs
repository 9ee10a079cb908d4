//! Effects that can be added to a law, one per file: how each changes a split.
//!
//! A new effect is one file here and one entry in [`crate::catalog`], at its place in the order of
//! action.

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

/// The interface of an effect.
pub trait FrictionEffect<S: Real>: Parameters<S> {
    /// The effect's table.
    const INFO: EffectInfo;

    /// Whether it has a state, separate from that of a bristle.
    const HAS_STATE: bool = false;

    /// Changes the split. Effects that do not act on it (a bristle, a gain, a delay) leave it
    /// unchanged.
    #[inline]
    fn apply(
        &self,
        _split: &mut Split<S>,
        _sample: &Sample<S::Plain>,
        _constants: &Constants<S::Plain>,
    ) {
    }

    /// Like [`apply`](Self::apply), at the end of an interval: for effects with a state. In steady
    /// sliding both are equal.
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

    /// The measured value of a friction torque: effects of the torque channel distort the whole
    /// torque `tl + tf`, of which `tl` is known.
    #[inline]
    fn measured(
        &self,
        friction: S,
        _sample: &Sample<S::Plain>,
        _constants: &Constants<S::Plain>,
    ) -> S {
        friction
    }

    /// The bristle, if the effect adds one.
    #[inline]
    fn bristle(&self) -> Option<Bristle<S>> {
        None
    }
}
