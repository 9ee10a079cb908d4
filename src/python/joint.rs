//! Python interface: simulation of a joint.

use std::borrow::Cow;
use std::format;
use std::vec::Vec;

use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::columns::{Array, contiguous};
use super::model::Model;
use super::{ModelError, refuse};
use crate::composed::Composed;
use crate::dynamics::State;
use crate::joint::{
    self, Controller, Effort, ElasticJoint, ElasticPosture, Fourier, Gravity, HARMONICS, Joint,
    JointStep, Posture, Profile, Push, Reference, Stroke, Trajectory, Transmission,
};

/// Parameters of a joint.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Sizes {
    inertia: f64,
    gravity: f64,
    gravity_cos: f64,
    gravity_sin: f64,
    stiffness: f64,
    damping: f64,
}

impl Sizes {
    pub(super) fn joint(&self) -> Joint<f64> {
        let gravity =
            Gravity { constant: self.gravity, cos: self.gravity_cos, sin: self.gravity_sin };
        Joint { inertia: self.inertia, gravity, stiffness: self.stiffness, damping: self.damping }
    }
}

/// The transmission between motor and load.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct TransmissionSizes {
    motor_inertia: f64,
    stiffness: f64,
    damping: f64,
    backlash: f64,
}

impl TransmissionSizes {
    fn joint(&self, load: Joint<f64>) -> ElasticJoint<f64> {
        let Self { motor_inertia, stiffness, damping, backlash } = *self;
        ElasticJoint {
            motor_inertia,
            transmission: Transmission { stiffness, damping, backlash },
            load,
        }
    }
}

/// A joint within a step.
enum Mechanism {
    Rigid(Joint<f64>, Posture<f64>),
    Elastic(ElasticJoint<f64>, ElasticPosture<f64>),
}

impl Mechanism {
    /// The postures of motor and load.
    fn postures(&self) -> [Posture<f64>; 2] {
        match self {
            Self::Rigid(_, posture) => [*posture; 2],
            Self::Elastic(_, apart) => [apart.motor, apart.load],
        }
    }

    fn step(
        &mut self,
        friction: &Composed<f64>,
        state: &mut State<f64>,
        push: &Push<f64>,
        dt: f64,
    ) -> JointStep<f64> {
        match self {
            Self::Rigid(joint, posture) => {
                let mut body = joint.moving(*posture, push);
                let result = joint::step(friction, state, &mut body, dt);
                *posture = body.posture;
                result
            }
            Self::Elastic(joint, apart) => {
                let mut body = joint.moving(*apart, push);
                let result = joint::step(friction, state, &mut body, dt);
                *apart = body.posture();
                result
            }
        }
    }
}

/// Gains of a controller.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Gains {
    proportional: f64,
    integral: f64,
    derivative: f64,
    velocity_weight: f64,
    limit: f64,
}

impl Gains {
    pub(super) fn controller(&self) -> Controller<f64> {
        Controller {
            proportional: self.proportional,
            integral: self.integral,
            derivative: self.derivative,
            velocity_weight: self.velocity_weight,
            limit: self.limit,
        }
    }
}

/// Inputs of the steps: columns of equal length.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Acting<'py> {
    time: Array<'py>,
    dt: Array<'py>,
    torque: Array<'py>,
    external: Array<'py>,
    support: Array<'py>,
    support_velocity: Array<'py>,
    temperature: Array<'py>,
    desired_position: Array<'py>,
    desired_velocity: Array<'py>,
}

/// The columns of [`Acting`].
struct Columns<'a> {
    time: Cow<'a, [f64]>,
    dt: Cow<'a, [f64]>,
    torque: Cow<'a, [f64]>,
    external: Cow<'a, [f64]>,
    support: Cow<'a, [f64]>,
    support_velocity: Cow<'a, [f64]>,
    temperature: Cow<'a, [f64]>,
    desired_position: Cow<'a, [f64]>,
    desired_velocity: Cow<'a, [f64]>,
}

impl<'a> Columns<'a> {
    fn of(acting: &'a Acting<'_>) -> PyResult<Self> {
        let columns = Self {
            time: contiguous(&acting.time),
            dt: contiguous(&acting.dt),
            torque: contiguous(&acting.torque),
            external: contiguous(&acting.external),
            support: contiguous(&acting.support),
            support_velocity: contiguous(&acting.support_velocity),
            temperature: contiguous(&acting.temperature),
            desired_position: contiguous(&acting.desired_position),
            desired_velocity: contiguous(&acting.desired_velocity),
        };
        let others = [
            &columns.time,
            &columns.dt,
            &columns.external,
            &columns.support,
            &columns.support_velocity,
            &columns.temperature,
            &columns.desired_position,
            &columns.desired_velocity,
        ];
        if others.iter().any(|column| column.len() != columns.torque.len()) {
            return Err(ModelError::new_err("the input columns of a joint have different lengths"));
        }
        Ok(columns)
    }

    fn push(&self, k: usize, motor: f64) -> Push<f64> {
        Push {
            motor,
            external: self.external[k],
            support: self.support[k],
            support_velocity: self.support_velocity[k],
            temperature: self.temperature[k],
            time: self.time[k],
        }
    }

    fn desired(&self, k: usize) -> Reference<f64> {
        Reference {
            position: self.desired_position[k],
            velocity: self.desired_velocity[k],
            acceleration: 0.0,
        }
    }
}

/// A simulated motion: postures between steps, and means over the steps.
struct Motion {
    postures: Vec<[Posture<f64>; 2]>,
    motor: Vec<f64>,
    result: Vec<JointStep<f64>>,
}

/// Simulates a joint with friction step by step: dict of `position`, `velocity`, `load_position`
/// and `load_velocity` [n + 1], and per step `torque`, `load_torque`, `friction_torque` and the
/// works `motor_work`, `environment_work`, `friction_work` [n].
#[pyfunction]
#[pyo3(signature = (model, values, joint, acting, start, deflection, controller=None,
    transmission=None))]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub(super) fn simulate<'py>(
    py: Python<'py>,
    model: &Model,
    values: Array<'py>,
    joint: Sizes,
    acting: Acting<'py>,
    start: (f64, f64),
    deflection: f64,
    controller: Option<Gains>,
    transmission: Option<TransmissionSizes>,
) -> PyResult<Bound<'py, PyDict>> {
    let friction = model.spec.with(&contiguous(&values)).map_err(refuse)?;
    let (joint, columns) = (joint.joint(), Columns::of(&acting)?);
    let controller = controller.map(|gains| gains.controller());
    let start = Posture { position: start.0, velocity: start.1 };
    let mechanism = match transmission {
        Some(apart) => Mechanism::Elastic(apart.joint(joint), ElasticPosture::aligned(start)),
        None => Mechanism::Rigid(joint, start),
    };
    let state = State::with_deflection(deflection);
    let motion = py.detach(|| run(&friction, mechanism, state, controller, &columns))?;
    let answer = PyDict::new(py);
    let place = |pick: fn(&[Posture<f64>; 2]) -> f64| {
        motion.postures.iter().map(pick).collect::<Vec<_>>().into_pyarray(py)
    };
    answer.set_item("position", place(|[motor, _]| motor.position))?;
    answer.set_item("velocity", place(|[motor, _]| motor.velocity))?;
    answer.set_item("load_position", place(|[_, load]| load.position))?;
    answer.set_item("load_velocity", place(|[_, load]| load.velocity))?;
    answer.set_item("torque", motion.motor.into_pyarray(py))?;
    let column = |pick: fn(&JointStep<f64>) -> f64| {
        motion.result.iter().map(pick).collect::<Vec<_>>().into_pyarray(py)
    };
    answer.set_item("load_torque", column(|result| result.load))?;
    answer.set_item("friction_torque", column(|result| result.friction))?;
    answer.set_item("motor_work", column(|result| result.motor_work))?;
    answer.set_item("environment_work", column(|result| result.environment_work))?;
    answer.set_item("friction_work", column(|result| result.friction_work))?;
    Ok(answer)
}

fn run(
    friction: &Composed<f64>,
    mut mechanism: Mechanism,
    mut state: State<f64>,
    controller: Option<Controller<f64>>,
    columns: &Columns<'_>,
) -> PyResult<Motion> {
    let count = columns.torque.len();
    let mut effort = Effort::default();
    let mut motion = Motion {
        postures: Vec::with_capacity(count + 1),
        motor: Vec::with_capacity(count),
        result: Vec::with_capacity(count),
    };
    let mut at = mechanism.postures();
    motion.postures.push(at);
    for (k, &torque) in columns.torque.iter().enumerate() {
        let dt = columns.dt[k];
        let motor = controller.map_or(torque, |controller| {
            let measured = (at[0].position, at[0].velocity);
            controller.torque(&mut effort, &columns.desired(k), measured, torque, dt)
        });
        let push = columns.push(k, motor);
        let result = mechanism.step(friction, &mut state, &push, dt);
        at = mechanism.postures();
        if !at.iter().all(|at| at.position.is_finite() && at.velocity.is_finite()) {
            let message = format!("the motion is not finite after {} s", columns.time[k]);
            return Err(ModelError::new_err(message));
        }
        motion.postures.push(at);
        motion.motor.push(motor);
        motion.result.push(result);
    }
    Ok(motion)
}

/// Position, velocity and acceleration of a desired motion, one array each.
type Desired<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

fn desired<'py>(py: Python<'py>, trajectory: &Trajectory<f64>, time: &[f64]) -> Desired<'py> {
    let at: Vec<_> = time.iter().map(|&t| trajectory.at(t)).collect();
    let column =
        |pick: fn(&Reference<f64>) -> f64| at.iter().map(pick).collect::<Vec<_>>().into_pyarray(py);
    (column(|r| r.position), column(|r| r.velocity), column(|r| r.acceleration))
}

/// A stroke back and forth with trapezoidal speed (two limits: speed and acceleration), or a
/// polynomial of fifth degree (one limit: duration).
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn stroke<'py>(
    py: Python<'py>,
    time: Array<'py>,
    ends: (f64, f64),
    dwell: f64,
    limits: Vec<f64>,
) -> PyResult<(Desired<'py>, f64)> {
    let profile = match limits[..] {
        [speed, acceleration] => Profile::Trapezoid { speed, acceleration },
        [duration] => Profile::Quintic { duration },
        _ => return Err(ModelError::new_err("a stroke needs one limit or two")),
    };
    let stroke = Stroke { from: ends.0, to: ends.1, profile, dwell };
    let duration = stroke.duration();
    Ok((desired(py, &Trajectory::Stroke(stroke), &contiguous(&time)), duration))
}

/// A Fourier series around a centre.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn fourier<'py>(
    py: Python<'py>,
    time: Array<'py>,
    centre: f64,
    frequency: f64,
    sine: Vec<f64>,
    cosine: Vec<f64>,
) -> PyResult<Desired<'py>> {
    if sine.len() > HARMONICS || cosine.len() > HARMONICS {
        let message = format!("a Fourier series has at most {HARMONICS} harmonics");
        return Err(ModelError::new_err(message));
    }
    let filled = |given: &[f64]| {
        let mut all = [0.0; HARMONICS];
        all[..given.len()].copy_from_slice(given);
        all
    };
    let series = Fourier { centre, frequency, sine: filled(&sine), cosine: filled(&cosine) };
    Ok(desired(py, &Trajectory::Fourier(series), &contiguous(&time)))
}
