//! The loads of a law that depends on the motor torque, where the recording does not contain them.
//!
//! A fit predicts the motor torque, so friction that depends on it must not use the measured one.
//! It follows from the balance `tm = tl + tf(te, tm, v)` at each sample, with the load torque `tl`
//! and the model's own inertia and gravity. Where friction grows less than the motor torque,
//! `d tf/d tm < 1`, there is exactly one solution. There are two other cases:
//!
//! - Friction jumps with the motor torque (`bam_m6` where both ends of the gearbox carry the same)
//!   and the balance lies within the jump: the motor torque stays at the jump, and friction
//!   balances it.
//! - Friction grows as fast as the motor torque: the joint is self-locking, no motor torque moves
//!   it and there is no solution. [`torque`](super::torque) refuses such a sample. A
//!   [`gradient`](super::gradient), which a search may request at any parameters, uses the friction
//!   at `tm = tl` times [`MAX_AMPLIFIED`]: the limit of the exact solution as the slope approaches
//!   `1 - 1/MAX_AMPLIFIED`, and far from any measurement.
//!
//! Derivatives are those of the implicit function: the derivative of friction at fixed loads, times
//! `1/(1 - d tf/d tm)`. Without an `external_torque` the external torque is minus the model's own
//! gravity, and depends on its parameters.

use std::vec::Vec;

use super::columns::{Channels, Columns};
use super::error::BatchError;
use crate::catalog::EffectId;
use crate::composed::{Composed, Spec};
use crate::math;
use crate::sample::Sample;
use crate::scalar::{Dual, Real};
use crate::table::Channel;

/// Largest amplification of the friction at `tm = tl` by the balance; above it a joint counts as
/// self-locking.
const MAX_AMPLIFIED: f64 = 100.0;
/// Number of Newton steps, after which the bracket is bisected.
const NEWTON_STEPS: usize = 20;
/// Number of all steps: bisection of the widest bracket to rounding takes fewer.
const MAX_STEPS: usize = 120;
/// Number of times a bracket is widened: friction that jumps upwards needs one, a self-locking
/// joint all.
const MAX_WIDENED: usize = 3;
/// Rounding error of a balance, relative to its torques.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Residual of a balance where large terms cancel; a larger one at the end of a bracket is a jump.
const SETTLED: f64 = 1e-9;

/// Derivatives with respect to motor torque and external torque.
type Slopes = Dual<f64, 2>;
/// A model with constant parameters whose samples carry [`Slopes`].
type Model = Composed<Dual<Slopes, 0>>;

/// The missing loads, and the derivatives of the torque with respect to them.
pub(super) struct Balance {
    motor: Vec<f64>,
    external: Vec<f64>,
    rows: Vec<Row>,
    /// Whether the external torque follows from the model's own gravity.
    own_gravity: bool,
}

/// The result of the balance at one sample, and how the torque depends on the loads there.
#[derive(Clone, Copy)]
struct Row {
    outcome: Outcome,
    /// Factor of the derivative at fixed loads.
    gain: f64,
    /// Derivative with respect to the external torque.
    by_external: f64,
}

/// The result of a balance.
#[derive(Clone, Copy)]
enum Outcome {
    /// There is a solution.
    Settled,
    /// The motor torque stays where friction jumps, with this friction.
    Jump(f64),
    /// No motor torque moves the joint.
    Locked,
}

impl Balance {
    /// The loads that the model reads and `columns` do not contain; `None` if none are missing.
    pub(super) fn of(
        spec: &Spec,
        values: &[f64],
        columns: &Columns<'_>,
    ) -> Result<Option<Self>, BatchError> {
        let channels = &columns.channels;
        if !Self::is_needed(spec, channels) {
            return Ok(None);
        }
        let solve = Self::solves(spec, channels);
        let own_gravity = is_missing(spec, channels, Channel::ExternalTorque);
        let values: Vec<_> = values.iter().map(|&x| Dual::from_f64(x)).collect();
        let model: Model = spec.with(&values)?;
        let load = channels.load_torque.filter(|_| columns.shift_load);
        let count = channels.velocity.len();
        let mut balance = Self {
            motor: Vec::with_capacity(count),
            external: Vec::with_capacity(count),
            rows: Vec::with_capacity(count),
            own_gravity,
        };
        for i in 0..count {
            let mut sample = channels.sample::<Slopes>(i);
            if own_gravity {
                sample.external_torque = -own_gravity_at(&model, sample.position);
            }
            sample.external_torque = Dual::variable(sample.external_torque.value, 1);
            let load = load.and_then(|load| load.get(i)).copied().unwrap_or(0.0);
            let row = SampleBalance { model: &model, sample, load };
            let (motor, settled) = if solve {
                row.solve()
            } else {
                let given = row.at(sample.motor_torque.value);
                (given.motor, given.ending(Outcome::Settled, 1.0))
            };
            balance.motor.push(motor);
            balance.external.push(sample.external_torque.value);
            balance.rows.push(settled);
        }
        Ok(Some(balance))
    }

    /// Whether loads that the model reads are missing.
    pub(super) fn is_needed(spec: &Spec, channels: &Channels<'_>) -> bool {
        [Channel::MotorTorque, Channel::ExternalTorque]
            .iter()
            .any(|&channel| is_missing(spec, channels, channel))
    }

    /// Whether the motor torque must be solved for.
    pub(super) fn solves(spec: &Spec, channels: &Channels<'_>) -> bool {
        is_missing(spec, channels, Channel::MotorTorque)
    }

    /// Whether a channel that the model reads can be computed if it is missing.
    pub(super) fn provides(spec: &Spec, channel: Channel, columns: &Columns<'_>) -> bool {
        let own = |effect| spec.effects().contains(effect);
        match channel {
            Channel::MotorTorque => {
                let load = columns.channels.load_torque.is_some();
                !spec.has_state() && (load || own(EffectId::Inertia) || own(EffectId::Gravity))
            }
            Channel::ExternalTorque => own(EffectId::Gravity),
            _ => false,
        }
    }

    /// The channels with all loads.
    pub(super) fn complete<'a>(&'a self, columns: &Columns<'a>) -> Columns<'a> {
        columns.with(Channels {
            motor_torque: Some(&self.motor),
            external_torque: Some(&self.external),
            ..columns.channels
        })
    }

    /// An error if no motor torque moves the joint at some sample.
    pub(super) fn refuse_locked(&self) -> Result<(), BatchError> {
        let locked = |row: &Row| matches!(row.outcome, Outcome::Locked);
        match self.rows.iter().position(locked) {
            Some(row) => Err(BatchError::SelfLocking { row }),
            None => Ok(()),
        }
    }

    /// Converts torques at fixed loads into those of the balance.
    pub(super) fn settle(&self, torque: &mut [f64]) {
        for (torque, row) in torque.iter_mut().zip(&self.rows) {
            match row.outcome {
                Outcome::Settled => {}
                Outcome::Jump(settled) => *torque = settled,
                Outcome::Locked => *torque *= MAX_AMPLIFIED,
            }
        }
    }

    /// Converts derivatives at fixed loads with respect to the `wanted` parameters into those of
    /// the balance.
    pub(super) fn settle_slopes(
        &self,
        spec: &Spec,
        channels: &Channels<'_>,
        wanted: &[usize],
        jacobian: &mut [f64],
    ) {
        if wanted.is_empty() {
            return;
        }
        let names: Vec<_> = wanted
            .iter()
            .map(|&index| spec.parameters().nth(index).map_or("", |info| info.name))
            .collect();
        let rows = jacobian.chunks_exact_mut(wanted.len()).zip(&self.rows);
        for (i, (slopes, row)) in rows.enumerate() {
            let (sin, cos) = math::f64::sin_cos(channels.sample::<f64>(i).position);
            for (slope, name) in slopes.iter_mut().zip(&names) {
                *slope *= row.gain;
                *slope -= match *name {
                    "gravity_cos" if self.own_gravity => row.by_external * cos,
                    "gravity_sin" if self.own_gravity => row.by_external * sin,
                    _ => 0.0,
                };
            }
        }
    }
}

/// Whether the model reads a channel that is missing.
fn is_missing(spec: &Spec, channels: &Channels<'_>, channel: Channel) -> bool {
    channels.get(channel).is_none() && spec.channels().any(|read| read == channel)
}

/// Gravity torque of the model at `position` (T).
fn own_gravity_at(model: &Model, position: Slopes) -> Slopes {
    let (sin, cos) = position.sin_cos();
    match &model.effects().gravity {
        Some(gravity) => gravity.gravity_cos.value * cos + gravity.gravity_sin.value * sin,
        None => Slopes::zero(),
    }
}

/// The balance equation of one sample.
struct SampleBalance<'m> {
    model: &'m Model,
    sample: Sample<Slopes>,
    load: f64,
}

/// The balance at one motor torque.
struct Imbalance {
    motor: f64,
    /// Friction and the model's own inertia and gravity (T).
    torque: f64,
    /// `tl + tf - tm` (T).
    excess: f64,
    by_motor: f64,
    by_external: f64,
}

impl Imbalance {
    /// Whether the residual is within rounding.
    fn is_settled(&self) -> bool {
        self.excess.abs() <= ROUNDING * (self.torque.abs() + self.motor.abs())
    }

    /// The result at this motor torque, with derivatives at fixed loads multiplied by `gain`.
    fn ending(&self, outcome: Outcome, gain: f64) -> Row {
        Row { outcome, gain, by_external: gain * self.by_external }
    }

    /// Increase of the motor torque over the increase of the torque that it overcomes.
    fn amplification(&self) -> f64 {
        1.0 / (1.0 - self.by_motor).max(1.0 / MAX_AMPLIFIED)
    }
}

impl SampleBalance<'_> {
    fn at(&self, motor: f64) -> Imbalance {
        let sample = Sample { motor_torque: Dual::variable(motor, 0), ..self.sample };
        let torque = self.model.static_torque(&sample).value;
        let [by_motor, by_external] = torque.derivative;
        let torque = torque.value;
        Imbalance { motor, torque, excess: self.load + torque - motor, by_motor, by_external }
    }

    /// Newton's method within a bracket.
    ///
    /// The excess falls with the motor torque with a slope of at least `1/MAX_AMPLIFIED`, unless
    /// friction jumps upwards or the joint is self-locking, so an excess bounds the distance of the
    /// solution.
    fn solve(&self) -> (f64, Row) {
        let unloaded = self.at(self.load);
        let first = self.at(self.load + unloaded.torque);
        let mut bracket = Bracket::from(&first);
        let mut tried = first;
        for step in 0..MAX_STEPS {
            if tried.is_settled() || !tried.excess.is_finite() || bracket.is_closed(self.load) {
                break;
            }
            let newton = tried.motor + tried.amplification() * tried.excess;
            let next = if step < NEWTON_STEPS && bracket.contains(newton) {
                newton
            } else {
                bracket.next()
            };
            tried = self.at(next);
            bracket.narrow(&tried);
            if bracket.widened > MAX_WIDENED {
                return (unloaded.motor, unloaded.ending(Outcome::Locked, MAX_AMPLIFIED));
            }
        }
        let is_jump = tried.excess.abs() > SETTLED * (tried.torque.abs() + tried.motor.abs());
        let row = if is_jump {
            self.jump(tried.motor)
        } else {
            tried.ending(Outcome::Settled, tried.amplification())
        };
        (tried.motor, row)
    }

    /// A jump is where both ends of the gearbox carry the same torque, and moves with the external
    /// torque, or where the motor torque changes its sign.
    fn jump(&self, motor: f64) -> Row {
        let external = self.sample.external_torque.value;
        let opposed = (motor + external).abs() <= 4.0 * ROUNDING * external.abs();
        let by_external = if opposed { -1.0 } else { 0.0 };
        Row { outcome: Outcome::Jump(motor - self.load), gain: 0.0, by_external }
    }
}

/// An interval of motor torques in which the excess changes its sign, once that is known.
struct Bracket {
    /// End at which the excess has its initial sign.
    near: f64,
    /// End at which it has the other sign, or is not yet evaluated.
    far: f64,
    sign: f64,
    is_seen: bool,
    widened: usize,
}

impl Bracket {
    fn from(first: &Imbalance) -> Self {
        let far = first.motor + MAX_AMPLIFIED * first.excess;
        Self { near: first.motor, far, sign: first.excess, is_seen: false, widened: 0 }
    }

    fn contains(&self, motor: f64) -> bool {
        (motor - self.near) * (motor - self.far) < 0.0
    }

    /// The next point if there is no better one.
    fn next(&self) -> f64 {
        if self.is_seen { 0.5 * (self.near + self.far) } else { self.far }
    }

    fn narrow(&mut self, tried: &Imbalance) {
        if tried.excess * self.sign <= 0.0 {
            (self.far, self.is_seen) = (tried.motor, true);
            return;
        }
        self.near = tried.motor;
        if !self.is_seen && tried.motor == self.far {
            self.far += MAX_AMPLIFIED * tried.excess;
            self.widened += 1;
        }
    }

    fn is_closed(&self, load: f64) -> bool {
        let size = self.near.abs() + self.far.abs() + load.abs();
        self.is_seen && (self.far - self.near).abs() <= ROUNDING * size
    }
}
