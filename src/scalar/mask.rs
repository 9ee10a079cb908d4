use core::fmt::Debug;

use super::Real;

/// Yes or no, once for each of several numbers that are compared side by side.
pub trait Mask: Copy + Debug {
    /// The same for each.
    fn of(yes: bool) -> Self;
    /// Both.
    #[must_use]
    fn and(self, other: Self) -> Self;
    /// Either or both.
    #[must_use]
    fn or(self, other: Self) -> Self;
    /// The opposite.
    #[must_use]
    fn not(self) -> Self;
    /// Whether it is yes throughout.
    fn all(self) -> bool;
    /// What `yes` yields where it holds, and what `no` yields elsewhere. A single number goes one of
    /// the two ways only; of several side by side both are computed, and neither may have effects.
    fn either<T: Choice<Self>>(self, yes: impl FnOnce() -> T, no: impl FnOnce() -> T) -> T {
        T::select(self, yes(), no())
    }
}

impl Mask for bool {
    #[inline(always)]
    fn of(yes: bool) -> Self {
        yes
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }

    #[inline(always)]
    fn not(self) -> Self {
        !self
    }

    #[inline(always)]
    fn all(self) -> bool {
        self
    }

    #[inline(always)]
    fn either<T: Choice<Self>>(self, yes: impl FnOnce() -> T, no: impl FnOnce() -> T) -> T {
        if self { yes() } else { no() }
    }
}

/// What a mask can choose from.
pub trait Choice<M> {
    /// `yes` where the mask holds, `no` elsewhere.
    #[must_use]
    fn select(mask: M, yes: Self, no: Self) -> Self;
}

impl<S: Real> Choice<S::Mask> for S {
    #[inline(always)]
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        S::choose(mask, yes, no)
    }
}

/// Number by number.
impl<S: Real, const N: usize> Choice<S::Mask> for [S; N] {
    #[inline(always)]
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        let mut chosen = no;
        for (chosen, yes) in chosen.iter_mut().zip(yes) {
            *chosen = S::choose(mask, yes, *chosen);
        }
        chosen
    }
}
