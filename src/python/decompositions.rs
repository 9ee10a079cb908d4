//! Python interface: decompositions of small dense matrices, by faer on the thread that calls.

use std::vec;
use std::vec::Vec;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::linalg::lu::partial_pivoting::solve::{solve_in_place, solve_in_place_scratch};
use faer::linalg::qr::col_pivoting::factor::{qr_in_place, qr_in_place_scratch};
use faer::{Mat, Par};
use numpy::ndarray::{Array2, ArrayView2};
use numpy::{AllowTypeChange, IntoPyArray, PyArray1, PyArray2, PyArrayLike2};
use pyo3::prelude::*;

use super::columns::{Array, contiguous};
use super::normal::row_by_row;
use super::{ModelError, refuse};
use crate::identify::{SingularValues, triangles};

type Matrix<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;
type Spectrum<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>);

/// The x of least norm that minimises `|A x - b|`, array `[n]`; directions with a singular value
/// below the share `unseen` of the largest do not count.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn least_squares<'py>(
    py: Python<'py>,
    matrix: Matrix<'py>,
    right: Array<'py>,
    unseen: f64,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let matrix = matrix.as_array();
    let right = contiguous(&right);
    let n = matrix.ncols();
    let rows = row_by_row(&matrix);
    let x = py.detach(|| {
        let together = vec![0; right.len()];
        let made = triangles(&rows, n, &right, &together, 1).map_err(refuse)?.remove(0);
        // A factor of fewer samples than columns has rounding errors in place of zeros.
        let found = if right.len() < n {
            let matrix = Mat::from_fn(right.len(), n, |row, k| rows[row * n + k]);
            SingularValues::of(matrix.as_ref()).map(|found| found.least_squares(&right, unseen))
        } else {
            let factor = Mat::from_fn(n, n, |row, k| made.row(row)[k]);
            let right: Vec<f64> = (0..n).map(|row| made.right(row)).collect();
            SingularValues::of(factor.as_ref()).map(|found| found.least_squares(&right, unseen))
        };
        found.ok_or_else(not_finite)
    })?;
    if x.iter().all(|x| x.is_finite()) { Ok(x.into_pyarray(py)) } else { Err(not_finite()) }
}

/// Singular values of a matrix `[m, n]` in decreasing order, array `[n]`, zero beyond the m-th, and
/// its right singular vectors, array `[n, n]`, one a row.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn singular<'py>(py: Python<'py>, matrix: Matrix<'py>) -> PyResult<Spectrum<'py>> {
    let matrix = matrix.as_array();
    let (m, n) = matrix.dim();
    let padded = Mat::from_fn(m.max(n), n, |row, k| if row < m { matrix[(row, k)] } else { 0.0 });
    let found = py.detach(|| SingularValues::of(padded.as_ref())).ok_or_else(not_finite)?;
    let vectors: Vec<f64> = found.directions().flatten().copied().collect();
    let vectors = Array2::from_shape_fn((n, n), |(row, k)| vectors[row * n + k]);
    Ok((found.values.into_pyarray(py), vectors.into_pyarray(py)))
}

/// Eigenvalues of a symmetric matrix `[n, n]` in increasing order, array `[n]`, and its
/// eigenvectors, array `[n, n]`, one a column. Only the lower triangle is read.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn symmetric_eigen<'py>(py: Python<'py>, matrix: Matrix<'py>) -> PyResult<Spectrum<'py>> {
    let matrix = square(&matrix.as_array())?;
    let n = matrix.nrows();
    let (mut values, mut vectors) = (Mat::<f64>::zeros(n, 1), Mat::<f64>::zeros(n, n));
    if n > 0 {
        let with = ComputeEigenvectors::Yes;
        let needed = self_adjoint_evd_scratch::<f64>(n, with, Par::Seq, Default::default());
        self_adjoint_evd(
            matrix.as_ref(),
            values.as_mut().col_mut(0).as_diagonal_mut(),
            Some(vectors.as_mut()),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(needed)),
            Default::default(),
        )
        .map_err(|_| not_finite())?;
    }
    let values = values.col_as_slice(0).to_vec();
    Ok((values.into_pyarray(py), rows_of(&vectors).into_pyarray(py)))
}

/// The solution of `A x = b`, array `[n, k]`, from A `[n, n]` and b `[n, k]`, by LU decomposition
/// with partial pivoting.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn solve<'py>(
    py: Python<'py>,
    matrix: Matrix<'py>,
    right: Matrix<'py>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mut matrix = square(&matrix.as_array())?;
    let right = right.as_array();
    let (n, count) = right.dim();
    if n != matrix.nrows() {
        return Err(ModelError::new_err("matrix and right-hand side have inconsistent sizes"));
    }
    let mut x = Mat::from_fn(n, count, |row, k| right[(row, k)]);
    let (mut order, mut place) = (vec![0_usize; n], vec![0_usize; n]);
    let needed = lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default())
        .or(solve_in_place_scratch::<usize, f64>(n, count, Par::Seq));
    let mut scratch = MemBuffer::new(needed);
    let (_, order) = lu_in_place(
        matrix.as_mut(),
        &mut order,
        &mut place,
        Par::Seq,
        MemStack::new(&mut scratch),
        Default::default(),
    );
    let (factors, stack) = (matrix.as_ref(), MemStack::new(&mut scratch));
    solve_in_place(factors, factors, order, x.as_mut(), Par::Seq, stack);
    let x = rows_of(&x);
    if x.iter().all(|x| x.is_finite()) {
        Ok(x.into_pyarray(py))
    } else {
        Err(ModelError::new_err("the matrix is singular or not finite"))
    }
}

/// Order of the columns of a matrix `[m, n]` in a QR decomposition with column pivoting.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn pivots(matrix: Matrix<'_>) -> PyResult<Vec<usize>> {
    let matrix = matrix.as_array();
    let (m, n) = matrix.dim();
    if matrix.iter().any(|x| !x.is_finite()) {
        return Err(not_finite());
    }
    let mut columns = Mat::from_fn(m, n, |row, k| matrix[(row, k)]);
    let mut reflections = Mat::<f64>::zeros(1, m.min(n));
    let (mut order, mut place) = (vec![0; n], vec![0; n]);
    let needed = qr_in_place_scratch::<usize, f64>(m, n, 1, Par::Seq, Default::default());
    qr_in_place(
        columns.as_mut(),
        reflections.as_mut(),
        &mut order,
        &mut place,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(needed)),
        Default::default(),
    );
    Ok(order)
}

fn square(matrix: &ArrayView2<'_, f64>) -> PyResult<Mat<f64>> {
    let (m, n) = matrix.dim();
    if m != n {
        return Err(ModelError::new_err("the matrix is not square"));
    }
    if matrix.iter().any(|x| !x.is_finite()) {
        return Err(not_finite());
    }
    Ok(Mat::from_fn(n, n, |row, k| matrix[(row, k)]))
}

fn rows_of(matrix: &Mat<f64>) -> Array2<f64> {
    Array2::from_shape_fn(matrix.shape(), |(row, k)| matrix[(row, k)])
}

fn not_finite() -> PyErr {
    ModelError::new_err("the matrix is not finite")
}
