//! Columns of a recording as input of a model, their checks, and the time axis.

#[cfg(feature = "identify")]
use core::ops::Range;
use std::borrow::Cow;
use std::vec;
use std::vec::Vec;

use pulp::Arch;

use super::BatchError;
use super::balance::Balance;
use crate::catalog::EffectId;
use crate::composed::Spec;
use crate::dynamics::{Memory, State};
use crate::graph::{Beginning, all_finite};
use crate::sample::Sample;
use crate::scalar::{Real, Scalar};
use crate::table::Channel;

/// Columns with their names.
pub(super) type Named<'a> = Vec<(&'static str, &'a [f64])>;

/// Channels of a recording, one value per sample; only the velocity is always required.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Channels<'a> {
    pub velocity: &'a [f64],
    pub position: Option<&'a [f64]>,
    pub acceleration: Option<&'a [f64]>,
    pub temperature: Option<&'a [f64]>,
    pub temperature_rate: Option<&'a [f64]>,
    pub load_torque: Option<&'a [f64]>,
    pub load_torque_curvature: Option<&'a [f64]>,
    pub motor_torque: Option<&'a [f64]>,
    pub external_torque: Option<&'a [f64]>,
    pub time: Option<&'a [f64]>,
}

impl<'a> Channels<'a> {
    /// The column of a channel, if present.
    #[must_use]
    pub fn get(&self, channel: Channel) -> Option<&'a [f64]> {
        match channel {
            Channel::Velocity => (!self.velocity.is_empty()).then_some(self.velocity),
            Channel::Position => self.position,
            Channel::Acceleration => self.acceleration,
            Channel::Temperature => self.temperature,
            Channel::TemperatureRate => self.temperature_rate,
            Channel::LoadTorque => self.load_torque,
            Channel::LoadTorqueCurvature => self.load_torque_curvature,
            Channel::MotorTorque => self.motor_torque,
            Channel::ExternalTorque => self.external_torque,
            Channel::Time => self.time,
        }
    }

    /// The columns of some samples; a shorter column becomes empty.
    #[cfg(feature = "identify")]
    fn part(&self, rows: &Range<usize>) -> Self {
        let some = |column: &'a [f64]| column.get(rows.clone()).unwrap_or_default();
        Self {
            velocity: some(self.velocity),
            position: self.position.map(some),
            acceleration: self.acceleration.map(some),
            temperature: self.temperature.map(some),
            temperature_rate: self.temperature_rate.map(some),
            load_torque: self.load_torque.map(some),
            load_torque_curvature: self.load_torque_curvature.map(some),
            motor_torque: self.motor_torque.map(some),
            external_torque: self.external_torque.map(some),
            time: self.time.map(some),
        }
    }

    /// One sample; missing channels are zero.
    #[inline]
    pub(super) fn sample<P: Real>(&self, row: usize) -> Sample<P> {
        let at = |column: Option<&[f64]>| match column.and_then(|c| c.get(row)) {
            Some(&x) => P::from_f64(x),
            None => P::zero(),
        };
        Sample {
            velocity: at(Some(self.velocity)),
            position: at(self.position),
            acceleration: at(self.acceleration),
            temperature: at(self.temperature),
            temperature_rate: at(self.temperature_rate),
            load_torque: at(self.load_torque),
            load_torque_curvature: at(self.load_torque_curvature),
            motor_torque: at(self.motor_torque),
            external_torque: at(self.external_torque),
            time: at(self.time),
        }
    }
}

/// Time since the previous sample (s).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TimeStep<'a> {
    /// Unknown: sufficient for a model without state and delay.
    #[default]
    Unknown,
    /// The same for every sample, the first included.
    Uniform(f64),
    /// One per sample; a value that is not positive and finite starts a new segment. An infinite
    /// value starts one in steady sliding at the sample's velocity, with a settled state.
    Each(&'a [f64]),
}

/// The input of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Columns<'a> {
    /// Time step.
    pub dt: TimeStep<'a>,
    /// The recorded channels.
    pub channels: Channels<'a>,
    /// Smoothed channels, which a delay interpolates; recorded ones are used where absent.
    /// Interpolation averages noise, so a fit would find a delay where there is none.
    pub smooth: Channels<'a>,
    /// Whether a delay shifts the load torque too: yes if the target is motor torque minus load
    /// torque, no if the load is a term of the model or friction was measured. The balance of a law
    /// that depends on the motor torque uses the same rule.
    pub shift_load: bool,
    /// Mean velocity over each sample's step, with which a bristle is stepped; otherwise the
    /// sample's velocity is constant over the step. From position differences it does not
    /// accumulate velocity noise.
    pub mean_velocity: Option<&'a [f64]>,
    /// State at the start of every segment, according to the model's [`Memory`]: the deflection of
    /// a bristle (X) or the forces of the elements (T). Empty for a relaxed state.
    pub state: &'a [f64],
}

impl Default for Columns<'_> {
    fn default() -> Self {
        Self {
            dt: TimeStep::Unknown,
            channels: Channels::default(),
            smooth: Channels::default(),
            shift_load: true,
            mean_velocity: None,
            state: &[],
        }
    }
}

impl<'a> Columns<'a> {
    /// The same columns with smoothed channels where present, recorded ones elsewhere.
    pub(super) fn smoothed(&self) -> Self {
        let (plain, smooth) = (&self.channels, &self.smooth);
        let channels = Channels {
            velocity: if smooth.velocity.is_empty() { plain.velocity } else { smooth.velocity },
            position: smooth.position.or(plain.position),
            acceleration: smooth.acceleration.or(plain.acceleration),
            temperature: smooth.temperature.or(plain.temperature),
            temperature_rate: smooth.temperature_rate.or(plain.temperature_rate),
            load_torque: smooth.load_torque.or(plain.load_torque),
            load_torque_curvature: smooth.load_torque_curvature.or(plain.load_torque_curvature),
            motor_torque: smooth.motor_torque.or(plain.motor_torque),
            external_torque: smooth.external_torque.or(plain.external_torque),
            time: smooth.time.or(plain.time),
        };
        self.with(channels)
    }

    /// The same columns with these channels.
    pub(super) const fn with(&self, channels: Channels<'a>) -> Self {
        Self { channels, ..*self }
    }

    /// The columns of some samples.
    #[cfg(feature = "identify")]
    pub(crate) fn part(&self, rows: &Range<usize>) -> Self {
        Self {
            dt: match self.dt {
                TimeStep::Each(steps) => TimeStep::Each(&steps[rows.clone()]),
                dt => dt,
            },
            channels: self.channels.part(rows),
            smooth: self.smooth.part(rows),
            mean_velocity: self
                .mean_velocity
                .map(|mean| mean.get(rows.clone()).unwrap_or_default()),
            ..*self
        }
    }

    /// Adds the load torque that a delay shifts together with friction.
    pub(super) fn add_load(&self, series: &mut [f64]) {
        let load = self.smoothed().channels.load_torque.filter(|_| self.shift_load);
        for (sum, load) in series.iter_mut().zip(load.unwrap_or_default()) {
            *sum += load;
        }
    }

    /// Checks that every column the model reads is present, has the length of the velocity, and is
    /// finite.
    pub(super) fn check(&self, spec: &Spec) -> Result<(), BatchError> {
        let read = self.check_presence(spec)?;
        self.check_values(spec, &read)
    }

    /// Checks that every column the model reads is present and has the length of the velocity.
    /// Returns the columns by name.
    fn check_presence(&self, spec: &Spec) -> Result<Named<'a>, BatchError> {
        let rows = self.channels.velocity.len();
        if rows == 0 {
            return Err(BatchError::NoRows);
        }
        let needed: Vec<Channel> = spec.channels().collect();
        let delayed = spec.effects().contains(EffectId::Delay);
        let mut read = vec![];
        for channel in Channel::ALL {
            let needs = needed.contains(&channel);
            let added = channel == Channel::LoadTorque
                && self.shift_load
                && (delayed || Balance::solves(spec, &self.channels));
            match self.channels.get(channel) {
                Some(column) if needs || added => read.push((channel.name(), column)),
                None if needs && !Balance::provides(spec, channel, self) => {
                    return Err(BatchError::Missing(channel));
                }
                _ => {}
            }
            if let (true, Some(column)) = (delayed, self.smooth.get(channel)) {
                read.push((channel.name(), column));
            }
        }
        if let (true, Some(column)) = (spec.has_state(), self.mean_velocity) {
            read.push(("mean_velocity", column));
        }
        if let Some(&(column, values)) = read.iter().find(|(_, values)| values.len() != rows) {
            return Err(BatchError::Length { column, length: values.len(), rows });
        }
        let memory = spec.memory();
        if !self.state.is_empty() && self.state.len() != memory.size() {
            return Err(BatchError::StateLength { memory, given: self.state.len() });
        }
        let finite = self.state.iter().all(|x| x.is_finite());
        if finite { Ok(read) } else { Err(BatchError::State) }
    }

    /// Checks that the columns are finite, and that the law has no pole between their temperatures.
    pub(super) fn check_values(&self, spec: &Spec, read: &Named<'_>) -> Result<(), BatchError> {
        for &(column, values) in read {
            if !finite(values) {
                let row = values.iter().position(|x| !x.is_finite()).unwrap_or(0);
                return Err(BatchError::NotFinite { column, row });
            }
        }
        if let (Some(pole), Some(temperature)) = (spec.pole(), self.channels.temperature) {
            let below = temperature.iter().any(|&t| t <= pole);
            if below && temperature.iter().any(|&t| t >= pole) {
                return Err(BatchError::Pole { law: spec.law().info().id, pole });
            }
        }
        Ok(())
    }

    /// The state at the start of every segment; the columns must be checked.
    pub(super) fn start<S: Scalar>(&self, memory: Memory) -> State<S> {
        let mut given = self.state.iter().map(|&x| S::from_f64(x));
        match memory {
            Memory::None => State::default(),
            Memory::Deflection => given.next().map_or_else(State::default, State::with_deflection),
            Memory::Forces(_) | Memory::Elements => State::with_forces(given),
        }
    }

    /// Whether a sample needs no more than its columns: no delay, no loads from a balance.
    pub(super) fn stand_alone(&self, spec: &Spec) -> bool {
        !spec.effects().contains(EffectId::Delay) && !self.is_balanced(spec)
    }

    /// Whether loads follow from a balance of torques.
    pub(super) fn is_balanced(&self, spec: &Spec) -> bool {
        Balance::is_needed(spec, &self.channels)
    }

    /// Checks the columns and prepares the time axis.
    pub(super) fn rows(&self, spec: &Spec) -> Result<Rows, BatchError> {
        let (rows, read) = self.unchecked_rows(spec)?;
        self.check_values(spec, &read)?;
        Ok(rows)
    }

    /// The time axis, and the columns that the model reads, whose values must still be
    /// [checked](Self::check_values).
    pub(super) fn unchecked_rows(&self, spec: &Spec) -> Result<(Rows, Named<'a>), BatchError> {
        let read = self.check_presence(spec)?;
        Ok((self.time_axis(spec)?, read))
    }

    fn time_axis(&self, spec: &Spec) -> Result<Rows, BatchError> {
        let count = self.channels.velocity.len();
        let timed = spec.has_state() || spec.effects().contains(EffectId::Delay);
        match self.dt {
            TimeStep::Unknown if timed => Err(BatchError::NoTimeStep),
            TimeStep::Uniform(dt) if !(dt >= 0.0 && dt.is_finite()) => {
                Err(BatchError::NotFinite { column: "dt", row: 0 })
            }
            TimeStep::Each(dt) if dt.len() != count => {
                Err(BatchError::Length { column: "dt", length: dt.len(), rows: count })
            }
            // Without time every sample is independent.
            TimeStep::Uniform(0.0) if timed => Ok(Rows::each(&vec![0.0; count])),
            TimeStep::Uniform(dt) if timed => Ok(Rows::uniform(dt, count)),
            TimeStep::Each(dt) if timed => Ok(Rows::each(dt)),
            _ => Ok(Rows::uniform(0.0, count)),
        }
    }
}

/// Whether all numbers are finite.
pub(super) fn finite(values: &[f64]) -> bool {
    Arch::new().dispatch(
        #[inline(always)]
        || all_finite(values),
    )
}

/// The time axis.
pub(super) struct Rows {
    count: usize,
    steps: Steps,
    starts: Vec<(usize, Beginning)>,
}

/// Lengths of steps (s).
enum Steps {
    /// The same for all samples.
    Uniform(f64),
    /// One per sample; 0 where a segment starts.
    Each(Vec<f64>),
}

impl Rows {
    /// One segment with a constant step.
    fn uniform(dt: f64, count: usize) -> Self {
        Self { count, steps: Steps::Uniform(dt), starts: vec![(0, Beginning::Fresh)] }
    }

    /// A step that is not positive and finite starts a segment, settled if it is infinite.
    fn each(dt: &[f64]) -> Self {
        let mut starts = vec![];
        let steps = dt.iter().enumerate().map(|(row, &dt)| {
            let passes = dt > 0.0 && dt.is_finite();
            if dt == f64::INFINITY {
                starts.push((row, Beginning::Settled));
            } else if row == 0 || !passes {
                starts.push((row, Beginning::Fresh));
            }
            if passes { dt } else { 0.0 }
        });
        let steps = Steps::Each(steps.collect());
        Self { count: dt.len(), steps, starts }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// The step, if all samples share it.
    pub(super) fn uniform_step(&self) -> Option<f64> {
        match self.steps {
            Steps::Uniform(dt) => Some(dt),
            Steps::Each(_) => None,
        }
    }

    /// The step of each sample.
    pub(super) fn steps(&self) -> Cow<'_, [f64]> {
        match &self.steps {
            Steps::Uniform(dt) => Cow::Owned(vec![*dt; self.count]),
            Steps::Each(steps) => Cow::Borrowed(steps),
        }
    }

    /// The samples at which segments start, with the first one, and how each begins.
    pub(super) fn starts(&self) -> &[(usize, Beginning)] {
        &self.starts
    }
}
