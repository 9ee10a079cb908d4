//! Friction feedforward in a controller: the torque to add to the motor torque, with invalid
//! readings handled.
//!
//! | reading | torque | state |
//! |---|---|---|
//! | valid | the law's torque at the end of the step, limited | advances |
//! | the first valid one, or first after a dropout | as after a long time at its velocity | restarts |
//! | missing, NaN, infinite or too fast | the last torque, up to `held` times | unchanged |
//! | the same, more often | 0 | discarded |
//!
//! Each call takes the same time, except the first after a dropout, which takes one more step. The
//! state receives finite numbers only; that of a bristle stays within the largest `D/s0`.

use crate::composed::Composed;
use crate::dynamics::{Interval, LONG, State};
use crate::error::ModelError;
use crate::fixed::FixedLaw;
use crate::law::FrictionLaw;
use crate::sample::Sample;
use crate::scalar::Scalar;
use crate::table::Channel;

/// Friction with its parameters, evaluated sample by sample.
pub trait Friction<S: Scalar> {
    /// The torque (T) at the end of a step of `dt` (s) at `sample`.
    fn torque(&self, state: &mut State<S>, sample: &Sample<S>, dt: S) -> S;
}

impl<S: Scalar<Plain = S>, L: FrictionLaw<S>> Friction<S> for FixedLaw<L, S> {
    #[inline]
    fn torque(&self, state: &mut State<S>, sample: &Sample<S>, dt: S) -> S {
        FixedLaw::torque(self, state, sample, dt)
    }
}

impl<S: Scalar<Plain = S>> Friction<S> for Composed<S> {
    #[inline]
    fn torque(&self, state: &mut State<S>, sample: &Sample<S>, dt: S) -> S {
        self.step_acting(state, &Interval::constant(self.acting(sample), dt)).torque
    }
}

/// The limits of a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<S> {
    /// Largest torque (T).
    pub torque: S,
    /// Largest speed of the joint (X/s): a reading above it is invalid.
    pub speed: S,
    /// Number of consecutive invalid readings for which the last torque is held.
    pub held: u32,
}

/// The origin of a torque.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The law.
    Law,
    /// The law, limited.
    Limit,
    /// The last valid reading.
    Last,
    /// None: no valid reading is recent enough.
    None,
}

/// The torque to add to the motor torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feed<S> {
    /// The torque (T).
    pub torque: S,
    /// Its origin.
    pub source: Source,
}

/// Friction of one joint, sampled at a fixed period.
///
/// ```
/// use stribeck::law::Coulomb;
/// use stribeck::{Feedforward, FixedLaw, Limits, Sample, Source};
///
/// let law = FixedLaw::new(Coulomb { viscous_friction: 0.5_f32, coulomb_friction: 2.0 });
/// let limits = Limits { torque: 10.0, speed: 6.0, held: 1 };
/// let mut friction = Feedforward::new(law, 2.5e-4, limits)?;
/// assert_eq!(friction.next(Some(&Sample::at(1.0))).torque, 2.5);
/// assert_eq!(friction.next(Some(&Sample::at(f32::NAN))).torque, 2.5);
/// assert_eq!(friction.next(None).source, Source::None);
/// # Ok::<(), stribeck::ModelError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Feedforward<F, S: Scalar> {
    friction: F,
    period: S,
    limits: Limits<S>,
    state: State<S>,
    last: Option<S>,
    missed: u32,
}

impl<S: Scalar<Plain = S> + PartialOrd, F: Friction<S>> Feedforward<F, S> {
    /// A joint without readings yet; `period` in s.
    ///
    /// # Errors
    /// A period or limit that is not a positive number.
    pub fn new(friction: F, period: S, limits: Limits<S>) -> Result<Self, ModelError<'static>> {
        for (name, x) in
            [("period", period), ("torque limit", limits.torque), ("speed limit", limits.speed)]
        {
            if !(x.is_finite() && x > S::zero()) {
                return Err(ModelError::Constant(name, x.value()));
            }
        }
        Ok(Self { friction, period, limits, state: State::default(), last: None, missed: 0 })
    }

    /// The torque to add until the next sample; `None` for a missing reading. All channels of a
    /// reading must be finite: leave those that the law does not read at 0.
    #[inline]
    pub fn next(&mut self, reading: Option<&Sample<S>>) -> Feed<S> {
        match reading {
            Some(sample) if self.can_be(sample) => self.follow(sample),
            _ => self.bridge(),
        }
    }

    /// The state of the law.
    #[must_use]
    pub const fn state(&self) -> &State<S> {
        &self.state
    }

    #[inline]
    fn can_be(&self, sample: &Sample<S>) -> bool {
        let finite = Channel::ALL.iter().all(|&channel| sample.channel(channel).is_finite());
        finite && sample.velocity.abs() <= self.limits.speed
    }

    #[inline]
    fn follow(&mut self, sample: &Sample<S>) -> Feed<S> {
        if self.last.is_none() {
            self.begin(sample);
        }
        let torque = self.friction.torque(&mut self.state, sample, self.period);
        if !torque.is_finite() {
            return self.stop();
        }
        let limit = self.limits.torque;
        let (torque, source) = if torque.abs() > limit {
            (torque.sign() * limit, Source::Limit)
        } else {
            (torque, Source::Law)
        };
        (self.last, self.missed) = (Some(torque), 0);
        Feed { torque, source }
    }

    /// The state after a long time at this velocity; a relaxed one at rest.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, sample: &Sample<S>) {
        self.state = State::default();
        self.friction.torque(&mut self.state, sample, S::from_f64(LONG));
    }

    #[cold]
    fn bridge(&mut self) -> Feed<S> {
        match self.last {
            Some(torque) if self.missed < self.limits.held => {
                self.missed += 1;
                Feed { torque, source: Source::Last }
            }
            _ => self.stop(),
        }
    }

    #[cold]
    fn stop(&mut self) -> Feed<S> {
        (self.state, self.last, self.missed) = (State::default(), None, 0);
        Feed { torque: S::zero(), source: Source::None }
    }
}
