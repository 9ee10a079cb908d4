//! Python interface: passivity.

use std::collections::BTreeMap;
use std::string::{String, ToString};
use std::vec::Vec;

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::columns::{Array, contiguous};
use super::model::Model;
use super::{ModelError, refuse};
use crate::passivity::{Counterexample, Hold, PassivityError, Point, Side, Verdict, check};
use crate::table::Channel;

/// Whether a model is passive over a box, with all of it as friction: dict of `passive`,
/// `condition`, `margins` and `counterexample`.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn passivity<'py>(
    py: Python<'py>,
    model: &Model,
    values: Array<'py>,
    sides: BTreeMap<String, (f64, f64)>,
    budget: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let box_sides = operating_box(sides)?;
    let values = contiguous(&values);
    let verdict = py.detach(|| check(&model.spec, &values, &box_sides, budget)).map_err(refuse)?;
    written(py, &verdict, &model.spec.channels().collect::<Vec<_>>())
}

/// For a model over a box: whether it is passive, the deciding condition, and the requirement that
/// is violated or undecided.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn missed<'py>(
    py: Python<'py>,
    model: &Model,
    values: Array<'py>,
    sides: BTreeMap<String, (f64, f64)>,
    budget: usize,
) -> PyResult<(Option<bool>, &'static str, Option<Requirement>)> {
    let sides = operating_box(sides)?;
    let values = contiguous(&values);
    let own = |asked| Requirement { asked, channels: model.spec.channels().collect() };
    match py.detach(|| check(&model.spec, &values, &sides, budget)) {
        Ok(verdict) => Ok((verdict.passive, verdict.condition.name(), verdict.open.map(own))),
        Err(PassivityError::NoBristle(point, _)) => {
            let asked = crate::passivity::Requirement::Strength(point);
            Ok((Some(false), asked.name(), Some(own(asked))))
        }
        Err(error) => Err(refuse(error)),
    }
}

/// Requirements at points spread over a box, the worst of each kind.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn requirements<'py>(
    py: Python<'py>,
    model: &Model,
    values: Array<'py>,
    sides: BTreeMap<String, (f64, f64)>,
) -> PyResult<Vec<Requirement>> {
    let sides = operating_box(sides)?;
    let values = contiguous(&values);
    let found = py
        .detach(|| crate::passivity::requirements(&model.spec, &values, &sides))
        .map_err(refuse)?;
    let own = |asked| Requirement { asked, channels: model.spec.channels().collect() };
    Ok(found.into_iter().map(own).collect())
}

/// The margins (T) of requirements, and their derivatives with respect to all parameters.
#[pyfunction]
#[allow(clippy::needless_pass_by_value, clippy::type_complexity)]
pub(super) fn margins<'py>(
    py: Python<'py>,
    model: &Model,
    values: Array<'py>,
    requirements: Vec<PyRef<'py, Requirement>>,
) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)> {
    let values = contiguous(&values);
    let (mut margins, mut slopes) = (Vec::new(), Vec::new());
    for requirement in &requirements {
        let (margin, row) = requirement.asked.gradient(&model.spec, &values).map_err(refuse)?;
        margins.push(margin);
        slopes.extend(row);
    }
    let slopes = Array2::from_shape_vec((margins.len(), values.len()), slopes);
    let slopes = slopes.map_err(|error| ModelError::new_err(error.to_string()))?;
    Ok((margins.into_pyarray(py), slopes.into_pyarray(py)))
}

/// A condition of passivity on the parameters at single operating points.
#[pyclass(frozen, module = "stribeck._core")]
pub(super) struct Requirement {
    asked: crate::passivity::Requirement,
    channels: Vec<Channel>,
}

#[pymethods]
impl Requirement {
    /// `strength`, `sliding` or `cycle`.
    #[getter]
    fn kind(&self) -> &'static str {
        self.asked.name()
    }

    /// The operating points of the condition.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.asked.points().iter().map(|p| point(py, p, &self.channels)).collect()
    }

    /// The bristle force of a cycle (T).
    #[getter]
    fn force(&self) -> Option<f64> {
        match self.asked {
            crate::passivity::Requirement::Cycle { force, .. } => Some(force),
            _ => None,
        }
    }
}

pub(super) fn operating_box(sides: BTreeMap<String, (f64, f64)>) -> PyResult<Vec<Side>> {
    let side = |(name, (lower, upper)): (String, (f64, f64))| {
        let channel = Channel::ALL.into_iter().find(|channel| channel.name() == name);
        let channel = channel.ok_or_else(|| {
            ModelError::new_err(std::format!("the box's channel '{name}' is unknown"))
        })?;
        Ok(Side { channel, lower, upper })
    };
    sides.into_iter().map(side).collect()
}

/// The work done on a model over a sequence of constant samples (J), from a deflection or from
/// steady sliding, and the final deflection.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn work(
    model: &Model,
    values: Array<'_>,
    deflection: Option<f64>,
    steps: Vec<(f64, BTreeMap<String, f64>)>,
) -> PyResult<(f64, f64)> {
    let exact = model.spec.with(&contiguous(&values)).map_err(refuse)?;
    let holds: Vec<_> = steps
        .iter()
        .map(|(duration, channels)| {
            let at = |channel: Channel| channels.get(channel.name()).copied().unwrap_or_default();
            let point = Point {
                velocity: at(Channel::Velocity),
                position: at(Channel::Position),
                acceleration: at(Channel::Acceleration),
                temperature: at(Channel::Temperature),
                temperature_rate: at(Channel::TemperatureRate),
                load_torque: at(Channel::LoadTorque),
                load_torque_curvature: at(Channel::LoadTorqueCurvature),
                motor_torque: at(Channel::MotorTorque),
                external_torque: at(Channel::ExternalTorque),
                time: at(Channel::Time),
            };
            Hold { point, duration: *duration }
        })
        .collect();
    Ok(crate::passivity::work(&exact, deflection, &holds))
}

fn written<'py>(
    py: Python<'py>,
    verdict: &Verdict,
    channels: &[Channel],
) -> PyResult<Bound<'py, PyDict>> {
    let answer = PyDict::new(py);
    answer.set_item("passive", verdict.passive)?;
    answer.set_item("condition", verdict.condition.name())?;
    let margins = PyList::empty(py);
    for margin in &verdict.margins {
        let row = PyDict::new(py);
        row.set_item("condition", margin.condition.name())?;
        row.set_item("lower", margin.lower)?;
        row.set_item("upper", margin.upper)?;
        row.set_item("at", margin.point.map(|p| point(py, &p, channels)).transpose()?)?;
        margins.append(row)?;
    }
    answer.set_item("margins", margins)?;
    let example = verdict.counterexample.as_ref();
    answer.set_item("counterexample", example.map(|e| motion(py, e, channels)).transpose()?)?;
    Ok(answer)
}

fn motion<'py>(
    py: Python<'py>,
    example: &Counterexample,
    channels: &[Channel],
) -> PyResult<Bound<'py, PyDict>> {
    let holds = PyList::empty(py);
    for hold in &example.holds {
        let row = point(py, &hold.point, channels)?;
        row.set_item("duration", hold.duration)?;
        holds.append(row)?;
    }
    let answer = PyDict::new(py);
    answer.set_item("deflection", example.deflection)?;
    answer.set_item("steps", holds)?;
    answer.set_item("work", example.work)?;
    Ok(answer)
}

pub(super) fn point<'py>(
    py: Python<'py>,
    point: &Point,
    channels: &[Channel],
) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    for &channel in channels {
        row.set_item(channel.name(), point.channel(channel))?;
    }
    Ok(row)
}
