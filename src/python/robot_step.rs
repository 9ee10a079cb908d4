//! Python interface: a robot in closed loop, with friction in every motor.

use std::format;
use std::vec;
use std::vec::Vec;

use numpy::{IntoPyArray, PyArray2, PyArrayLike2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::columns::{Array, contiguous};
use super::joint::Gains;
use super::model::Model;
use super::robot::RigidBodies;
use super::{ModelError, refuse};
use crate::composed::Composed;
use crate::dynamics::State;
use crate::joint::{Controller, Effort, JointStep, Reference};
use crate::robot::{Axis, LinkState, Moving, Pushed, Room};

/// Inputs of the steps: columns [steps, N] of the motors.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Acting<'py> {
    torque: PyArrayLike2<'py, f64>,
    temperature: PyArrayLike2<'py, f64>,
    desired_position: PyArrayLike2<'py, f64>,
    desired_velocity: PyArrayLike2<'py, f64>,
}

/// The columns of [`Acting`], row by row.
struct Columns {
    torque: Vec<f64>,
    temperature: Vec<f64>,
    desired_position: Vec<f64>,
    desired_velocity: Vec<f64>,
}

impl Columns {
    fn of(acting: &Acting<'_>, n: usize) -> PyResult<Self> {
        let rows = acting.torque.as_array().nrows();
        let column = |given: &PyArrayLike2<'_, f64>| {
            let view = given.as_array();
            if view.dim() == (rows, n) {
                return Ok(view.iter().copied().collect());
            }
            Err(ModelError::new_err(
                "the inputs of a robot need one column per joint, and as many rows as each other",
            ))
        };
        Ok(Self {
            torque: column(&acting.torque)?,
            temperature: column(&acting.temperature)?,
            desired_position: column(&acting.desired_position)?,
            desired_velocity: column(&acting.desired_velocity)?,
        })
    }
}

/// A simulated motion, row by row: positions and velocities between steps, and means over them.
#[derive(Default)]
struct Motion {
    position: Vec<f64>,
    velocity: Vec<f64>,
    torque: Vec<f64>,
    deflection: Vec<f64>,
    result: Vec<JointStep<f64>>,
    /// Steps whose equations were not solved to rounding.
    unsolved: usize,
}

/// Simulates a robot step by step: dict of `position`, `velocity`, `deflection` of bristles
/// [n + 1, N], and per step `torque`, `load_torque`, `friction_torque`, `motor_work` and
/// `friction_work` [n, N], all of the motors; and how many steps were not solved to rounding.
#[pyfunction]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub(super) fn simulate_robot<'py>(
    py: Python<'py>,
    bodies: &RigidBodies,
    models: Vec<PyRef<'py, Model>>,
    values: Vec<Array<'py>>,
    acting: Acting<'py>,
    dt: f64,
    start: (Vec<f64>, Vec<f64>),
    controllers: Vec<Option<Gains>>,
) -> PyResult<(Bound<'py, PyDict>, usize)> {
    let n = bodies.count();
    let sizes = [models.len(), values.len(), start.0.len(), start.1.len(), controllers.len()];
    if n == 0 || sizes.iter().any(|size| *size != n) {
        return Err(ModelError::new_err(
            "a robot needs friction, start and controller of each joint",
        ));
    }
    let friction = models
        .iter()
        .zip(&values)
        .map(|(model, values)| model.spec.with(&contiguous(values)).map_err(refuse))
        .collect::<PyResult<Vec<_>>>()?;
    let columns = Columns::of(&acting, n)?;
    let controllers: Vec<_> =
        controllers.into_iter().map(|gains| gains.map(|gains| gains.controller())).collect();
    let axes = start.0.iter().zip(&start.1).map(|(q, v)| Axis::at(*q, *v)).collect();
    let motion = py.detach(|| run(bodies, &friction, &controllers, &columns, dt, axes))?;
    let answer = PyDict::new(py);
    let matrix = |flat: Vec<f64>| -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = flat.len() / n;
        flat.into_pyarray(py).reshape([rows, n])
    };
    let column =
        |pick: fn(&JointStep<f64>) -> f64| matrix(motion.result.iter().map(pick).collect());
    answer.set_item("load_torque", column(|result| result.load)?)?;
    answer.set_item("friction_torque", column(|result| result.friction)?)?;
    answer.set_item("motor_work", column(|result| result.motor_work)?)?;
    answer.set_item("friction_work", column(|result| result.friction_work)?)?;
    answer.set_item("position", matrix(motion.position)?)?;
    answer.set_item("velocity", matrix(motion.velocity)?)?;
    answer.set_item("torque", matrix(motion.torque)?)?;
    answer.set_item("deflection", matrix(motion.deflection)?)?;
    Ok((answer, motion.unsolved))
}

fn run(
    bodies: &RigidBodies,
    friction: &[Composed<f64>],
    controllers: &[Option<Controller<f64>>],
    columns: &Columns,
    dt: f64,
    mut axes: Vec<Axis<f64>>,
) -> PyResult<Motion> {
    let n = axes.len();
    let moving = Moving { tree: bodies.tree(), friction };
    let (mut links, mut numbers) = (vec![LinkState::new(); n], vec![0.0; Room::<f64>::numbers(n)]);
    let mut room = Room { links: &mut links, numbers: &mut numbers };
    let (mut states, mut efforts) = (vec![State::default(); n], vec![Effort::default(); n]);
    let mut motion = Motion::default();
    motion.keep(&axes, &states);
    let (mut motor, mut result) = (vec![0.0; n], vec![JointStep::at_rest(); n]);
    for (k, feedforward) in columns.torque.chunks(n).enumerate() {
        for (joint, motor) in motor.iter_mut().enumerate() {
            let at = k * n + joint;
            let desired = Reference {
                position: columns.desired_position[at],
                velocity: columns.desired_velocity[at],
                acceleration: 0.0,
            };
            let measured = (axes[joint].position, axes[joint].velocity);
            let own = feedforward[joint];
            *motor = controllers[joint].map_or(own, |controller| {
                controller.torque(&mut efforts[joint], &desired, measured, own, dt)
            });
        }
        #[allow(clippy::cast_precision_loss)]
        let time = k as f64 * dt;
        let temperature = &columns.temperature[k * n..(k + 1) * n];
        let pushed = Pushed { motor: &motor, temperature, time };
        let solved = moving.step(&mut states, &mut axes, &pushed, &mut room, &mut result, dt);
        motion.unsolved += usize::from(!solved);
        if !axes.iter().all(|axis| axis.position.is_finite() && axis.velocity.is_finite()) {
            return Err(ModelError::new_err(format!("the motion is not finite after {time} s")));
        }
        motion.keep(&axes, &states);
        motion.torque.extend(&motor);
        motion.result.extend(&result);
    }
    Ok(motion)
}

impl Motion {
    fn keep(&mut self, axes: &[Axis<f64>], states: &[State<f64>]) {
        self.position.extend(axes.iter().map(|axis| axis.position));
        self.velocity.extend(axes.iter().map(|axis| axis.velocity));
        self.deflection.extend(states.iter().map(State::deflection));
    }
}
