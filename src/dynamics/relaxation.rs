//! A state that relaxes linearly along the travel, stepped exactly.

use super::{SATURATED, following};
use crate::scalar::{Mask, Real};

/// `dz/ds = (target - z) pull/hold` along a travel `s`, with `pull >= 0`; with `hold = 0` the state
/// is at its target as soon as there is travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation<S> {
    /// The target of the state.
    pub target: S,
    /// Numerator of the rate.
    pub pull: S,
    /// Denominator of the rate.
    pub hold: S,
}

/// The state after a travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxed<S> {
    /// At the end of the travel.
    pub end: S,
    /// Averaged over the travel.
    pub mean: S,
    /// The exponent `-(pull/hold) s`: the remaining share of the distance is its exponential.
    pub decay: S,
}

impl<S: Real> Relaxation<S> {
    /// The state after a travel `>= 0`, from `z`.
    #[inline]
    #[must_use]
    pub fn step_over(&self, z: S, travel: S::Plain) -> Relaxed<S> {
        let pull = self.pull.scale(travel);
        let way = self.target - z;
        let bound = self.hold.plain() * S::Plain::from_f64(SATURATED);
        let settles = || {
            let mean = self.target - way * (self.hold / pull);
            [self.target, mean, S::from_f64(-SATURATED)]
        };
        let follows = || {
            let decay = -(pull / self.hold);
            let way = way * -decay;
            [z + way * decay.phi(1), z + way * decay.phi(2), decay]
        };
        let [end, mean, decay] = pull
            .at_zero()
            .either(|| [z, z, S::zero()], || pull.reaches(bound).either(settles, follows));
        Relaxed { end, mean, decay }
    }
}

impl<S: Real> Relaxed<S> {
    /// The share of a change of the target that the state has followed: the target moves linearly
    /// and has the constant value at the middle.
    #[inline]
    #[must_use]
    pub fn following(&self) -> S {
        following(self.decay, self.decay.phi(1))
    }
}
