//! Whole recordings: a model over columns, its gradient, its parts.

mod balance;
mod columns;
mod delay;
mod error;
mod normal;
mod triangle;

pub use columns::{Channels, Columns, TimeStep};
pub use error::BatchError;
pub use normal::{NormalEquations, normal_equations};
pub use triangle::{Triangle, triangle};

use std::vec;
use std::vec::Vec;

use crate::composed::{Composed, Spec};
use crate::dynamics::Interval;
use crate::scalar::{Dual, Real, Scalar};
use balance::Balance;
use columns::Rows;

/// Derivatives that are carried along in one pass over the rows.
const MOST_AT_ONCE: usize = 16;

/// The friction torque of every row (T): of a model with a memory, at the end of the row's step.
///
/// # Errors
/// Columns that are missing, of unequal length or not finite; parameters that cannot be used.
pub fn torque(spec: &Spec, values: &[f64], columns: &Columns<'_>) -> Result<Vec<f64>, BatchError> {
    torque_as::<f64>(spec, values, columns)
}

/// As [`torque`], computed in single precision throughout, as a controller without `f64` does. A
/// delay, which no controller has, is carried out in double precision.
///
/// # Errors
/// As [`torque`].
pub fn torque_single(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
) -> Result<Vec<f64>, BatchError> {
    torque_as::<f32>(spec, values, columns)
}

fn torque_as<S: Scalar<Plain = S>>(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
) -> Result<Vec<f64>, BatchError> {
    let numbers: Vec<S> = values.iter().map(|&x| S::from_f64(x)).collect();
    let model = spec.with(&numbers)?;
    let rows = columns.rows(spec)?;
    let run = |channels: Channels<'_>| -> Result<Vec<f64>, BatchError> {
        let balance = Balance::of(spec, values, columns, &channels)?;
        let channels = balance.as_ref().map_or(channels, |balance| balance.complete(channels));
        let mut torque = Vec::with_capacity(rows.count());
        evaluate(&model, &rows, channels, columns, |t: &S| torque.push(t.value()));
        if let Some(balance) = &balance {
            if let Some(row) = balance.locked() {
                return Err(BatchError::SelfLocking { row });
            }
            balance.settle(&mut torque);
        }
        Ok(torque)
    };
    let mut torque = run(columns.channels)?;
    if let Some(delay) = &model.effects().delay {
        let mut series = run(columns.smoothed())?;
        columns.add_load(&mut series);
        delay::shift(&rows, delay.delay.value(), &series, 1, &mut torque);
    }
    Ok(torque)
}

/// The friction torque of every row, and its derivatives by the `wanted` parameters (indices into
/// `values`, by default all of them) in that order, row by row.
///
/// # Errors
/// As [`torque`]; a derivative that does not exist or is wanted twice.
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
    for (k, &index) in wanted.iter().enumerate() {
        if wanted[..k].contains(&index) {
            return Err(BatchError::WantedTwice(index));
        }
    }
    if wanted.len() <= MOST_AT_ONCE {
        return gradient_at_once(spec, values, columns, wanted);
    }
    let mut torque = Vec::new();
    let mut jacobian = vec![0.0; columns.channels.velocity.len() * wanted.len()];
    for (pass, some) in wanted.chunks(MOST_AT_ONCE).enumerate() {
        let (same, part) = gradient_at_once(spec, values, columns, some)?;
        torque = same;
        let rows = jacobian.chunks_exact_mut(wanted.len());
        for (row, part) in rows.zip(part.chunks_exact(some.len())) {
            row[pass * MOST_AT_ONCE..][..some.len()].copy_from_slice(part);
        }
    }
    Ok((torque, jacobian))
}

fn gradient_at_once(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
) -> Result<(Vec<f64>, Vec<f64>), BatchError> {
    match wanted.len() {
        0 => gradient_along::<0>(spec, values, columns, wanted),
        1 => gradient_along::<1>(spec, values, columns, wanted),
        2 => gradient_along::<2>(spec, values, columns, wanted),
        3..=4 => gradient_along::<4>(spec, values, columns, wanted),
        5..=8 => gradient_along::<8>(spec, values, columns, wanted),
        9..=12 => gradient_along::<12>(spec, values, columns, wanted),
        _ => gradient_along::<MOST_AT_ONCE>(spec, values, columns, wanted),
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
    let balance = Balance::of(spec, values, columns, &columns.channels)?;
    let channels = balance.as_ref().map_or(columns.channels, |b| b.complete(columns.channels));
    for i in 0..channels.velocity.len() {
        let split = model.split(&channels.sample(i));
        parts.dry.push(split.dry());
        parts.rate.push(split.rate);
        parts.additive.push(split.additive);
    }
    Ok(parts)
}

/// Runs a model over rows; the state starts afresh with every segment.
fn evaluate<S: Scalar>(
    model: &Composed<S>,
    rows: &Rows,
    channels: Channels<'_>,
    columns: &Columns<'_>,
    mut sink: impl FnMut(&S),
) {
    if !model.has_state() {
        for i in 0..rows.count() {
            sink(&model.static_torque(&channels.sample(i)));
        }
        return;
    }
    let fresh = columns.start(model.memory());
    let mut state = fresh;
    for (i, &dt) in rows.steps.iter().enumerate() {
        let sample = channels.sample(i);
        let starts = rows.starts_at(i);
        let settled = starts && rows.is_settled(i);
        if settled {
            state = model.settled(&sample);
        } else if starts {
            state = fresh;
        }
        let dt = if settled { 0.0 } else { dt };
        let mean_velocity = columns.mean_velocity.and_then(|mean| mean.get(i));
        let interval = Interval {
            sample,
            mean_velocity: mean_velocity.map(|&v| S::Plain::from_f64(v)),
            dt: S::Plain::from_f64(dt),
            mean: false,
        };
        sink(&model.over(&mut state, &interval).torque);
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
            Some(variable) => *variable = Dual::variable(variable.value, direction),
            None => return Err(BatchError::Wanted { index, parameters: values.len() }),
        }
    }
    let model = spec.with(&variables)?;
    let rows = columns.rows(spec)?;
    let width = wanted.len();
    let run = |channels: Channels<'_>| -> Result<_, BatchError> {
        let balance = Balance::of(spec, values, columns, &channels)?;
        let channels = balance.as_ref().map_or(channels, |balance| balance.complete(channels));
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
        if let Some(balance) = &balance {
            balance.settle(&mut torque);
            balance.settle_slopes(spec, &channels, wanted, &mut jacobian);
        }
        Ok((torque, jacobian))
    };
    let (mut torque, mut jacobian) = run(columns.channels)?;
    if let Some(delay) = &model.effects().delay {
        let (mut shifted, slopes) = run(columns.smoothed())?;
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
