use numpy::ndarray::{Array2, Array3};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use super::{ModelError, refuse};
use crate::identify::NormalSums;

type Sums<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

/// `J'J` [groups, p, p], `J'r` [groups, p] and `r'r` [groups] of each group of rows.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn normal_equations<'py>(
    py: Python<'py>,
    jacobian: PyReadonlyArray2<'py, f64>,
    residual: PyReadonlyArray1<'py, f64>,
    group: PyReadonlyArray1<'py, u32>,
    groups: usize,
) -> PyResult<Sums<'py>> {
    let p = jacobian.shape()[1];
    let contiguous = |_| ModelError::new_err("the Jacobian must be contiguous, row by row");
    let (j, r, g) = (
        jacobian.as_slice().map_err(contiguous)?,
        residual.as_slice().map_err(contiguous)?,
        group.as_slice().map_err(contiguous)?,
    );
    let NormalSums { matrix, vector, square } =
        py.detach(|| crate::identify::normal_equations(j, p, r, g, groups)).map_err(refuse)?;
    let shaped = |error: numpy::ndarray::ShapeError| ModelError::new_err(error.to_string());
    Ok((
        Array3::from_shape_vec((groups, p, p), matrix).map_err(shaped)?.into_pyarray(py),
        Array2::from_shape_vec((groups, p), vector).map_err(shaped)?.into_pyarray(py),
        square.into_pyarray(py),
    ))
}
