//! Models over whole recordings: torque, gradient, parts of the torque.

mod balance;
#[cfg(feature = "identify")]
mod blocks;
mod by_temperature;
mod columns;
mod compiled;
mod delay;
mod error;
mod normal;
mod samples;
mod watch;

#[cfg(feature = "identify")]
pub(crate) use blocks::blocks;
pub use columns::{Channels, Columns, TimeStep};
pub use error::BatchError;
pub use normal::{NormalEquations, normal_equations};

use std::vec;
use std::vec::Vec;

use crate::catalog::EffectId;
use crate::composed::Spec;
use balance::Balance;
use columns::Rows;
use compiled::Compiled;
use delay::Delay;
use watch::Watch;

/// The friction torque of every sample (T); for a model with memory at the end of the sample's
/// step.
///
/// # Errors
/// Columns that are missing, of unequal length or not finite; inadmissible parameters.
pub fn torque(spec: &Spec, values: &[f64], columns: &Columns<'_>) -> Result<Vec<f64>, BatchError> {
    let mut torque = vec![0.0; columns.channels.velocity.len()];
    torque_into(spec, values, columns, &mut torque)?;
    Ok(torque)
}

/// Like [`torque`], into memory that the caller keeps, one number per sample: fresh memory takes
/// longer than many a law. After an error its content is unspecified.
///
/// # Errors
/// As for [`torque`]; `out` of another length.
pub fn torque_into(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    out: &mut [f64],
) -> Result<(), BatchError> {
    torque_and_range(spec, values, columns, out).map(|_| ())
}

/// Like [`torque_into`]; whether all results are finite.
pub(crate) fn torque_and_range(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    out: &mut [f64],
) -> Result<bool, BatchError> {
    let outputs = Outputs { torque: &mut *out, slopes: &mut [] };
    if !spec.with(values)?.runs_side_by_side() {
        samples::each::<f64>(spec, values, columns, &[], Locked::Refused, outputs)?;
    } else if columns.stand_alone(spec) {
        return in_one_pass(spec, values, columns, &[], outputs);
    } else {
        side_by_side(spec, values, columns, &[], Locked::Refused, outputs)?;
    }
    Ok(columns::finite(out))
}

/// Like [`torque`], in single precision throughout, as a controller without `f64` computes it. A
/// delay, which no controller has, is applied in double precision.
///
/// # Errors
/// As for [`torque`].
pub fn torque_single(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
) -> Result<Vec<f64>, BatchError> {
    let mut torque = vec![0.0; columns.channels.velocity.len()];
    torque_single_into(spec, values, columns, &mut torque)?;
    Ok(torque)
}

/// Like [`torque_single`], into memory that the caller keeps, as in [`torque_into`].
///
/// # Errors
/// As for [`torque_into`].
pub fn torque_single_into(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    out: &mut [f64],
) -> Result<(), BatchError> {
    torque_single_and_range(spec, values, columns, out).map(|_| ())
}

/// Like [`torque_single_into`]; whether all results are finite.
pub(crate) fn torque_single_and_range(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    out: &mut [f64],
) -> Result<bool, BatchError> {
    let outputs = Outputs { torque: &mut *out, slopes: &mut [] };
    samples::each::<f32>(spec, values, columns, &[], Locked::Refused, outputs)?;
    Ok(columns::finite(out))
}

/// The friction torque of every sample, and its derivatives with respect to the `wanted` parameters
/// (indices into `values`, by default all) in that order, row-major.
///
/// # Errors
/// As for [`torque`]; an index in `wanted` that does not exist or occurs twice.
pub fn gradient(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: Option<&[usize]>,
) -> Result<(Vec<f64>, Vec<f64>), BatchError> {
    let all: Vec<usize>;
    let wanted = match wanted {
        Some(wanted) => wanted,
        None => {
            all = (0..values.len()).collect();
            &all
        }
    };
    let rows = columns.channels.velocity.len();
    let (mut torque, mut slopes) = (vec![0.0; rows], vec![0.0; rows * wanted.len()]);
    gradient_into(spec, values, columns, wanted, &mut torque, &mut slopes)?;
    Ok((torque, slopes))
}

/// Like [`gradient`], into memory that the caller keeps: one number per sample, and one per sample
/// and wanted derivative. After an error its content is unspecified.
///
/// # Errors
/// As for [`gradient`]; `torque` or `slopes` of another length.
pub fn gradient_into(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    torque: &mut [f64],
    slopes: &mut [f64],
) -> Result<(), BatchError> {
    gradient_and_range(spec, values, columns, wanted, torque, slopes).map(|_| ())
}

/// Like [`gradient_into`]; whether all derivatives are finite.
pub(crate) fn gradient_and_range(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    torque: &mut [f64],
    slopes: &mut [f64],
) -> Result<bool, BatchError> {
    check_wanted(values, wanted)?;
    let out = Outputs { torque: &mut *torque, slopes: &mut *slopes };
    if !spec.with(values)?.runs_side_by_side() {
        samples::in_passes(spec, values, columns, wanted, torque, slopes)?;
        by_temperature::settle_slopes(spec, values, columns, wanted, slopes)?;
    } else if columns.stand_alone(spec) {
        return in_one_pass(spec, values, columns, wanted, out);
    } else {
        side_by_side(spec, values, columns, wanted, Locked::Amplified, out)?;
    }
    Ok(columns::finite(slopes))
}

fn check_wanted(values: &[f64], wanted: &[usize]) -> Result<(), BatchError> {
    for (k, &index) in wanted.iter().enumerate() {
        if index >= values.len() {
            return Err(BatchError::Wanted { index, parameters: values.len() });
        }
        if wanted[..k].contains(&index) {
            return Err(BatchError::WantedTwice(index));
        }
    }
    Ok(())
}

/// Dry magnitude, rate-dependent part and additive part of every sample (T), in steady sliding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SplitColumns {
    /// Dry magnitude `D`.
    pub dry: Vec<f64>,
    /// Rate-dependent part.
    pub rate: Vec<f64>,
    /// Additive part.
    pub additive: Vec<f64>,
}

/// The parts of the torque; a delay has no influence on them.
///
/// # Errors
/// As for [`torque`].
pub fn split(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
) -> Result<SplitColumns, BatchError> {
    let model = spec.with(values)?;
    columns.check(spec)?;
    let mut parts = SplitColumns::default();
    let balance = Balance::of(spec, values, columns)?;
    let channels = balance.as_ref().map_or(*columns, |b| b.complete(columns)).channels;
    for i in 0..channels.velocity.len() {
        let split = model.split(&channels.sample(i));
        parts.dry.push(split.dry());
        parts.rate.push(split.rate);
        parts.additive.push(split.additive);
    }
    Ok(parts)
}

/// The place of the first parameter of an effect, if the model has the effect.
fn first_parameter(spec: &Spec, effect: EffectId) -> Option<usize> {
    let name = effect.info().parameters.first()?.name;
    let present = spec.effects().contains(effect);
    spec.parameters().position(|parameter| present && parameter.name == name)
}

/// Treatment of samples at which no motor torque moves the joint.
#[derive(Clone, Copy, PartialEq)]
enum Locked {
    /// An error.
    Refused,
    /// An amplified torque, so that a search can continue.
    Amplified,
}

/// Where results go: the torque of each sample, and derivatives row-major.
struct Outputs<'a> {
    torque: &'a mut [f64],
    slopes: &'a mut [f64],
}

fn check_length(out: &[f64], rows: usize) -> Result<(), BatchError> {
    let length = out.len();
    let error = BatchError::Output { length, expected: rows };
    if length == rows { Ok(()) } else { Err(error) }
}

/// Evaluates blocks of samples in parallel, operation by operation, of a model that needs no more
/// than the columns of each sample. The columns are checked as they are read. Returns whether the
/// results, the derivatives if any are wanted, are finite.
fn in_one_pass(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    mut out: Outputs<'_>,
) -> Result<bool, BatchError> {
    let (rows, read) = columns.unchecked_rows(spec)?;
    check_length(out.torque, rows.count())?;
    check_length(out.slopes, rows.count() * wanted.len())?;
    let compiled = Compiled::of(spec, wanted, &rows, columns);
    let mut watch = Watch::new(spec, columns, &read);
    let finite = compiled.run(
        values,
        &rows,
        columns,
        &mut out,
        #[inline(always)]
        |block| watch.look(block),
    );
    if !watch.passed() {
        columns.check_values(spec, &read)?;
    }
    Ok(finite)
}

/// Evaluates blocks of samples in parallel, operation by operation.
fn side_by_side(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    locked: Locked,
    out: Outputs<'_>,
) -> Result<(), BatchError> {
    measured(spec, values, columns, wanted, locked, out, |rows, columns, out| {
        Compiled::of(spec, wanted, rows, columns).run(values, rows, columns, out, |_| ());
    })
}

/// The measured torque for the torque that `run` writes: with loads from the balance of torques,
/// and with the delay.
fn measured(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    locked: Locked,
    out: Outputs<'_>,
    run: impl Fn(&Rows, &Columns<'_>, &mut Outputs<'_>),
) -> Result<(), BatchError> {
    let rows = columns.rows(spec)?;
    let width = wanted.len();
    check_length(out.torque, rows.count())?;
    check_length(out.slopes, rows.count() * width)?;
    let balanced = |columns: &Columns<'_>, mut out: Outputs<'_>| -> Result<(), BatchError> {
        let Some(balance) = Balance::of(spec, values, columns)? else {
            run(&rows, columns, &mut out);
            return Ok(());
        };
        let columns = balance.complete(columns);
        run(&rows, &columns, &mut out);
        if locked == Locked::Refused {
            balance.refuse_locked()?;
        }
        balance.settle(out.torque);
        balance.settle_slopes(spec, &columns.channels, wanted, out.slopes);
        Ok(())
    };
    let Outputs { torque, slopes } = out;
    balanced(columns, Outputs { torque: &mut *torque, slopes: &mut *slopes })?;
    let Some(delay) = Delay::of(spec, values, wanted) else { return Ok(()) };
    let mut shifted = vec![0.0; torque.len()];
    let mut shifted_slopes = vec![0.0; slopes.len()];
    let both = Outputs { torque: &mut shifted, slopes: &mut shifted_slopes };
    balanced(&columns.smoothed(), both)?;
    let shift = delay.shift(&rows, columns, &mut shifted);
    shift.add_each(&shifted, 1, torque);
    if width > 0 {
        shift.add_each(&shifted_slopes, width, slopes);
    }
    if let Some(own) = delay.own {
        for (row, slope) in slopes.chunks_exact_mut(width).zip(shift.by_delay) {
            row[own] = slope;
        }
    }
    Ok(())
}
