//! Torque and derivatives block by block, for a consumer that keeps none of them.

use core::ops::Range;
use std::vec;
use std::vec::Vec;

use super::columns::Columns;
use super::compiled::Compiled;
use super::delay::Delay;
use super::watch::Watch;
use super::{BatchError, check_wanted, gradient};
use crate::composed::Spec;
use crate::graph::Numbers;

/// Samples per block passed to a sink.
const BLOCK_LENGTH: usize = 256;

/// Like [`gradient`], block by block: `sink` receives the torque and each derivative of a block of
/// samples, and none of them is kept.
///
/// # Errors
/// As for [`gradient`].
pub(crate) fn blocks(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    mut sink: impl FnMut(Range<usize>, &[Numbers<'_>]),
) -> Result<(), BatchError> {
    check_wanted(values, wanted)?;
    if columns.is_balanced(spec) || !spec.with(values)?.runs_side_by_side() {
        return from_gradient(spec, values, columns, wanted, sink);
    }
    if let Some(delay) = Delay::of(spec, values, wanted) {
        return delayed(spec, values, columns, wanted, &delay, sink);
    }
    let (rows, read) = columns.unchecked_rows(spec)?;
    let compiled = Compiled::of(spec, wanted, &rows, columns);
    let mut watch = Watch::new(spec, columns, &read);
    compiled.each_block(
        values,
        &rows,
        columns,
        #[inline(always)]
        |block, outputs| {
            watch.look(&block);
            sink(block, outputs);
        },
    );
    if watch.passed() { Ok(()) } else { columns.check_values(spec, &read) }
}

/// Blocks of a model that is not compiled.
fn from_gradient(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    mut sink: impl FnMut(Range<usize>, &[Numbers<'_>]),
) -> Result<(), BatchError> {
    let (torque, slopes) = gradient(spec, values, columns, Some(wanted))?;
    let width = wanted.len();
    let mut turned = vec![vec![0.0; BLOCK_LENGTH]; width];
    for (block, torque) in torque.chunks(BLOCK_LENGTH).enumerate() {
        let rows = block * BLOCK_LENGTH..block * BLOCK_LENGTH + torque.len();
        for (k, column) in turned.iter_mut().enumerate() {
            let slopes = slopes[rows.start * width..].iter().skip(k).step_by(width);
            column.iter_mut().zip(slopes).for_each(|(x, &slope)| *x = slope);
        }
        let mut outputs = vec![Numbers::Each(torque)];
        outputs.extend(turned.iter().map(|column| Numbers::Each(&column[..torque.len()])));
        sink(rows, &outputs);
    }
    Ok(())
}

/// Blocks of a model with a delay.
fn delayed(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    delay: &Delay,
    mut sink: impl FnMut(Range<usize>, &[Numbers<'_>]),
) -> Result<(), BatchError> {
    let rows = columns.rows(spec)?;
    let count = rows.count();
    let compiled = Compiled::of(spec, wanted, &rows, columns);
    // Column by column: the torque, then its derivatives.
    let mut smooth = vec![0.0; (wanted.len() + 1) * count];
    compiled.each_block(
        values,
        &rows,
        &columns.smoothed(),
        #[inline(always)]
        |block, outputs| {
            for (column, numbers) in smooth.chunks_exact_mut(count).zip(outputs) {
                numbers.copy_to(&mut column[block.clone()]);
            }
        },
    );
    let shift = delay.shift(&rows, columns, &mut smooth[..count]);
    let mut shifted = vec![[0.0; BLOCK_LENGTH]; wanted.len() + 1];
    compiled.each_block(
        values,
        &rows,
        columns,
        #[inline(always)]
        |block, outputs| {
            let parallel = shift.parallel(&block);
            let all = shifted.iter_mut().zip(outputs).zip(smooth.chunks_exact(count));
            for ((out, numbers), column) in all {
                let out = &mut out[..block.len()];
                numbers.copy_to(out);
                shift.add(&block, parallel, column, out);
            }
            if let Some(own) = delay.own {
                shifted[own + 1][..block.len()].copy_from_slice(&shift.by_delay[block.clone()]);
            }
            let numbers: Vec<_> =
                shifted.iter().map(|column| Numbers::Each(&column[..block.len()])).collect();
            sink(block, &numbers);
        },
    );
    Ok(())
}
