//! A least-squares problem: a model and the measured torque of a recording in memory.

use core::ops::Range;
use std::borrow::Cow;
use std::vec;
use std::vec::Vec;

use super::separable::LeastSquares;
use super::threads::side_by_side;
use super::triangle::{Triangle, factored, joined};
use crate::batch::{self, BatchError, Columns, TimeStep};
use crate::catalog::EffectId;
use crate::composed::Spec;

/// The group of samples that are not scored. A state still runs through them.
pub const NOT_SCORED: u32 = u32::MAX;
/// Number of samples at the start of a run that decide how it begins.
const FIRST_ROWS: usize = 500;
/// Samples per piece, where samples are independent: pieces run in parallel.
const PIECE: usize = 1 << 16;

/// A model and a measured torque, over columns in memory.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The model.
    pub spec: &'a Spec,
    /// The columns of the recording.
    pub columns: Columns<'a>,
    /// The torque to fit: measured minus known torque (T).
    pub target: &'a [f64],
    /// The square root of the weight of each sample's squared error; `None`: all weights are 1.
    pub scale: Option<&'a [f64]>,
    /// The group of each sample, or [`NOT_SCORED`].
    pub group: &'a [u32],
    /// Number of groups.
    pub groups: usize,
    /// The first samples of runs that begin in motion, in increasing order.
    pub begins: &'a [usize],
    /// Whether each sample is moving; only these decide how a run begins.
    pub moving: &'a [bool],
    /// Norm of the measured torque (T).
    pub torque_norm: f64,
    /// Number of threads, used where samples are independent.
    pub threads: usize,
}

impl Problem<'_> {
    /// For each run that begins in motion, whether it begins in steady sliding or with a relaxed
    /// bristle.
    ///
    /// The recording does not say which: the one that fits the first samples better is assumed.
    ///
    /// # Errors
    /// As [`batch::torque`]; columns of other lengths.
    pub fn slides(&self, values: &[f64]) -> Result<Vec<bool>, BatchError> {
        self.check()?;
        let rows = self.target.len();
        let given = self.steps();
        let starts: Vec<usize> =
            (0..rows).filter(|&row| !passes(given[row])).chain([rows]).collect();
        let slides = |&begin: &usize| {
            let next = starts[starts.partition_point(|&start| start <= begin)];
            let first = begin..next.min(begin + FIRST_ROWS);
            let mut steps = given[first.clone()].to_vec();
            let mut misfit = |step| {
                steps[0] = step;
                let columns = Columns { dt: TimeStep::Each(&steps), ..self.columns.part(&first) };
                let torque = batch::torque(self.spec, values, &columns)?;
                let wrong = first.clone().zip(torque).filter(|&(row, _)| self.moving[row]);
                let square = |(row, torque)| {
                    let wrong: f64 = self.target[row] - torque;
                    wrong * wrong
                };
                Ok::<f64, BatchError>(wrong.map(square).sum())
            };
            let rested = misfit(0.0)?;
            Ok(misfit(f64::INFINITY)? < rested)
        };
        self.begins.iter().map(slides).collect()
    }

    /// The problem of each group, linearised at `values` with respect to the parameters `wanted`,
    /// whose columns are multiplied by `slope`; `None` where the model is not finite.
    ///
    /// # Errors
    /// As [`batch::gradient`]; columns of other lengths.
    pub fn triangles(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> Result<Option<Vec<Triangle>>, BatchError> {
        self.check()?;
        if self.spec.with(values).is_err() {
            return Ok(None);
        }
        let mut steps;
        let mut columns = self.columns;
        if !self.begins.is_empty() {
            steps = self.steps();
            for (&begin, slides) in self.begins.iter().zip(self.slides(values)?) {
                steps.to_mut()[begin] = if slides { f64::INFINITY } else { 0.0 };
            }
            columns.dt = TimeStep::Each(&steps);
        }
        let whole = Problem { columns, ..*self };
        let made = if self.has_independent_samples() && self.target.len() > PIECE {
            let rows = |piece: usize| piece * PIECE..((piece + 1) * PIECE).min(self.target.len());
            let pieces = self.target.len().div_ceil(PIECE);
            let parts = side_by_side(pieces, self.threads, |piece| {
                whole.part(&rows(piece)).factored(values, wanted, slope)
            })?;
            joined(wanted.len() + 1, self.groups, &parts)?
        } else {
            whole.factored(values, wanted, slope)?
        };
        Ok(made.iter().all(Triangle::is_finite).then_some(made))
    }

    /// Whether the torque of a sample depends on no other sample.
    fn has_independent_samples(&self) -> bool {
        !self.spec.has_state() && !self.spec.effects().contains(EffectId::Delay)
    }

    /// The problem of some samples, where samples are independent.
    fn part(&self, rows: &Range<usize>) -> Self {
        Self {
            columns: self.columns.part(rows),
            target: &self.target[rows.clone()],
            scale: self.scale.map(|scale| &scale[rows.clone()]),
            group: &self.group[rows.clone()],
            moving: &self.moving[rows.clone()],
            begins: &[],
            ..*self
        }
    }

    fn factored(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> Result<Vec<Triangle>, BatchError> {
        factored(wanted.len() + 1, self.groups, |into| {
            batch::blocks(self.spec, values, &self.columns, wanted, |block, outputs| {
                let own = &self.group[block.clone()];
                let mut from = 0;
                for alike in own.chunk_by(|x, y| x == y) {
                    let first = from;
                    from += alike.len();
                    into.push(alike[0], alike.len(), |column, taken, out| {
                        let rows = first + taken..first + taken + out.len();
                        match slope.get(column) {
                            Some(&slope) => outputs[column + 1].part(&rows).times(slope, out),
                            None => {
                                let target = &self.target[block.start..][rows.clone()];
                                outputs[0].part(&rows).subtracted_from(target, out);
                            }
                        }
                        if let Some(scale) = self.scale {
                            let own = &scale[block.start..][rows];
                            out.iter_mut().zip(own).for_each(|(x, scale)| *x *= scale);
                        }
                    });
                }
            })
        })
    }

    /// The time step of each sample.
    fn steps(&self) -> Cow<'_, [f64]> {
        match self.columns.dt {
            TimeStep::Each(steps) => Cow::Borrowed(steps),
            TimeStep::Uniform(dt) => Cow::Owned(vec![dt; self.target.len()]),
            TimeStep::Unknown => Cow::Owned(vec![0.0; self.target.len()]),
        }
    }

    fn check(&self) -> Result<(), BatchError> {
        let rows = self.columns.channels.velocity.len();
        let fit = |column, length| {
            if length == rows { Ok(()) } else { Err(BatchError::Length { column, length, rows }) }
        };
        fit("target", self.target.len())?;
        fit("group", self.group.len())?;
        fit("moving", self.moving.len())?;
        fit("scale", self.scale.map_or(rows, <[f64]>::len))?;
        if let TimeStep::Each(steps) = self.columns.dt {
            fit("dt", steps.len())?;
        }
        let beyond = |&&group: &&u32| group != NOT_SCORED && group as usize >= self.groups;
        if let Some(row) = self.group.iter().position(|group| beyond(&group)) {
            return Err(BatchError::Group { row, group: self.group[row], groups: self.groups });
        }
        match self.begins.iter().find(|&&begin| begin >= rows) {
            Some(&begin) => Err(BatchError::Begin { begin, rows }),
            None => Ok(()),
        }
    }
}

/// Whether time increases from the sample before; else a run begins.
fn passes(step: f64) -> bool {
    step > 0.0
}

impl LeastSquares for Problem<'_> {
    type Error = BatchError;

    fn triangle(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> Result<Option<Triangle>, BatchError> {
        Ok(self.triangles(values, wanted, slope)?.and_then(|mut all| all.pop()))
    }

    fn torque_norm(&self) -> Result<f64, BatchError> {
        Ok(self.torque_norm)
    }
}
