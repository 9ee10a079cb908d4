//! What a graph hands over of a block of rows.

use core::ops::Range;
use std::vec::Vec;

/// Numbers of a block: one a row, or the same for all.
#[derive(Clone, Copy, Debug)]
pub enum Numbers<'a> {
    /// The same.
    Same(f64),
    /// One a row.
    Each(&'a [f64]),
}

impl Numbers<'_> {
    /// Those of some rows.
    #[inline(always)]
    #[must_use]
    pub fn part(&self, rows: &Range<usize>) -> Self {
        match *self {
            Self::Same(x) => Self::Same(x),
            Self::Each(all) => Self::Each(&all[rows.clone()]),
        }
    }

    /// Products with a factor.
    #[inline(always)]
    pub fn times(&self, factor: f64, out: &mut [f64]) {
        match self {
            Self::Same(x) => out.fill(x * factor),
            Self::Each(rows) => {
                out.iter_mut().zip(*rows).for_each(|(out, x)| *out = x * factor);
            }
        }
    }

    /// Differences to other numbers.
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

    /// Appends those of that many rows.
    #[inline(always)]
    pub fn append_to(&self, out: &mut Vec<f64>, count: usize) {
        match self {
            Self::Same(x) => out.resize(out.len() + count, *x),
            Self::Each(rows) => out.extend_from_slice(rows),
        }
    }

    /// Puts sums with a number into places, one a row.
    #[inline(always)]
    pub fn add_to_each<'o>(&self, number: f64, out: impl Iterator<Item = &'o mut f64>) {
        match self {
            Self::Same(x) => out.for_each(|out| *out = x + number),
            Self::Each(rows) => out.zip(*rows).for_each(|(out, x)| *out = x + number),
        }
    }
}
