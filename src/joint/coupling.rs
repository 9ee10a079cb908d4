//! One step of a body with friction.
//!
//! A model with a state has one friction torque for each velocity, which gives one equation. A
//! model without one holds the joint at rest with any torque up to its level: a step then falls
//! into pieces, sliding to rest, sticking, and sliding again, each with its own equation. A joint
//! that sticks is exactly at rest.

use super::body::Body;
use super::root::Equation;
use crate::composed::Composed;
use crate::dynamics::{Memory, State};
use crate::sample::Sample;
use crate::scalar::Scalar;

/// Pieces of a step: stop, break away, stop again; the rest of the step is spent at rest.
const MAX_PIECES: usize = 3;
/// A speed (X/s) that stands for the onset of motion in the friction law.
const EDGE: f64 = 1e-30;

/// Friction that grows faster with the load than the load itself stops a joint at once: in this
/// share of a step.
const JAMMED: f64 = 1e-9;

/// The result of a step: means over it (T), and work (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointStep<P> {
    /// Mean friction torque.
    pub friction: P,
    /// Mean load torque; its sum with friction is the mean motor torque.
    pub load: P,
    /// Work of the motor.
    pub motor_work: P,
    /// Work of external torque and gravity.
    pub environment_work: P,
    /// Work against friction: dissipated, or stored in bristles.
    pub friction_work: P,
}

impl<P: Scalar + PartialOrd> JointStep<P> {
    /// Nothing has moved.
    #[must_use]
    pub fn at_rest() -> Self {
        let zero = P::zero();
        Self {
            friction: zero,
            load: zero,
            motor_work: zero,
            environment_work: zero,
            friction_work: zero,
        }
    }

    /// Adds a piece of length `h` of a step of length `dt`.
    pub(crate) fn add(&mut self, sample: &Sample<P>, friction: P, h: P, dt: P) {
        let (share, way) = (h / dt, sample.velocity * h);
        self.friction += friction * share;
        self.load += sample.load_torque * share;
        self.motor_work += sample.motor_torque * way;
        self.environment_work += sample.external_torque * way;
        self.friction_work += friction * way;
    }
}

/// Advances `body` by `dt` (s) with friction `model`, and its `state`; with `dt <= 0` nothing
/// changes.
pub fn step<P: Scalar<Plain = P> + PartialOrd>(
    model: &Composed<P>,
    state: &mut State<P>,
    body: &mut impl Body<P>,
    dt: P,
) -> JointStep<P> {
    let mut step = StepInProgress { model, state, body, dt, result: JointStep::at_rest() };
    if dt <= P::zero() {
        return step.result;
    }
    if matches!(model.memory(), Memory::None) {
        step.in_pieces();
    } else {
        step.in_one_piece();
    }
    step.result
}

/// A step in progress.
struct StepInProgress<'a, P: Scalar + PartialOrd, B> {
    model: &'a Composed<P>,
    state: &'a mut State<P>,
    body: &'a mut B,
    dt: P,
    result: JointStep<P>,
}

/// What happens in a piece of a step.
enum Piece<P> {
    /// Friction holds the joint at rest.
    Held,
    /// The joint moves until the end of the step, with these means.
    Slides(Sample<P>),
    /// The joint comes to rest after this time (s).
    Stops(P),
}

impl<P: Scalar<Plain = P> + PartialOrd, B: Body<P>> StepInProgress<'_, P, B> {
    /// Mean friction torque over a piece, from the present state (T).
    fn friction(&self, sample: &Sample<P>, h: P) -> P {
        mean_friction(self.model, self.state, sample, h)
    }

    /// Friction minus the friction that the motion requires (T).
    fn excess(&self, sample: &Sample<P>, h: P) -> P {
        self.friction(sample, h) - required(sample)
    }

    /// Magnitude of the terms of `excess` (T).
    fn size(&self, sample: &Sample<P>, h: P) -> P {
        let speeds = sample.velocity.abs() + self.body.velocity().abs();
        let momentum = self.body.inertia() * speeds / h;
        sample.motor_torque.abs() + sample.external_torque.abs() + momentum
    }

    fn in_one_piece(&mut self) {
        let (h, unbounded) = (self.dt, P::from_f64(f64::NEG_INFINITY));
        let first = self.body.sample(self.body.velocity(), h);
        let value = self.excess(&first, h);
        let means = self.slide(P::one(), &first, value, unbounded, h).unwrap_or(first);
        self.advance(&means, h);
    }

    fn in_pieces(&mut self) {
        let mut left = self.dt;
        if self.body.velocity().abs() <= P::from_f64(EDGE) {
            self.body.rest();
        }
        for _ in 0..MAX_PIECES {
            match self.piece(left) {
                Piece::Slides(means) => return self.advance(&means, left),
                Piece::Held => break,
                Piece::Stops(after) => {
                    let mean = self.body.velocity() * P::from_f64(0.5);
                    self.advance(&self.body.sample(mean, after), after);
                    self.body.rest();
                    left = left - after;
                    if left <= P::zero() {
                        return;
                    }
                }
            }
        }
        // At rest friction balances the other torques.
        self.advance(&self.body.sample(P::zero(), left), left);
    }

    /// What happens first in the next `h` (s).
    fn piece(&self, h: P) -> Piece<P> {
        let velocity = self.body.velocity();
        if velocity.is_zero() {
            return self.break_away(h);
        }
        let (direction, slowest) = (velocity.sign(), velocity * P::from_f64(0.5));
        let first = self.body.sample(velocity, h);
        let value = self.excess(&first, h);
        // A slower mean velocity reaches zero before the end of the piece.
        match self.slide(direction, &first, value, slowest.abs(), h) {
            Some(means) => Piece::Slides(means),
            None => Piece::Stops(self.time_to_rest(slowest, h)),
        }
    }

    /// A joint at rest: it breaks away where friction cannot hold it.
    fn break_away(&self, h: P) -> Piece<P> {
        let first = self.body.sample(P::zero(), h);
        for direction in [P::one(), -P::one()] {
            let velocity = direction * P::from_f64(EDGE);
            let value = self.friction(&Sample { velocity, ..first }, h) - required(&first);
            if value * direction < P::zero() {
                let means = self.slide(direction, &first, value, P::zero(), h).unwrap_or(first);
                return Piece::Slides(means);
            }
        }
        Piece::Held
    }

    /// Means over a piece of sliding along `direction`, faster than `slowest`, given those at the
    /// `first` velocity and the excess of friction there; `None` if there is none.
    fn slide(
        &self,
        direction: P,
        first: &Sample<P>,
        value: P,
        slowest: P,
        h: P,
    ) -> Option<Sample<P>> {
        let equation = Equation {
            start: first.velocity * direction,
            value: value * direction,
            slope: self.body.inertia() / (h * P::from_f64(0.5)),
            size: self.size(first, h),
        };
        let mut last = *first;
        let speed = equation.solve_above(slowest, |speed| {
            last = self.body.sample(speed * direction, h);
            self.excess(&last, h) * direction
        })?;
        let velocity = speed * direction;
        // The search has nearly always evaluated its result last.
        Some(if velocity == last.velocity { last } else { self.body.sample(velocity, h) })
    }

    /// The time until rest at half the velocity on average, if it is within `h` (s).
    fn time_to_rest(&self, mean: P, h: P) -> P {
        let (direction, speed) = (mean.sign(), (mean + mean).abs());
        let shortest = h * P::from_f64(JAMMED);
        let time = |deceleration: P| {
            let time = speed / deceleration;
            if time < shortest {
                shortest
            } else if time < h {
                time
            } else {
                h
            }
        };
        let lack = |sample: &Sample<P>, h: P| -(self.excess(sample, h) * direction);
        let first = self.body.sample(mean, h);
        let equation = Equation {
            start: speed / h,
            value: lack(&first, h),
            slope: self.body.inertia(),
            size: self.size(&first, h),
        };
        time(equation.solve(|deceleration| {
            let h = time(deceleration);
            lack(&self.body.sample(mean, h), h)
        }))
    }

    /// Advances by a piece. Friction is what the motion requires: up to rounding that of the model,
    /// or between its limits where friction jumps with the load.
    fn advance(&mut self, means: &Sample<P>, h: P) {
        advance_state(self.model, self.state, means, h);
        self.result.add(means, required(means), h, self.dt);
        self.body.advance(means.velocity, h);
    }
}

/// Friction that a motion with these means requires (T).
pub(crate) fn required<P: Scalar + PartialOrd>(sample: &Sample<P>) -> P {
    sample.motor_torque - sample.load_torque
}

/// Mean friction torque over `h` (s) at this sample; the state is left unchanged.
pub(crate) fn mean_friction<P: Scalar<Plain = P> + PartialOrd>(
    model: &Composed<P>,
    state: &State<P>,
    sample: &Sample<P>,
    h: P,
) -> P {
    if model.has_state() {
        let mut state = *state;
        model.step(&mut state, sample, h).mean_torque
    } else {
        model.acting_torque(sample)
    }
}

/// Advances the state by `h` (s) at this sample.
pub(crate) fn advance_state<P: Scalar<Plain = P> + PartialOrd>(
    model: &Composed<P>,
    state: &mut State<P>,
    sample: &Sample<P>,
    h: P,
) {
    if model.has_state() {
        model.step(state, sample, h);
    }
}
