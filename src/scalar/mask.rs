//! The result of comparing numbers: one `bool`, or one per lane.

use core::fmt::Debug;

use super::Real;

/// One boolean, or one per lane.
pub trait Mask: Copy + Debug {
    /// The same boolean in every lane.
    fn of(yes: bool) -> Self;
    /// Logical and.
    #[must_use]
    fn and(self, other: Self) -> Self;
    /// Logical or.
    #[must_use]
    fn or(self, other: Self) -> Self;
    /// Logical not.
    #[must_use]
    fn not(self) -> Self;
    /// Whether all lanes are true.
    fn all(self) -> bool;
    /// The result of `yes` where the mask is true, that of `no` elsewhere. A single number
    /// evaluates one of the two only; lanes evaluate both, so neither may have side effects.
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

/// A type that a mask can select between.
pub trait Choice<M> {
    /// `yes` where the mask is true, `no` elsewhere.
    #[must_use]
    fn select(mask: M, yes: Self, no: Self) -> Self;
}

impl<S: Real> Choice<S::Mask> for S {
    #[inline(always)]
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        S::choose(mask, yes, no)
    }
}

/// Element by element.
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
