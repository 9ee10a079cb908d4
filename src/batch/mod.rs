//! Whole recordings: a model over columns, its gradient, its parts.

mod columns;
mod delay;
mod error;
mod normal;

pub use columns::{Channels, Columns, TimeStep};
pub use error::BatchError;
pub use normal::{NormalEquations, normal_equations};

use std::vec::Vec;

use crate::bristle::BristleState;
use crate::composed::{Composed, Spec};
use crate::sample::Sample;
use crate::scalar::{Dual, Real};
use columns::Rows;

/// The most parameters a gradient can be taken for.
pub const MAX_PARAMETERS: usize = 32;

/// The friction torque of every row (T): of a model with a bristle, at the end of the row's step.
///
/// # Errors
/// Columns that are missing, of unequal length or not finite; parameters that cannot be used.
pub fn torque(spec: &Spec, values: &[f64], columns: &Columns<'_>) -> Result<Vec<f64>, BatchError> {
    let model = spec.with(values)?;
    let rows = columns.rows(spec)?;
    let mut torque = Vec::with_capacity(rows.count());
    evaluate(&model, &rows, columns.channels, columns.mean_velocity, columns.state, |t: f64| {
        torque.push(t)
    });
    if let Some(delay) = &model.effects().delay {
        let mut series = Vec::with_capacity(rows.count());
        evaluate(
            &model,
            &rows,
            columns.smoothed(),
            columns.mean_velocity,
            columns.state,
            |t: f64| series.push(t),
        );
        columns.add_load(&mut series);
        delay::shift(&rows, delay.delay, &series, 1, &mut torque);
    }
    Ok(torque)
}

/// The friction torque of every row, and its derivatives by every parameter, row by row.
///
/// # Errors
/// As [`torque`], and more than [`MAX_PARAMETERS`] parameters.
pub fn gradient(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
) -> Result<(Vec<f64>, Vec<f64>), BatchError> {
    match values.len() {
        0..=4 => gradient_along::<4>(spec, values, columns),
        5..=8 => gradient_along::<8>(spec, values, columns),
        9..=16 => gradient_along::<16>(spec, values, columns),
        17..=24 => gradient_along::<24>(spec, values, columns),
        25..=MAX_PARAMETERS => gradient_along::<32>(spec, values, columns),
        given => Err(BatchError::TooManyParameters(given)),
    }
}

/// Dry magnitude, rate part and additive part of every row (T), in steady sliding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SplitColumns {
    /// Dry magnitude `D`.
    pub dry: Vec<f64>,
    /// Rate-dependent part.
    pub rate: Vec<f64>,
    /// Additive part.
    pub additive: Vec<f64>,
}

/// The parts of the torque; a delay plays no role in them.
///
/// # Errors
/// As [`torque`].
pub fn split(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
) -> Result<SplitColumns, BatchError> {
    let model = spec.with(values)?;
    columns.check(spec)?;
    let mut parts = SplitColumns::default();
    for i in 0..columns.channels.velocity.len() {
        let split = model.split(&columns.channels.sample(i));
        parts.dry.push(split.dry());
        parts.rate.push(split.rate);
        parts.additive.push(split.additive);
    }
    Ok(parts)
}

/// Runs a model over rows; the state starts afresh with every segment.
fn evaluate<S: Real>(
    model: &Composed<S>,
    rows: &Rows,
    channels: Channels<'_>,
    mean_velocity: Option<&[f64]>,
    start: f64,
    mut sink: impl FnMut(S),
) {
    if model.bristle().is_none() {
        for i in 0..rows.count() {
            let sample: Sample<S> = channels.sample(i);
            sink(model.static_torque(&sample));
        }
        return;
    }
    let fresh = BristleState { z: S::from_f64(start) };
    let mut state = fresh;
    for (i, &dt) in rows.steps.iter().enumerate() {
        if rows.starts_at(i) {
            state = fresh;
        }
        let sample = channels.sample(i);
        let carried = match mean_velocity.and_then(|column| column.get(i)) {
            Some(&mean) => S::from_f64(mean),
            None => sample.velocity,
        };
        sink(model.step_over(&mut state, &sample, carried, S::from_f64(dt)).torque);
    }
}

fn gradient_along<const N: usize>(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
) -> Result<(Vec<f64>, Vec<f64>), BatchError> {
    let p = values.len();
    let mut variables = [Dual::<f64, N>::constant(0.0); N];
    for (i, (variable, &value)) in variables.iter_mut().zip(values).enumerate() {
        *variable = Dual::variable(value, i);
    }
    let model = spec.with(&variables[..p.min(N)])?;
    let rows = columns.rows(spec)?;
    let run = |channels: Channels<'_>| {
        let mut torque = Vec::with_capacity(rows.count());
        let mut jacobian = Vec::with_capacity(rows.count() * p);
        evaluate(
            &model,
            &rows,
            channels,
            columns.mean_velocity,
            columns.state,
            |t: Dual<f64, N>| {
                torque.push(t.value);
                jacobian.extend_from_slice(&t.derivative[..p]);
            },
        );
        (torque, jacobian)
    };
    let (mut torque, mut jacobian) = run(columns.channels);
    if let Some(delay) = &model.effects().delay {
        let (mut shifted, by_parameters) = run(columns.smoothed());
        columns.add_load(&mut shifted);
        let tau = delay.delay.value;
        let by_delay = delay::shift(&rows, tau, &shifted, 1, &mut torque);
        delay::shift(&rows, tau, &by_parameters, p, &mut jacobian);
        if let Some(own) = spec.parameters().position(|info| info.name == "delay") {
            for (row, slope) in jacobian.chunks_exact_mut(p).zip(by_delay) {
                row[own] = slope;
            }
        }
    }
    Ok((torque, jacobian))
}
