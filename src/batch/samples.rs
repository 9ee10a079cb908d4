//! Models sample by sample: those with a state that many samples cannot share, and single precision.

use std::vec;
use std::vec::Vec;

use super::columns::{Columns, Rows};
use super::error::BatchError;
use super::{Locked, Outputs, check_length, measured};
use crate::composed::{Composed, Spec};
use crate::dynamics::Interval;
use crate::graph::Beginning;
use crate::scalar::{Dual, Real, Scalar};

/// Number of derivatives per pass over the samples.
const MAX_DIRECTIONS: usize = 16;

/// Torque and derivatives sample by sample, a few derivatives at a time.
pub(super) fn in_passes(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    torque: &mut [f64],
    slopes: &mut [f64],
) -> Result<(), BatchError> {
    if wanted.len() <= MAX_DIRECTIONS {
        return in_one_pass(spec, values, columns, wanted, Outputs { torque, slopes });
    }
    check_length(slopes, columns.channels.velocity.len() * wanted.len())?;
    let mut part = vec![0.0; columns.channels.velocity.len() * MAX_DIRECTIONS];
    for (pass, some) in wanted.chunks(MAX_DIRECTIONS).enumerate() {
        let part = &mut part[..columns.channels.velocity.len() * some.len()];
        let out = Outputs { torque: &mut *torque, slopes: &mut *part };
        in_one_pass(spec, values, columns, some, out)?;
        let rows = slopes.chunks_exact_mut(wanted.len());
        for (row, part) in rows.zip(part.chunks_exact(some.len())) {
            row[pass * MAX_DIRECTIONS..][..some.len()].copy_from_slice(part);
        }
    }
    Ok(())
}

fn in_one_pass(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    out: Outputs<'_>,
) -> Result<(), BatchError> {
    let run = match wanted.len() {
        0 => each::<f64>,
        1..=4 => each::<Dual<f64, 4>>,
        5..=8 => each::<Dual<f64, 8>>,
        _ => each::<Dual<f64, MAX_DIRECTIONS>>,
    };
    run(spec, values, columns, wanted, Locked::Amplified, out)
}

/// A number type for evaluation sample by sample.
pub(super) trait Single: Scalar {
    /// A parameter, with a derivative of 1 in a direction if one is given.
    fn parameter(value: f64, direction: Option<usize>) -> Self;
    /// The derivatives.
    fn slopes(&self) -> &[f64];
}

macro_rules! without_derivatives {
    ($($float:ident),+) => {$(
        impl Single for $float {
            fn parameter(value: f64, _: Option<usize>) -> Self {
                Self::from_f64(value)
            }

            fn slopes(&self) -> &[f64] {
                &[]
            }
        }
    )+};
}

without_derivatives!(f32, f64);

impl<const N: usize> Single for Dual<f64, N> {
    fn parameter(value: f64, direction: Option<usize>) -> Self {
        direction.map_or_else(|| Self::constant(value), |index| Self::variable(value, index))
    }

    fn slopes(&self) -> &[f64] {
        &self.derivative
    }
}

/// Evaluates sample by sample; every segment starts from the initial state.
pub(super) fn each<S: Single>(
    spec: &Spec,
    values: &[f64],
    columns: &Columns<'_>,
    wanted: &[usize],
    locked: Locked,
    out: Outputs<'_>,
) -> Result<(), BatchError> {
    let direction = |index: usize| wanted.iter().position(|&own| own == index);
    let parameters: Vec<S> =
        values.iter().enumerate().map(|(i, &x)| S::parameter(x, direction(i))).collect();
    let model = spec.with(&parameters)?;
    let width = wanted.len();
    measured(spec, values, columns, wanted, locked, out, |rows, columns, out| {
        evaluate(&model, rows, columns, |row, t: &S| {
            out.torque[row] = t.value();
            // Turns -0 into 0: the sign of zero depends on the other derivatives requested.
            let slopes = &mut out.slopes[row * width..(row + 1) * width];
            slopes.iter_mut().zip(t.slopes()).for_each(|(slope, d)| *slope = d + 0.0);
        });
    })
}

fn evaluate<S: Scalar>(
    model: &Composed<S>,
    rows: &Rows,
    columns: &Columns<'_>,
    mut sink: impl FnMut(usize, &S),
) {
    let fresh = columns.start(model.memory());
    let mut state = fresh;
    let mut starts = rows.starts().iter().copied().peekable();
    for (i, &dt) in rows.steps().iter().enumerate() {
        let sample = columns.channels.sample(i);
        let beginning = starts.next_if(|&(row, _)| row == i).map(|(_, beginning)| beginning);
        match beginning {
            Some(Beginning::Settled) => state = model.settled(&sample),
            Some(Beginning::Fresh) => state = fresh,
            None => {}
        }
        let mean_velocity = columns.mean_velocity.and_then(|mean| mean.get(i));
        let interval = Interval {
            sample,
            mean_velocity: mean_velocity.map(|&v| S::Plain::from_f64(v)),
            dt: S::Plain::from_f64(dt),
            mean: false,
        };
        sink(i, &model.step_over(&mut state, &interval).torque);
    }
}
