//! Python interface: identification.

use std::vec::Vec;

use numpy::ndarray::Array3;
use numpy::{AllowTypeChange, IntoPyArray, PyArray1, PyArray3, PyArrayLike1, PyArrayLike2};
use pyo3::prelude::*;

use super::columns::{Arguments, Array, contiguous};
use super::model::Model;
use super::normal::{row_by_row, shape_error};
use super::{ModelError, refuse};
use crate::batch::BatchError;
use crate::identify::{self, Bounds, LeastSquares, Outcome, Problem, Search, Steps, Triangle};

/// A measured torque, with the columns that the model reads: a dict.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Measured<'py> {
    columns: Arguments<'py>,
    target: Array<'py>,
    /// The square root of the weight of each sample.
    scale: Option<Array<'py>>,
    group: PyArrayLike1<'py, u32, AllowTypeChange>,
    begins: Vec<usize>,
    moving: PyArrayLike1<'py, bool, AllowTypeChange>,
    torque_norm: f64,
    /// Number of threads for starts and samples.
    threads: usize,
}

impl Measured<'_> {
    /// Runs `work` on the problem without holding the interpreter lock.
    fn detached<T: Send>(
        &self,
        py: Python<'_>,
        model: &Model,
        groups: usize,
        threads: usize,
        work: impl Fn(&Problem<'_>) -> Result<T, BatchError> + Send + Sync,
    ) -> PyResult<T> {
        let target = contiguous(&self.target);
        let scale = self.scale.as_ref().map(contiguous);
        let group = self.group.as_array().to_vec();
        let moving = self.moving.as_array().to_vec();
        let (begins, torque_norm) = (&self.begins[..], self.torque_norm);
        let done = self.columns.detached(py, |columns| {
            work(&Problem {
                spec: &model.spec,
                columns: *columns,
                target: &target,
                scale: scale.as_deref(),
                group: &group,
                groups,
                begins,
                moving: &moving,
                torque_norm,
                threads,
            })
        })?;
        done.map_err(refuse)
    }
}

/// Bounds and kinds of the parameters: a dict.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Within<'py> {
    lower: Array<'py>,
    upper: Array<'py>,
    linear: Vec<bool>,
    logarithmic: Vec<bool>,
    tolerance: f64,
    most: usize,
    damping: f64,
}

impl Within<'_> {
    fn with<T>(&self, size: usize, work: impl Fn(&Bounds<'_>, Steps) -> T) -> PyResult<T> {
        let (lower, upper) = (contiguous(&self.lower), contiguous(&self.upper));
        let (linear, logarithmic) = (&self.linear[..], &self.logarithmic[..]);
        if [lower.len(), upper.len(), linear.len(), logarithmic.len()] != [size; 4] {
            return Err(ModelError::new_err("bounds and starts have different lengths"));
        }
        let bounds = Bounds { lower: &lower, upper: &upper, linear, logarithmic };
        let steps =
            Steps { tolerance: self.tolerance, max_steps: self.most, damping: self.damping };
        Ok(work(&bounds, steps))
    }
}

/// Triangular factors of `[J r]` over `groups` groups of samples, array `[groups, p + 1, p + 1]`.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn triangle<'py>(
    py: Python<'py>,
    jacobian: PyArrayLike2<'py, f64, AllowTypeChange>,
    residual: Array<'py>,
    group: PyArrayLike1<'py, u32, AllowTypeChange>,
    groups: usize,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let jacobian = jacobian.as_array();
    let p = jacobian.ncols();
    let rows = row_by_row(&jacobian);
    let residual = contiguous(&residual);
    let group = group.as_array().to_vec();
    let made =
        py.detach(|| identify::triangles(&rows, p, &residual, &group, groups)).map_err(refuse)?;
    stacked(py, &made, p + 1)
}

/// The same for a model linearised at `values` with respect to the parameters `wanted`, times
/// `slope`; None where it is not finite.
#[pyfunction]
#[pyo3(signature = (model, measured, groups, values, wanted, slope))]
#[allow(clippy::needless_pass_by_value)]
pub fn triangles_of<'py>(
    py: Python<'py>,
    model: &Model,
    measured: Measured<'py>,
    groups: usize,
    values: Array<'py>,
    wanted: Vec<usize>,
    slope: Array<'py>,
) -> PyResult<Option<Bound<'py, PyArray3<f64>>>> {
    let (values, slope) = (contiguous(&values), contiguous(&slope));
    if slope.len() != wanted.len() {
        return Err(ModelError::new_err("'wanted' and 'slope' have different lengths"));
    }
    let made = measured.detached(py, model, groups, measured.threads, |problem| {
        problem.triangles(&values, &wanted, &slope)
    })?;
    made.map(|made| stacked(py, &made, wanted.len() + 1)).transpose()
}

fn stacked<'py>(
    py: Python<'py>,
    made: &[Triangle],
    width: usize,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let factors = made.iter().flat_map(|triangle| triangle.factor().iter().copied()).collect();
    let factors =
        Array3::from_shape_vec((made.len(), width, width), factors).map_err(shape_error)?;
    Ok(factors.into_pyarray(py))
}

/// Whether each run that begins in motion begins in steady sliding, list of bool.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn slides<'py>(
    py: Python<'py>,
    model: &Model,
    measured: Measured<'py>,
    values: Array<'py>,
) -> PyResult<Vec<bool>> {
    let values = contiguous(&values);
    measured.detached(py, model, 1, 1, |problem| problem.slides(&values))
}

/// Values, their sum of squares, whether the search converged, why it ended, evaluations, and the
/// parameters without influence at its end.
type Found<'py> = (Bound<'py, PyArray1<f64>>, f64, bool, &'static str, usize, Vec<usize>);

fn found(py: Python<'_>, search: Search) -> Found<'_> {
    let (converged, outcome) = match search.outcome {
        Outcome::Converged => (true, "converged"),
        Outcome::ToRounding => (true, "converged (to rounding)"),
        Outcome::Stopped => (false, "stopped at the largest number of steps"),
        Outcome::NotFinite => (false, "the model is not finite at the start"),
    };
    let Search { values, square, insensitive, evaluations, .. } = search;
    (values.into_pyarray(py), square, converged, outcome, evaluations, insensitive)
}

/// Searches from each of `starts`, array `[k, p]`, on several threads: the results do not depend on
/// their number.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn search<'py>(
    py: Python<'py>,
    model: &Model,
    measured: Measured<'py>,
    starts: PyArrayLike2<'py, f64, AllowTypeChange>,
    within: Within<'py>,
) -> PyResult<Vec<Found<'py>>> {
    let starts = starts.as_array();
    let size = starts.ncols();
    let starts: Vec<Vec<f64>> = starts.rows().into_iter().map(|row| row.to_vec()).collect();
    let threads = measured.threads;
    let ended = within.with(size, |bounds, steps| {
        measured.detached(py, model, 1, threads / starts.len().max(1), |problem| {
            identify::side_by_side(starts.len(), threads, |start| {
                identify::minimise(problem, &starts[start], bounds, steps)
            })
        })
    })??;
    Ok(ended.into_iter().map(|search| found(py, search)).collect())
}

/// Values with the best linear parameters, sum of squares, and its slope.
type Reduced<'py> = (Bound<'py, PyArray1<f64>>, f64, Bound<'py, PyArray1<f64>>);

/// The least sum of squares over the linear parameters at the nonlinear ones of each of `points`,
/// array `[k, p]`, and its slope if `sloped`: a list with None where the model is not finite.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn reduced<'py>(
    py: Python<'py>,
    model: &Model,
    measured: Measured<'py>,
    points: PyArrayLike2<'py, f64, AllowTypeChange>,
    within: Within<'py>,
    sloped: bool,
) -> PyResult<Vec<Option<Reduced<'py>>>> {
    let points = points.as_array();
    let size = points.ncols();
    let points: Vec<Vec<f64>> = points.rows().into_iter().map(|row| row.to_vec()).collect();
    let threads = measured.threads;
    let made = within.with(size, |bounds, _| {
        measured.detached(py, model, 1, threads / points.len().max(1), |problem| {
            identify::side_by_side(points.len(), threads, |k| {
                identify::reduced(problem, &points[k], bounds, sloped)
            })
        })
    })??;
    let given = |made: identify::Reduced| {
        (made.values.into_pyarray(py), made.square, made.slope.into_pyarray(py))
    };
    Ok(made.into_iter().map(|made| made.map(given)).collect())
}

/// Like `search`, from one start, for any object with `triangle` and `torque_norm`.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn search_by<'py>(
    py: Python<'py>,
    problem: Bound<'py, PyAny>,
    start: Array<'py>,
    within: Within<'py>,
) -> PyResult<Found<'py>> {
    let start = contiguous(&start);
    let called = Called(problem);
    let ended = within
        .with(start.len(), |bounds, steps| identify::minimise(&called, &start, bounds, steps))??;
    Ok(found(py, ended))
}

/// A problem that a Python object linearises.
struct Called<'py>(Bound<'py, PyAny>);

impl LeastSquares for Called<'_> {
    type Error = PyErr;

    fn triangle(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> PyResult<Option<Triangle>> {
        let py = self.0.py();
        let wanted: Vec<isize> = wanted.iter().map(|&k| k as isize).collect();
        let given = (
            values.to_vec().into_pyarray(py),
            wanted.into_pyarray(py),
            slope.to_vec().into_pyarray(py),
        );
        let made = self.0.call_method1("triangle", given)?;
        if made.is_none() {
            return Ok(None);
        }
        let whole: PyArrayLike2<'_, f64> = made.call_method0("whole")?.extract()?;
        let whole = whole.as_array();
        Ok(Some(Triangle::new(whole.ncols(), whole.iter().copied().collect())))
    }

    fn torque_norm(&self) -> PyResult<f64> {
        self.0.getattr("torque_norm")?.extract()
    }
}

/// Minimises `|A x - b|` within bounds, array `[p]`.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub fn bounded_least_squares<'py>(
    py: Python<'py>,
    matrix: PyArrayLike2<'py, f64, AllowTypeChange>,
    right: Array<'py>,
    lower: Array<'py>,
    upper: Array<'py>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let matrix = matrix.as_array();
    let (right, lower, upper) = (contiguous(&right), contiguous(&lower), contiguous(&upper));
    if [matrix.ncols(), upper.len()] != [lower.len(); 2] || matrix.nrows() != right.len() {
        return Err(ModelError::new_err(
            "matrix, right-hand side and bounds have inconsistent sizes",
        ));
    }
    let rows = row_by_row(&matrix);
    let best = identify::bounded_least_squares(&rows, &right, &lower, &upper);
    Ok(best.into_pyarray(py))
}
