//! Effects that can be added to a law, one per file: how each changes a split.
//!
//! A new effect is one file here, its `mod` row and its row in `every_effect`.

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
mod thermometer_lag;
mod warm_up;

/// Every effect as `file: Type`, in the order in which they act: the one list of them.
macro_rules! every_effect {
    ($list:ident) => {
        $list! {
            stribeck: Stribeck,
            // Before all effects that use the Stribeck curve.
            frictional_lag: FrictionalLag,
            load: Load,
            quadrant: Quadrant,
            position: Position,
            direction: Direction,
            // After all effects on dry friction: time and temperature change all of it.
            drift: Drift,
            temperature_dry: TemperatureDry,
            nonlinear_viscous: NonlinearViscous,
            temperature_viscous: TemperatureViscous,
            offset: Offset,
            inertia: Inertia,
            gravity: Gravity,
            spring: Spring,
            ripple: Ripple,
            backlash: Backlash,
            elasticity: Elasticity,
            presliding: Presliding,
            // Of the whole torque, whatever it consists of.
            saturation: Saturation,
            gain: Gain,
            warm_up: WarmUp,
            // Of a channel that the law reads, whatever it does with it.
            thermometer_lag: ThermometerLag,
            delay: Delay,
        }
    };
}
pub(crate) use every_effect;

macro_rules! exported {
    ($($file:ident: $effect:ident),+ $(,)?) => {
        $(pub use $file::$effect;)+
    };
}
every_effect!(exported);

use crate::constants::Constants;
use crate::dynamics::{Bristle, History, Interval};
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters};

/// The interface of an effect.
pub trait FrictionEffect<S: Real>: Parameters<S> {
    /// The effect's table.
    const INFO: EffectInfo;

    /// Whether it has a state, separate from that of a bristle.
    const HAS_STATE: bool = false;

    /// Turns the sample that sensors show into the one that acts. The derivatives of what it
    /// changes with respect to parameters are taken on recordings, by `batch`.
    #[inline(always)]
    fn put_right(&self, _sample: &mut Sample<S::Plain>) {}

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
        _history: &mut impl History<S>,
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
