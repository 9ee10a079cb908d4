//! A state that relaxes linearly along the travel, stepped exactly.

use super::{SATURATED, following};
use crate::scalar::{Mask, Real};

/// Above this ratio of pull to hold a state is at its target wherever it is.
const LOOSE: f64 = 1e30;

/// `dz/ds = (target - z) pull/hold` along a travel `s`, with `pull >= 0`; a state without hold is
/// at its target as soon as anything moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation<S> {
    /// Where the state tends to.
    pub target: S,
    /// What pulls it there.
    pub pull: S,
    /// What holds it back.
    pub hold: S,
}

/// Where a travel leaves the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxed<S> {
    /// At the end of the travel.
    pub end: S,
    /// Averaged over the travel.
    pub mean: S,
    /// Minus `pull/hold s`: what is left of the way to the target is its exponential.
    pub decay: S,
}

impl<S: Real> Relaxation<S> {
    /// The state after a travel `>= 0`, from `z`.
    #[inline]
    #[must_use]
    pub fn over(&self, z: S, travel: S::Plain) -> Relaxed<S> {
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

    /// `dz/ds` at `z`.
    #[inline]
    #[must_use]
    pub fn slope(&self, z: S) -> S {
        let bound = self.hold.plain() * S::Plain::from_f64(LOOSE);
        let loose = self.pull.reaches(bound);
        loose.either(S::zero, || (self.target - z) * (self.pull / self.hold))
    }
}

impl<S: Real> Relaxed<S> {
    /// How far the state has followed a target that moved from the one that was held to the one at
    /// the end.
    #[inline]
    #[must_use]
    pub fn following(&self) -> S {
        following(self.decay, self.decay.phi(1))
    }
}
