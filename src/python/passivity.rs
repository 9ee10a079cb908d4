use std::collections::BTreeMap;
use std::string::String;
use std::vec::Vec;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::columns::{Array, contiguous};
use super::model::Model;
use super::{ModelError, refuse};
use crate::passivity::region::{Point, Side};
use crate::passivity::replay::{self, Counterexample, Hold};
use crate::passivity::{Verdict, check};
use crate::table::Channel;

/// Whether a model is passive over a box, all of it being friction: dict of `passive`, `condition`,
/// `margins` and `counterexample`.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn passivity<'py>(
    py: Python<'py>,
    model: &Model,
    values: Array<'py>,
    sides: BTreeMap<String, (f64, f64)>,
    budget: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let mut box_sides = Vec::new();
    for (name, (lower, upper)) in sides {
        let channel = Channel::ALL.into_iter().find(|channel| channel.name() == name);
        let channel = channel.ok_or_else(|| {
            ModelError::new_err(std::format!("the box's channel '{name}' is unknown"))
        })?;
        box_sides.push(Side { channel, lower, upper });
    }
    let values = contiguous(&values);
    let verdict = py.detach(|| check(&model.spec, &values, &box_sides, budget)).map_err(refuse)?;
    written(py, &verdict, &model.spec.channels().collect::<Vec<_>>())
}

/// The work that a model takes over steps that are held one after the other (J), from a
/// deflection on or else sliding already, by its exact step, and the deflection at the end.
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
                load_torque: at(Channel::LoadTorque),
                load_torque_curvature: at(Channel::LoadTorqueCurvature),
                motor_torque: at(Channel::MotorTorque),
                external_torque: at(Channel::ExternalTorque),
                time: at(Channel::Time),
            };
            Hold { point, duration: *duration }
        })
        .collect();
    Ok(replay::work(&exact, deflection, &holds))
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

fn point<'py>(
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
