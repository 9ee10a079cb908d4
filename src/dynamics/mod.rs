//! Laws with a memory: their states, each stepped exactly for a velocity held over the step.
//!
//! One file a kind of state. A law of [`crate::law`] chooses its kind in
//! [`FrictionLaw::step`](crate::law::FrictionLaw::step); the effect `presliding` puts a bristle
//! around any static law.

mod bristle;

pub use bristle::{Bristle, BristleState};

use crate::sample::Sample;
use crate::scalar::Real;

/// A stretch of time over which a sample is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<P> {
    /// The sample that is held.
    pub sample: Sample<P>,
    /// The velocity that carries the state (X/s): the sample's, or, where positions tell it, the
    /// mean over the step, which makes the step second order.
    pub velocity: P,
    /// Length (s); with `dt <= 0` a state stays as it is.
    pub dt: P,
    /// Whether the mean torque is wanted too.
    pub mean: bool,
}

/// What one step yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S> {
    /// Torque at the end of the step (T).
    pub torque: S,
    /// Torque averaged over the step (T): times `v dt` it is the exact work. The torque at the
    /// end where it was not asked for.
    pub mean_torque: S,
}

impl<S: Real> Step<S> {
    /// A torque that does not change over the step.
    #[inline]
    #[must_use]
    pub fn same(torque: S) -> Self {
        Self { torque, mean_torque: torque }
    }
}

/// State of any model, kept apart from its parameters: each kind of law uses its own part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<S> {
    /// Deflection of a bristle.
    pub bristle: BristleState<S>,
}

impl<S: Real> State<S> {
    /// The state that a deflection `z` (X) at the start means; 0 is a joint without tension.
    #[inline]
    #[must_use]
    pub fn deflected(z: S) -> Self {
        Self { bristle: BristleState { z } }
    }
}

impl<S: Real> Default for State<S> {
    fn default() -> Self {
        Self::deflected(S::zero())
    }
}
