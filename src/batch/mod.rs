//! Whole recordings: a model over columns, its gradient, its parts.

mod columns;
mod delay;
mod error;
mod normal;

pub use columns::{Channels, Columns, TimeStep};
pub use error::BatchError;
pub use normal::{NormalEquations, normal_equations};

use std::vec;
use std::vec::Vec;

use crate::bristle::BristleState;
use crate::composed::{Composed, Spec};
use crate::scalar::{Dual, Real};
use columns::Rows;

/// The most parameters a gradient can be taken by.
pub const MAX_PARAMETERS: usize = 32;

/// The friction torque of every row (T): of a model with a bristle, at the end of the row's step.
///
/// # Errors
/// Columns that are missing, of unequal length or not finite; parameters that cannot be used.
pub fn torque(spec: &Spec, values: &[f64], columns: &Columns<'_>) -> Result<Vec<f64>, BatchError> {
    let model = spec.with(values)?;
    let rows = columns.rows(spec)?;
    let run = |channels: Channels<'_>| {
        let mut torque = Vec::with_capacity(rows.count());
        evaluate(&model, &rows, channels, columns, |t: &f64| torque.push(*t));
        torque
    };
    let mut torque = run(columns.channels);
    if let Some(delay) = &model.effects().delay {
        let mut series = run(columns.smoothed());
        columns.add_load(&mut series);
        delay::shift(&rows, delay.delay, &series, 1, &mut torque);
    }
    Ok(torque)
}

/// The friction torque of every row, and its derivatives by the `wanted` parameters (indices into
/// `values`, by default all of them) in that order, row by row.
///
/// # Errors
/// As [`torque`]; more than [`MAX_PARAMETERS`] derivatives, one that does not exist or is wanted
/// twice.
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
    match wanted.len() {
        0 => gradient_along::<0>(spec, values, columns, wanted),
        1 => gradient_along::<1>(spec, values, columns, wanted),
        2 => gradient_along::<2>(spec, values, columns, wanted),
        3..=4 => gradient_along::<4>(spec, values, columns, wanted),
        5..=6 => gradient_along::<6>(spec, values, columns, wanted),
        7..=8 => gradient_along::<8>(spec, values, columns, wanted),
        9..=12 => gradient_along::<12>(spec, values, columns, wanted),
        13..=16 => gradient_along::<16>(spec, values, columns, wanted),
        17..=20 => gradient_along::<20>(spec, values, columns, wanted),
        21..=24 => gradient_along::<24>(spec, values, columns, wanted),
        25..=MAX_PARAMETERS => gradient_along::<MAX_PARAMETERS>(spec, values, columns, wanted),
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
fn evaluate<S: Real<Plain = f64>>(
    model: &Composed<S>,
    rows: &Rows,
    channels: Channels<'_>,
    columns: &Columns<'_>,
    mut sink: impl FnMut(&S),
) {
    let Some(bristle) = model.bristle() else {
        for i in 0..rows.count() {
            sink(&model.static_torque(&channels.sample(i)));
        }
        return;
    };
    let fresh = BristleState { z: S::from_f64(columns.state) };
    let mut state = fresh;
    let carried = columns.mean_velocity.unwrap_or(channels.velocity);
    for (i, (&dt, &carried)) in rows.steps.iter().zip(carried).enumerate() {
        if rows.starts_at(i) {
            state = fresh;
        }
        let split = model.split(&channels.sample(i));
        sink(&bristle.step_to(&mut state, &split, carried, dt));
    }
}

fn gradient_along<const N: usize>(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
) -> Result<(Vec<f64>, Vec<f64>), BatchError> {
    let mut variables: Vec<_> = values.iter().map(|&x| Dual::<f64, N>::constant(x)).collect();
    for (direction, &index) in wanted.iter().enumerate() {
        match variables.get_mut(index) {
            _ if wanted[..direction].contains(&index) => {
                return Err(BatchError::WantedTwice(index));
            }
            Some(variable) => *variable = Dual::variable(variable.value, direction),
            None => return Err(BatchError::Wanted { index, parameters: values.len() }),
        }
    }
    let model = spec.with(&variables)?;
    let rows = columns.rows(spec)?;
    let width = wanted.len();
    let run = |channels: Channels<'_>| {
        let mut torque = Vec::with_capacity(rows.count());
        let mut jacobian = vec![0.0; rows.count() * width];
        let mut slopes = jacobian.chunks_exact_mut(width.max(1));
        evaluate(&model, &rows, channels, columns, |t: &Dual<f64, N>| {
            torque.push(t.value);
            for (slope, d) in slopes.next().into_iter().flatten().zip(&t.derivative) {
                // Turns -0 into 0: which of them it is depends on what else is wanted.
                *slope = d + 0.0;
            }
        });
        (torque, jacobian)
    };
    let (mut torque, mut jacobian) = run(columns.channels);
    if let Some(delay) = &model.effects().delay {
        let (mut shifted, slopes) = run(columns.smoothed());
        columns.add_load(&mut shifted);
        let tau = delay.delay.value;
        let by_delay = delay::shift(&rows, tau, &shifted, 1, &mut torque);
        if width > 0 {
            delay::shift(&rows, tau, &slopes, width, &mut jacobian);
        }
        let own = |&index: &usize| spec.parameters().nth(index).is_some_and(|p| p.name == "delay");
        if let Some(own) = wanted.iter().position(own) {
            for (row, slope) in jacobian.chunks_exact_mut(width).zip(by_delay) {
                row[own] = slope;
            }
        }
    }
    Ok((torque, jacobian))
}
