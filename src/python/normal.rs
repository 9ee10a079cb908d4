//! Python interface: normal equations.

use std::borrow::Cow;
use std::string::ToString;

use numpy::ndarray::{Array2, Array3, ArrayView2};
use numpy::{
    AllowTypeChange, IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayLike1, PyArrayLike2,
};
use pyo3::prelude::*;

use super::columns::{Array, contiguous};
use super::{ModelError, refuse};
use crate::batch::{self, NormalEquations};

type Sums<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

/// Sums of `J'J`, `J'r` and `r'r` over `groups` groups of samples, sample by sample.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn normal_equations<'py>(
    py: Python<'py>,
    jacobian: PyArrayLike2<'py, f64, AllowTypeChange>,
    residual: Array<'py>,
    group: PyArrayLike1<'py, u32, AllowTypeChange>,
    groups: usize,
) -> PyResult<Sums<'py>> {
    let jacobian = jacobian.as_array();
    let p = jacobian.ncols();
    let rows = row_by_row(&jacobian);
    let residual = contiguous(&residual);
    let group = group.as_array().to_vec();
    let sums = py
        .detach(|| batch::normal_equations(&rows, p, &residual, &group, groups))
        .map_err(refuse)?;
    let NormalEquations { matrix, vector, square } = sums;
    let matrix = Array3::from_shape_vec((groups, p, p), matrix).map_err(shape_error)?;
    let vector = Array2::from_shape_vec((groups, p), vector).map_err(shape_error)?;
    Ok((matrix.into_pyarray(py), vector.into_pyarray(py), square.into_pyarray(py)))
}

pub(super) fn row_by_row<'a>(matrix: &'a ArrayView2<'_, f64>) -> Cow<'a, [f64]> {
    match matrix.as_slice() {
        Some(slice) => Cow::Borrowed(slice),
        None => Cow::Owned(matrix.iter().copied().collect()),
    }
}

pub(super) fn shape_error(error: numpy::ndarray::ShapeError) -> PyErr {
    ModelError::new_err(error.to_string())
}
