use core::fmt::Debug;

/// Yes or no, once for each of several numbers that are compared side by side.
pub trait Mask: Copy + Debug {
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
}

impl Mask for bool {
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
}
