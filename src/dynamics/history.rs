//! What effects remember of the steps before: numbers that relax, count or hold a value, or are those
//! of a step ago.
//!
//! An effect says how a step changes a number, and not where it is kept. So its code runs sample by
//! sample with the numbers of a [`State`](super::State), and records a graph that runs over whole
//! columns.

use crate::scalar::{Mask, Real};

/// A number that effects keep from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// The lagging Stribeck curve minus its steady value.
    CurveDeviation,
    /// The steady value of the Stribeck curve.
    SteadyCurve,
    /// The load torque with the last sign it had (T).
    Load,
    /// 1 once the load torque has changed its sign.
    GapParted,
    /// The travel since the load torque changed its sign (X).
    GapWay,
    /// The momentum that the load is lacking (T s).
    GapMomentum,
}

#[cfg(feature = "python")]
impl Kept {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::CurveDeviation,
        Self::SteadyCurve,
        Self::Load,
        Self::GapParted,
        Self::GapWay,
        Self::GapMomentum,
    ];
}

/// Where the numbers are kept. All are 0 before the first step. Each method steps one number and
/// returns it before and after the step.
pub trait History<S: Real> {
    /// `z + share (0 - z) + shift`.
    fn relax(&mut self, kept: Kept, share: S, shift: S) -> [S; 2];

    /// `z + by`, or `from` where it restarts.
    fn count(&mut self, kept: Kept, restarts: S::Mask, from: impl FnOnce() -> S, by: S) -> [S; 2];

    /// `z`, or `x` where it is set.
    fn hold(&mut self, kept: Kept, sets: S::Mask, x: S) -> [S; 2];

    /// `x`; at the first step it was the same before.
    fn follow(&mut self, kept: Kept, x: S) -> [S; 2];
}

/// The numbers of the effects of one model.
#[derive(Clone, Copy, Debug)]
pub struct EffectState<S: Real> {
    /// Whether a number that follows has a value.
    pub(super) begun: S::Mask,
    curve_deviation: S,
    steady_curve: S,
    load: S,
    gap_parted: S,
    gap_way: S,
    gap_momentum: S,
}

impl<S: Real> Default for EffectState<S> {
    fn default() -> Self {
        let zero = S::zero();
        Self {
            begun: S::Mask::of(false),
            curve_deviation: zero,
            steady_curve: zero,
            load: zero,
            gap_parted: zero,
            gap_way: zero,
            gap_momentum: zero,
        }
    }
}

impl<S: Real> EffectState<S> {
    #[inline(always)]
    pub(super) const fn number(&mut self, kept: Kept) -> &mut S {
        match kept {
            Kept::CurveDeviation => &mut self.curve_deviation,
            Kept::SteadyCurve => &mut self.steady_curve,
            Kept::Load => &mut self.load,
            Kept::GapParted => &mut self.gap_parted,
            Kept::GapWay => &mut self.gap_way,
            Kept::GapMomentum => &mut self.gap_momentum,
        }
    }

    #[inline(always)]
    fn step(&mut self, kept: Kept, change: impl FnOnce(S) -> S) -> [S; 2] {
        let number = self.number(kept);
        let before = *number;
        *number = change(before);
        [before, *number]
    }
}

impl<S: Real> History<S> for EffectState<S> {
    #[inline(always)]
    fn relax(&mut self, kept: Kept, share: S, shift: S) -> [S; 2] {
        self.step(kept, |z| z + share * -z + shift)
    }

    #[inline(always)]
    fn count(&mut self, kept: Kept, restarts: S::Mask, from: impl FnOnce() -> S, by: S) -> [S; 2] {
        self.step(kept, |z| restarts.either(from, || z + by))
    }

    #[inline(always)]
    fn hold(&mut self, kept: Kept, sets: S::Mask, x: S) -> [S; 2] {
        self.step(kept, |z| S::choose(sets, x, z))
    }

    #[inline(always)]
    fn follow(&mut self, kept: Kept, x: S) -> [S; 2] {
        let begun = core::mem::replace(&mut self.begun, S::Mask::of(true));
        let [before, now] = self.step(kept, |_| x);
        [S::choose(begun, before, x), now]
    }
}
