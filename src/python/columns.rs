//! Python interface: columns of a recording.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::format;
use std::string::String;
use std::vec;

use numpy::ndarray::Dimension;
use numpy::{AllowTypeChange, PyArray, PyArrayLike1, PyArrayMethods, PyReadwriteArray};
use pyo3::prelude::*;

use super::ModelError;
use crate::batch::{Channels, Columns, TimeStep};
use crate::table::Channel;

/// Anything that NumPy converts to a vector of floats.
pub(super) type Array<'py> = PyArrayLike1<'py, f64, AllowTypeChange>;

/// Borrowed if the memory is contiguous, otherwise copied.
pub(super) fn contiguous<'a>(array: &'a Array<'_>) -> Cow<'a, [f64]> {
    match array.as_slice() {
        Ok(slice) => Cow::Borrowed(slice),
        Err(_) => Cow::Owned(array.as_array().to_vec()),
    }
}

/// An array for results, by NumPy: it asks for large pages, whose first use takes far less time.
pub(super) fn fresh<'py, const N: usize, D: Dimension>(
    py: Python<'py>,
    shape: [usize; N],
) -> PyResult<Bound<'py, PyArray<f64, D>>> {
    let made = py.import("numpy")?.call_method1("empty", (shape,))?;
    Ok(made.cast_into()?)
}

/// Permission to write to an array that no argument of the call shares memory with.
pub(super) fn writable<'py, D: Dimension>(
    array: &Bound<'py, PyArray<f64, D>>,
) -> PyResult<PyReadwriteArray<'py, f64, D>> {
    array.try_readwrite().map_err(|error| ModelError::new_err(format!("out: {error}")))
}

/// The numbers of such an array, row by row.
pub(super) fn numbers<'a, D: Dimension>(
    array: &'a mut PyReadwriteArray<'_, f64, D>,
) -> PyResult<&'a mut [f64]> {
    array.as_slice_mut().map_err(|error| ModelError::new_err(format!("out: {error}")))
}

/// One time step for all samples, or one per sample.
#[derive(FromPyObject)]
pub(super) enum Dt<'py> {
    Uniform(f64),
    Each(Array<'py>),
}

/// An initial state: one number, or one per element.
#[derive(FromPyObject)]
pub(super) enum Start<'py> {
    Single(f64),
    Each(Array<'py>),
}

impl Start<'_> {
    /// The numbers; empty for a relaxed state, which fits every model.
    fn values(&self) -> Cow<'_, [f64]> {
        match self {
            Self::Single(z) if *z == 0.0 => Cow::Borrowed(&[]),
            Self::Single(z) => Cow::Owned(vec![*z]),
            Self::Each(values) => contiguous(values),
        }
    }
}

/// The common arguments of `torque`, `gradient` and `split`; a dict of them elsewhere.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Arguments<'py> {
    pub dt: Option<Dt<'py>>,
    pub velocity: Array<'py>,
    #[pyo3(default)]
    pub position: Option<Array<'py>>,
    #[pyo3(default)]
    pub acceleration: Option<Array<'py>>,
    #[pyo3(default)]
    pub temperature: Option<Array<'py>>,
    #[pyo3(default)]
    pub temperature_rate: Option<Array<'py>>,
    #[pyo3(default)]
    pub load_torque: Option<Array<'py>>,
    #[pyo3(default)]
    pub load_torque_curvature: Option<Array<'py>>,
    #[pyo3(default)]
    pub motor_torque: Option<Array<'py>>,
    #[pyo3(default)]
    pub external_torque: Option<Array<'py>>,
    #[pyo3(default)]
    pub time: Option<Array<'py>>,
    #[pyo3(default)]
    pub smooth: Option<BTreeMap<String, Array<'py>>>,
    #[pyo3(default = true)]
    pub shift_load: bool,
    #[pyo3(default)]
    pub mean_velocity: Option<Array<'py>>,
    #[pyo3(default)]
    pub state: Option<Start<'py>>,
}

impl Arguments<'_> {
    /// Number of samples.
    pub(super) fn rows(&self) -> usize {
        self.velocity.as_array().len()
    }

    /// Runs `work` on the columns without holding the interpreter lock.
    pub(super) fn detached<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Columns<'_>) -> T + Send,
    ) -> PyResult<T> {
        let velocity = contiguous(&self.velocity);
        let position = self.position.as_ref().map(contiguous);
        let acceleration = self.acceleration.as_ref().map(contiguous);
        let temperature = self.temperature.as_ref().map(contiguous);
        let temperature_rate = self.temperature_rate.as_ref().map(contiguous);
        let load_torque = self.load_torque.as_ref().map(contiguous);
        let load_torque_curvature = self.load_torque_curvature.as_ref().map(contiguous);
        let motor_torque = self.motor_torque.as_ref().map(contiguous);
        let external_torque = self.external_torque.as_ref().map(contiguous);
        let time = self.time.as_ref().map(contiguous);
        let mean_velocity = self.mean_velocity.as_ref().map(contiguous);
        let state = self.state.as_ref().map(Start::values).unwrap_or_default();
        let dt = match &self.dt {
            Some(Dt::Each(dt)) => Some(contiguous(dt)),
            _ => None,
        };
        let mut smooth = BTreeMap::new();
        for (name, array) in self.smooth.iter().flatten() {
            if Channel::ALL.iter().all(|channel| channel.name() != name) {
                let message = format!("smoothed column '{name}' is unknown");
                return Err(ModelError::new_err(message));
            }
            smooth.insert(name.as_str(), contiguous(array));
        }
        let smooth = |channel: Channel| smooth.get(channel.name()).map(AsRef::as_ref);
        let columns = Columns {
            dt: match (&self.dt, &dt) {
                (Some(Dt::Uniform(dt)), _) => TimeStep::Uniform(*dt),
                (_, Some(dt)) => TimeStep::Each(dt),
                _ => TimeStep::Unknown,
            },
            channels: Channels {
                velocity: &velocity,
                position: position.as_deref(),
                acceleration: acceleration.as_deref(),
                temperature: temperature.as_deref(),
                temperature_rate: temperature_rate.as_deref(),
                load_torque: load_torque.as_deref(),
                load_torque_curvature: load_torque_curvature.as_deref(),
                motor_torque: motor_torque.as_deref(),
                external_torque: external_torque.as_deref(),
                time: time.as_deref(),
            },
            smooth: Channels {
                velocity: smooth(Channel::Velocity).unwrap_or_default(),
                position: smooth(Channel::Position),
                acceleration: smooth(Channel::Acceleration),
                temperature: smooth(Channel::Temperature),
                temperature_rate: smooth(Channel::TemperatureRate),
                load_torque: smooth(Channel::LoadTorque),
                load_torque_curvature: smooth(Channel::LoadTorqueCurvature),
                motor_torque: smooth(Channel::MotorTorque),
                external_torque: smooth(Channel::ExternalTorque),
                time: smooth(Channel::Time),
            },
            shift_load: self.shift_load,
            mean_velocity: mean_velocity.as_deref(),
            state: &state,
        };
        Ok(py.detach(|| work(&columns)))
    }
}
