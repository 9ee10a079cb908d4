//! Python interface: recorded channels differenced, smoothed, and learned by trees.

use std::vec::Vec;

use numpy::{AllowTypeChange, IntoPyArray, PyArray1, PyArray2, PyArrayLike2};
use pyo3::prelude::*;

use super::columns::{Array, contiguous};
use super::normal::row_by_row;
use super::{ModelError, refuse};
use crate::identify::{
    Forest, LowPass, Resonance, divided_differences as scaled_differences, first_order as followed,
};

type Matrix<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;

/// Divided differences of `order` 2 to 5 of the `values` [m] at `times` [m], scaled so that white
/// noise keeps its standard deviation, array `[k]`; without those of constant stretches.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn divided_differences<'py>(
    py: Python<'py>,
    times: Array<'py>,
    values: Array<'py>,
    order: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (times, values) = (contiguous(&times), contiguous(&values));
    let found = py
        .detach(|| scaled_differences(&times, &values, order))
        .ok_or_else(|| ModelError::new_err("the order of a difference is 2 to 5"))?;
    Ok(found.into_pyarray(py))
}

/// Each row of `signals` `[k, n]` filtered without phase, array `[k, n]`; `cutoff` is a share of the
/// sampling rate.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn low_pass<'py>(
    py: Python<'py>,
    signals: Matrix<'py>,
    cutoff: f64,
    padding: usize,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let filter = LowPass::new(cutoff).ok_or_else(|| {
        ModelError::new_err("the cut-off must be above zero and below half the sampling rate")
    })?;
    let mut filtered = signals.as_array().as_standard_layout().into_owned();
    py.detach(|| {
        for mut signal in filtered.rows_mut() {
            if let Some(values) = signal.as_slice_mut() {
                filter.zero_phase(values, padding);
            }
        }
    });
    Ok(filtered.into_pyarray(py))
}

/// Second derivative of the torque of a spring on which the load resonates, array [n].
///
/// `steps` [n] are the times since the sample before (s), `load` [n] is the load torque of a rigid
/// drive train, `hardening` the torque at which the spring carries twice that of a linear one.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn spring_torque_curvature<'py>(
    py: Python<'py>,
    steps: Array<'py>,
    load: Array<'py>,
    period: f64,
    damping: f64,
    hardening: Option<f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let resonance = Resonance::new(period, damping, hardening).ok_or_else(|| {
        ModelError::new_err(
            "the period of a resonance and the torque at which its spring hardens must be above \
             zero, its damping between zero and one",
        )
    })?;
    let (steps, load) = (contiguous(&steps), contiguous(&load));
    Ok(py.detach(|| resonance.curvature(&steps, &load)).into_pyarray(py))
}

/// `values` [n] behind a first-order lag (s), array [n]; `steps` [n] are the times since the sample
/// before (s).
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn first_order<'py>(
    py: Python<'py>,
    steps: Array<'py>,
    values: Array<'py>,
    lag: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (steps, values) = (contiguous(&steps), contiguous(&values));
    let late = py
        .detach(|| followed(&steps, &values, lag))
        .ok_or_else(|| ModelError::new_err("a lag must be above zero"))?;
    Ok(late.into_pyarray(py))
}

/// What `trees` extremely randomised trees predict for the rows of `unseen` `[k, n]`, array `[k]`,
/// after learning `values` `[m]` from the rows of `features` `[m, n]`.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn learn<'py>(
    py: Python<'py>,
    features: Matrix<'py>,
    values: Array<'py>,
    unseen: Matrix<'py>,
    trees: usize,
    fewest_in_leaf: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (features, unseen) = (features.as_array(), unseen.as_array());
    let (learned, predicted) = (row_by_row(&features), row_by_row(&unseen));
    let values = contiguous(&values);
    let (own, others) = (features.ncols(), unseen.ncols());
    let made: Vec<f64> = py
        .detach(|| {
            Forest::new(&learned, own, &values, trees, fewest_in_leaf)?.predict(&predicted, others)
        })
        .map_err(refuse)?;
    Ok(made.into_pyarray(py))
}
