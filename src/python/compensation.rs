//! Python interface: simulation of friction compensation.

use std::collections::BTreeMap;
use std::string::String;
use std::vec::Vec;

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::columns::{Array, contiguous};
use super::joint::{Gains, Sizes};
use super::model::Model;
use super::passivity::{operating_box, point};
use super::{ModelError, refuse};
use crate::composed::Composed;
use crate::dynamics::State;
use crate::joint::{
    self, Compensator, Controller, Effort, Joint, JointStep, Observer, Posture, Push, Reference,
};
use crate::passivity;
use crate::sample::Sample;

/// Inputs of a control loop, one row per step.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct LoopInputs<'py> {
    position: Array<'py>,
    velocity: Array<'py>,
    acceleration: Array<'py>,
    temperature: Array<'py>,
}

/// A compensator with feedback or feedforward.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Cancels<'py> {
    model: PyRef<'py, Model>,
    values: Array<'py>,
    factor: f64,
    feedback: bool,
}

/// The measurement of a joint: exact position and velocity, or an encoder's steps and their
/// differences.
struct Encoder {
    resolution: f64,
    last: Option<f64>,
}

impl Encoder {
    fn measured(&mut self, at: Posture<f64>, dt: f64) -> Posture<f64> {
        if self.resolution == 0.0 {
            return at;
        }
        let position = self.resolution * (at.position / self.resolution).round();
        let last = self.last.replace(position).unwrap_or(position);
        Posture { position, velocity: (position - last) / dt }
    }
}

/// The control loop without the joint.
struct Loop<'a> {
    encoder: Encoder,
    controller: Controller<f64>,
    compensator: Option<Compensator<'a, f64>>,
    feedback: bool,
    observer: Option<Observer<f64>>,
    /// Whether a hand guides the joint instead of a controller.
    guided: bool,
}

/// The simulated signals.
struct Signals {
    postures: Vec<Posture<f64>>,
    taken: Vec<JointStep<f64>>,
    motor: Vec<f64>,
    controller: Vec<f64>,
    compensation: Vec<f64>,
    observed: Vec<f64>,
}

/// Moves a joint along a desired motion with gravity and a share of its friction compensated, by a
/// controller or, if `guided`, by a hand that acts like one: dict of `position` and `velocity` [n +
/// 1], and per step `torque` of the motor, `controller_torque`, `compensation`, `observed`,
/// `load_torque` and `friction_torque` [n]. With a `resolution` the joint is measured by an
/// encoder.
#[pyfunction]
#[pyo3(signature = (model, values, joint, given, dt, controller, compensator=None,
    bandwidth=None, guided=false, resolution=0.0))]
#[allow(clippy::too_many_arguments, clippy::needless_pass_by_value)]
pub(super) fn compensate<'py>(
    py: Python<'py>,
    model: &Model,
    values: Array<'py>,
    joint: Sizes,
    given: LoopInputs<'py>,
    dt: f64,
    controller: Gains,
    compensator: Option<Cancels<'py>>,
    bandwidth: Option<f64>,
    guided: bool,
    resolution: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let friction = model.spec.with(&contiguous(&values)).map_err(refuse)?;
    let joint = joint.joint();
    let cancels = compensator
        .as_ref()
        .map(|c| c.model.spec.with(&contiguous(&c.values)).map_err(refuse))
        .transpose()?;
    let factor = compensator.as_ref().map_or(0.0, |c| c.factor);
    let parts = Loop {
        encoder: Encoder { resolution, last: None },
        controller: controller.controller(),
        compensator: cancels.as_ref().map(|model| Compensator::new(model, factor)),
        feedback: compensator.as_ref().is_some_and(|c| c.feedback),
        observer: bandwidth.map(|bandwidth| Observer::new(joint.inertia, bandwidth)),
        guided,
    };
    let desired = rows(&given)?;
    let temperature = contiguous(&given.temperature);
    let course = py.detach(|| parts.run(&friction, &joint, &desired, &temperature, dt))?;
    let answer = PyDict::new(py);
    let (position, velocity): (Vec<_>, Vec<_>) =
        course.postures.iter().map(|at| (at.position, at.velocity)).unzip();
    let (load, resisted): (Vec<_>, Vec<_>) =
        course.taken.iter().map(|taken| (taken.load, taken.friction)).unzip();
    for (name, column) in [
        ("position", position),
        ("velocity", velocity),
        ("torque", course.motor),
        ("controller_torque", course.controller),
        ("compensation", course.compensation),
        ("observed", course.observed),
        ("load_torque", load),
        ("friction_torque", resisted),
    ] {
        answer.set_item(name, column.into_pyarray(py))?;
    }
    Ok(answer)
}

fn rows(given: &LoopInputs<'_>) -> PyResult<Vec<Reference<f64>>> {
    let [position, velocity, acceleration] =
        [&given.position, &given.velocity, &given.acceleration].map(contiguous);
    let count = contiguous(&given.temperature).len();
    if [&position, &velocity, &acceleration].iter().any(|column| column.len() != count) {
        return Err(ModelError::new_err(
            "the input columns of a control loop have different lengths",
        ));
    }
    Ok((0..count)
        .map(|k| Reference {
            position: position[k],
            velocity: velocity[k],
            acceleration: acceleration[k],
        })
        .collect())
}

impl Loop<'_> {
    fn run(
        mut self,
        friction: &Composed<f64>,
        joint: &Joint<f64>,
        desired: &[Reference<f64>],
        temperature: &[f64],
        dt: f64,
    ) -> PyResult<Signals> {
        let mut course = Signals::of(desired.len());
        let (mut state, mut effort) = (State::default(), Effort::default());
        let mut at = desired.first().map_or(Posture { position: 0.0, velocity: 0.0 }, |first| {
            Posture { position: first.position, velocity: first.velocity }
        });
        course.postures.push(at);
        // Of the previous step: the torque apart from friction, and the velocity measured at its
        // start.
        let (mut known, mut before) = (0.0, at.velocity);
        for (k, (wanted, &temperature)) in desired.iter().zip(temperature).enumerate() {
            #[allow(clippy::cast_precision_loss)]
            let time = k as f64 * dt;
            let seen = self.encoder.measured(at, dt);
            if let Some(observer) = &mut self.observer {
                observer.update(known, (before, seen.velocity), dt);
            }
            let gravity = joint.gravity.mean(seen.position, 0.0);
            let measured = (seen.position, seen.velocity);
            let pid = self.controller.torque(&mut effort, wanted, measured, 0.0, dt);
            let sample = Sample { time, ..self.sample(joint, wanted, seen, temperature) };
            let compensation = self.compensator.as_mut().map_or(0.0, |c| c.torque(&sample, dt));
            let observed = self.observer.map_or(0.0, |observer| observer.estimate);
            let hand = if self.guided { pid } else { 0.0 };
            let inertial = self.inertial(joint, wanted);
            let motor = gravity + inertial + compensation + observed + pid - hand;
            let push = Push {
                motor,
                external: hand,
                support: 0.0,
                support_velocity: 0.0,
                temperature,
                time,
            };
            let mut body = joint.moving(at, &push);
            let taken = joint::step(friction, &mut state, &mut body, dt);
            at = body.posture;
            if !(at.position.is_finite() && at.velocity.is_finite()) {
                let message = std::format!("the motion is not finite after {time} s");
                return Err(ModelError::new_err(message));
            }
            (known, before) = (motor - gravity - compensation, seen.velocity);
            course.postures.push(at);
            course.taken.push(taken);
            course.motor.push(motor);
            course.controller.push(pid);
            course.compensation.push(compensation);
            course.observed.push(observed);
        }
        Ok(course)
    }

    /// The input of the compensator: the measured or the desired motion.
    fn sample(
        &self,
        joint: &Joint<f64>,
        wanted: &Reference<f64>,
        seen: Posture<f64>,
        temperature: f64,
    ) -> Sample<f64> {
        let (position, velocity) = if self.feedback {
            (seen.position, seen.velocity)
        } else {
            (wanted.position, wanted.velocity)
        };
        let weight = joint.gravity.mean(position, 0.0);
        let load = weight + self.inertial(joint, wanted);
        Sample {
            position,
            acceleration: wanted.acceleration,
            temperature,
            load_torque: load,
            external_torque: -weight,
            motor_torque: load,
            ..Sample::at(velocity)
        }
    }

    /// The torque of the desired acceleration; unknown if a hand guides the joint.
    fn inertial(&self, joint: &Joint<f64>, wanted: &Reference<f64>) -> f64 {
        if self.guided { 0.0 } else { joint.inertia * wanted.acceleration }
    }
}

impl Signals {
    fn of(count: usize) -> Self {
        Self {
            postures: Vec::with_capacity(count + 1),
            taken: Vec::with_capacity(count),
            motor: Vec::with_capacity(count),
            controller: Vec::with_capacity(count),
            compensation: Vec::with_capacity(count),
            observed: Vec::with_capacity(count),
        }
    }
}

/// The largest share of a compensator that nowhere exceeds friction whose parameters lie within
/// bounds: the proved share, the share at one point, and that point.
#[pyfunction]
#[allow(clippy::needless_pass_by_value)]
pub(super) fn largest_factor<'py>(
    py: Python<'py>,
    compensator: (PyRef<'py, Model>, Array<'py>),
    friction: (PyRef<'py, Model>, Array<'py>, Array<'py>),
    sides: BTreeMap<String, (f64, f64)>,
    budget: usize,
) -> PyResult<(f64, f64, Option<Bound<'py, PyDict>>)> {
    let sides = operating_box(sides)?;
    let (cancels, values) = (&compensator.0.spec, contiguous(&compensator.1));
    let (resists, lower, upper) = (&friction.0.spec, &friction.1, &friction.2);
    let bounds: Vec<_> = contiguous(lower)
        .iter()
        .zip(contiguous(upper).iter())
        .map(|(&lower, &upper)| [lower, upper])
        .collect();
    let found = py
        .detach(|| {
            passivity::largest_factor((cancels, &values), (resists, &bounds), &sides, budget)
        })
        .map_err(refuse)?;
    let channels: Vec<_> = sides.iter().map(|side| side.channel).collect();
    let place = found.point.map(|at| point(py, &at, &channels)).transpose()?;
    Ok((found.proved, found.at_point, place))
}
