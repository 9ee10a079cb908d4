//! The outputs of a graph for a block of samples.

#[cfg(feature = "identify")]
use core::ops::Range;

/// The values of one output: one per sample, or one for all.
#[derive(Clone, Copy, Debug)]
pub enum Numbers<'a> {
    /// One number for all samples.
    Same(f64),
    /// One number per sample.
    Each(&'a [f64]),
}

impl Numbers<'_> {
    /// The values at some samples.
    #[cfg(feature = "identify")]
    #[inline(always)]
    #[must_use]
    pub fn part(&self, rows: &Range<usize>) -> Self {
        match *self {
            Self::Same(x) => Self::Same(x),
            Self::Each(all) => Self::Each(&all[rows.clone()]),
        }
    }

    /// Writes the products with `factor`.
    #[cfg(feature = "identify")]
    #[inline(always)]
    pub fn times(&self, factor: f64, out: &mut [f64]) {
        match self {
            Self::Same(x) => out.fill(x * factor),
            Self::Each(rows) => {
                out.iter_mut().zip(*rows).for_each(|(out, x)| *out = x * factor);
            }
        }
    }

    /// Writes `others` minus these numbers.
    #[cfg(feature = "identify")]
    #[inline(always)]
    pub fn subtracted_from(&self, others: &[f64], out: &mut [f64]) {
        let others = out.iter_mut().zip(others);
        match self {
            Self::Same(x) => others.for_each(|(out, other)| *out = other - x),
            Self::Each(rows) => {
                others.zip(*rows).for_each(|((out, other), x)| *out = other - x);
            }
        }
    }

    /// Whether all of them are finite.
    #[inline(always)]
    #[must_use]
    pub fn are_finite(&self) -> bool {
        match self {
            Self::Same(x) => x.is_finite(),
            Self::Each(rows) => all_finite(rows),
        }
    }

    /// Writes the values; whether all of them are finite.
    #[inline(always)]
    pub fn copy_to(&self, out: &mut [f64]) -> bool {
        match self {
            Self::Same(x) => {
                out.fill(*x);
                x.is_finite()
            }
            Self::Each(rows) => {
                let mut beyond = 0;
                for (out, &x) in out.iter_mut().zip(*rows) {
                    *out = x;
                    beyond |= beyond_range(x);
                }
                beyond >> 63 == 0
            }
        }
    }

    /// Writes `number` plus each value.
    #[inline(always)]
    pub fn add_to_each<'o>(&self, number: f64, out: impl Iterator<Item = &'o mut f64>) {
        match self {
            Self::Same(x) => out.for_each(|out| *out = x + number),
            Self::Each(rows) => out.zip(*rows).for_each(|(out, x)| *out = x + number),
        }
    }
}

/// Whether all numbers are finite. No early exit, so that the loop vectorises.
#[inline(always)]
pub fn all_finite(values: &[f64]) -> bool {
    values.iter().fold(0, |any, &x| any | beyond_range(x)) >> 63 == 0
}

/// The highest bit is set if `x` is infinite or NaN. Bits of several numbers are joined faster than
/// results of comparisons.
#[inline(always)]
const fn beyond_range(x: f64) -> u64 {
    const EXPONENT: u64 = f64::INFINITY.to_bits();
    (x.to_bits() & EXPONENT) + (1 << 52)
}
