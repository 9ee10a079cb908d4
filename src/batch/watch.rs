//! Whether numbers are finite, block by block, while they are in the cache.

use core::ops::Range;
use std::vec::Vec;

use super::columns::{Columns, Named};
use crate::composed::Spec;
use crate::graph::all_finite;

/// Looks at the columns that a model reads as it reads them.
pub struct Watch<'a> {
    columns: Vec<&'a [f64]>,
    /// The temperature, and the one at which the law is singular.
    pole: Option<(&'a [f64], f64)>,
    finite: bool,
    below: bool,
    above: bool,
}

impl<'a> Watch<'a> {
    /// Over the columns that the model reads.
    pub fn new(spec: &Spec, given: &Columns<'a>, read: &Named<'a>) -> Self {
        Self {
            columns: read.iter().map(|&(_, column)| column).collect(),
            pole: given.channels.temperature.zip(spec.pole()),
            finite: true,
            below: false,
            above: false,
        }
    }

    /// Looks at some samples.
    #[inline(always)]
    pub fn look(&mut self, rows: &Range<usize>) {
        for column in &self.columns {
            self.finite &= all_finite(&column[rows.clone()]);
        }
        if let Some((temperature, pole)) = self.pole {
            for &t in &temperature[rows.clone()] {
                self.below |= t <= pole;
                self.above |= t >= pole;
            }
        }
    }

    /// Whether the model can be evaluated at all samples seen.
    pub fn passed(&self) -> bool {
        self.finite && !(self.below && self.above)
    }
}
