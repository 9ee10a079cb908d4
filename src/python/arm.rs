//! Python interface: simulation of a planar arm.

use std::format;
use std::vec::Vec;

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArrayLike2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::columns::{Array, contiguous};
use super::joint::Gains;
use super::model::Model;
use super::{ModelError, refuse};
use crate::composed::Composed;
use crate::dynamics::State;
use crate::joint::{ArmPosture, ArmPush, Controller, Effort, JointStep, PlanarArm, Reference};

/// Inertial parameters of the arm.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Inertial {
    inertia_1: f64,
    inertia_2: f64,
    moment_x: f64,
    moment_y: f64,
}

/// Inputs of the steps: columns [steps, 2].
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Acting<'py> {
    torque: PyArrayLike2<'py, f64>,
    temperature: PyArrayLike2<'py, f64>,
    desired_position: PyArrayLike2<'py, f64>,
    desired_velocity: PyArrayLike2<'py, f64>,
}

/// The columns of [`Acting`], step by step.
struct Columns {
    torque: Vec<[f64; 2]>,
    temperature: Vec<[f64; 2]>,
    desired_position: Vec<[f64; 2]>,
    desired_velocity: Vec<[f64; 2]>,
}

impl Columns {
    fn of(acting: &Acting<'_>) -> PyResult<Self> {
        let columns = Self {
            torque: rows(&acting.torque)?,
            temperature: rows(&acting.temperature)?,
            desired_position: rows(&acting.desired_position)?,
            desired_velocity: rows(&acting.desired_velocity)?,
        };
        let count = columns.torque.len();
        let others = [&columns.temperature, &columns.desired_position, &columns.desired_velocity];
        if others.iter().any(|column| column.len() != count) {
            return Err(ModelError::new_err("the input columns of an arm have different lengths"));
        }
        Ok(columns)
    }

    fn desired(&self, k: usize, joint: usize) -> Reference<f64> {
        Reference {
            position: self.desired_position[k][joint],
            velocity: self.desired_velocity[k][joint],
            acceleration: 0.0,
        }
    }
}

fn rows(columns: &PyArrayLike2<'_, f64>) -> PyResult<Vec<[f64; 2]>> {
    let view = columns.as_array();
    if view.ncols() != 2 {
        return Err(ModelError::new_err(
            "the columns of an arm need two values per step, one per joint",
        ));
    }
    Ok(view.outer_iter().map(|row| [row[0], row[1]]).collect())
}

/// Simulates a planar arm step by step: dict of `position`, `velocity` [n + 1, 2], and per step
/// `torque`, `load_torque`, `friction_torque`, `motor_work` and `friction_work` [n, 2].
#[pyfunction]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub(super) fn simulate_arm<'py>(
    py: Python<'py>,
    models: (PyRef<'py, Model>, PyRef<'py, Model>),
    values: (Array<'py>, Array<'py>),
    arm: Inertial,
    acting: Acting<'py>,
    dt: f64,
    start: ([f64; 2], [f64; 2]),
    controllers: (Option<Gains>, Option<Gains>),
) -> PyResult<Bound<'py, PyDict>> {
    let friction = [
        models.0.spec.with(&contiguous(&values.0)).map_err(refuse)?,
        models.1.spec.with(&contiguous(&values.1)).map_err(refuse)?,
    ];
    let columns = Columns::of(&acting)?;
    let Inertial { inertia_1, inertia_2, moment_x, moment_y } = arm;
    let arm = PlanarArm { inertia_1, inertia_2, moment_x, moment_y };
    let start = ArmPosture { position: start.0, velocity: start.1 };
    let controllers =
        [controllers.0, controllers.1].map(|gains| gains.map(|gains| gains.controller()));
    let motion = py.detach(|| run(&friction, &arm, controllers, &columns, dt, start))?;
    let answer = PyDict::new(py);
    answer.set_item("position", matrix(motion.postures.iter().map(|p| p.position), py)?)?;
    answer.set_item("velocity", matrix(motion.postures.iter().map(|p| p.velocity), py)?)?;
    answer.set_item("torque", matrix(motion.motor.iter().copied(), py)?)?;
    let column = |name: &str, pick: fn(&JointStep<f64>) -> f64| -> PyResult<()> {
        let rows = motion.result.iter().map(|result| [pick(&result[0]), pick(&result[1])]);
        answer.set_item(name, matrix(rows, py)?)
    };
    column("load_torque", |result| result.load)?;
    column("friction_torque", |result| result.friction)?;
    column("motor_work", |result| result.motor_work)?;
    column("friction_work", |result| result.friction_work)?;
    Ok(answer)
}

fn matrix<'py>(
    rows: impl Iterator<Item = [f64; 2]>,
    py: Python<'py>,
) -> PyResult<Bound<'py, numpy::PyArray2<f64>>> {
    let flat: Vec<f64> = rows.flatten().collect();
    let matrix = Array2::from_shape_vec((flat.len() / 2, 2), flat)
        .map_err(|error| ModelError::new_err(format!("{error}")))?;
    Ok(matrix.into_pyarray(py))
}

/// A simulated motion: postures between steps, and means over the steps.
struct Motion {
    postures: Vec<ArmPosture<f64>>,
    motor: Vec<[f64; 2]>,
    result: Vec<[JointStep<f64>; 2]>,
}

fn run(
    friction: &[Composed<f64>; 2],
    arm: &PlanarArm<f64>,
    controllers: [Option<Controller<f64>>; 2],
    columns: &Columns,
    dt: f64,
    start: ArmPosture<f64>,
) -> PyResult<Motion> {
    let (mut posture, mut states) = (start, [State::default(); 2]);
    let mut efforts = [Effort::default(); 2];
    let mut motion = Motion { postures: [posture].into(), motor: Vec::new(), result: Vec::new() };
    for (k, torque) in columns.torque.iter().enumerate() {
        let mut motor = *torque;
        for joint in 0..2 {
            if let Some(controller) = controllers[joint] {
                let measured = (posture.position[joint], posture.velocity[joint]);
                let desired = columns.desired(k, joint);
                motor[joint] =
                    controller.torque(&mut efforts[joint], &desired, measured, torque[joint], dt);
            }
        }
        #[allow(clippy::cast_precision_loss)]
        let time = k as f64 * dt;
        let push = ArmPush { motor, temperature: columns.temperature[k], time };
        let [first, second] = friction;
        let result = arm.step([first, second], &mut states, &mut posture, &push, dt);
        if !posture.position.iter().chain(&posture.velocity).all(|x| x.is_finite()) {
            let message = format!("the motion is not finite after {time} s");
            return Err(ModelError::new_err(message));
        }
        motion.postures.push(posture);
        motion.motor.push(motor);
        motion.result.push(result);
    }
    Ok(motion)
}
