//! A step of a body and its friction together.
//!
//! A model with a memory has one friction torque for each velocity, and one equation. A model
//! without one holds the joint at rest by any torque up to its level: then a step falls into pieces,
//! sliding until rest, rest, and sliding away from it, each with its own equation. So a joint that
//! sticks stands exactly still.

use super::body::Body;
use super::root::Equation;
use crate::composed::Composed;
use crate::dynamics::{Memory, State};
use crate::sample::Sample;
use crate::scalar::Scalar;

/// Pieces of a step: stop, go, stop again; what is left after that is spent at rest.
const MOST_PIECES: usize = 3;
/// A speed (X/s) at which friction is that at the edge of motion.
const EDGE: f64 = 1e-30;

/// Friction that grows faster with the load than the load itself stops a joint at once: in this
/// share of a step.
const JAMMED: f64 = 1e-9;

/// What a step took and gave: means over it (T), and work (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taken<P> {
    /// Mean friction torque.
    pub friction: P,
    /// Mean load torque: with friction, the mean motor torque.
    pub load: P,
    /// Work of the motor.
    pub motor_work: P,
    /// Work of the environment, gravity included.
    pub environment_work: P,
    /// Work that friction took: dissipated, or stored in bristles.
    pub friction_work: P,
}

impl<P: Scalar + PartialOrd> Taken<P> {
    pub(super) fn nothing() -> Self {
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
    pub(super) fn add(&mut self, sample: &Sample<P>, friction: P, h: P, dt: P) {
        let (share, way) = (h / dt, sample.velocity * h);
        self.friction += friction * share;
        self.load += sample.load_torque * share;
        self.motor_work += sample.motor_torque * way;
        self.environment_work += sample.external_torque * way;
        self.friction_work += friction * way;
    }
}

/// Moves `body` over `dt` (s) with friction `model`, whose `state` goes along; with `dt <= 0` nothing
/// moves.
pub fn step<P: Scalar<Plain = P> + PartialOrd>(
    model: &Composed<P>,
    state: &mut State<P>,
    body: &mut impl Body<P>,
    dt: P,
) -> Taken<P> {
    let mut course = Course { model, state, body, dt, taken: Taken::nothing() };
    if dt <= P::zero() {
        return course.taken;
    }
    if matches!(model.memory(), Memory::None) {
        course.in_pieces();
    } else {
        course.at_once();
    }
    course.taken
}

/// A step on its way.
struct Course<'a, P: Scalar + PartialOrd, B> {
    model: &'a Composed<P>,
    state: &'a mut State<P>,
    body: &'a mut B,
    dt: P,
    taken: Taken<P>,
}

/// What happens in a piece of a step.
enum Piece<P> {
    /// Friction holds the joint.
    Held,
    /// It moves to the end of the step, with these means.
    Slides(Sample<P>),
    /// It comes to rest, after this time.
    Stops(P),
}

impl<P: Scalar<Plain = P> + PartialOrd, B: Body<P>> Course<'_, P, B> {
    /// Mean friction torque over a piece, from the present state.
    fn friction(&self, sample: &Sample<P>, h: P) -> P {
        friction_from(self.model, self.state, sample, h)
    }

    /// Friction in excess of what the means over a piece ask for (T): zero where it is right.
    fn excess(&self, sample: &Sample<P>, h: P) -> P {
        self.friction(sample, h) - required(sample)
    }

    /// Size of what is summed in `excess` (T).
    fn size(&self, sample: &Sample<P>, h: P) -> P {
        let speeds = sample.velocity.abs() + self.body.velocity().abs();
        let momentum = self.body.inertia() * speeds / h;
        sample.motor_torque.abs() + sample.external_torque.abs() + momentum
    }

    fn at_once(&mut self) {
        let (h, unbounded) = (self.dt, P::from_f64(f64::NEG_INFINITY));
        let first = self.body.sample(self.body.velocity(), h);
        let value = self.excess(&first, h);
        let means = self.slide(P::one(), &first, value, unbounded, h).unwrap_or(first);
        self.go(&means, h);
    }

    fn in_pieces(&mut self) {
        let mut left = self.dt;
        if self.body.velocity().abs() <= P::from_f64(EDGE) {
            self.body.rest();
        }
        for _ in 0..MOST_PIECES {
            match self.piece(left) {
                Piece::Slides(means) => return self.go(&means, left),
                Piece::Held => break,
                Piece::Stops(after) => {
                    let mean = self.body.velocity() * P::from_f64(0.5);
                    self.go(&self.body.sample(mean, after), after);
                    self.body.rest();
                    left = left - after;
                    if left <= P::zero() {
                        return;
                    }
                }
            }
        }
        // At rest friction is whatever that asks for.
        self.go(&self.body.sample(P::zero(), left), left);
    }

    /// What a piece that may last for `h` begins with.
    fn piece(&self, h: P) -> Piece<P> {
        let velocity = self.body.velocity();
        if velocity.is_zero() {
            return self.break_away(h);
        }
        let (direction, slowest) = (velocity.sign(), velocity * P::from_f64(0.5));
        let first = self.body.sample(velocity, h);
        let value = self.excess(&first, h);
        // Halfway to rest on average: slower than that, and it is at rest before the end.
        match self.slide(direction, &first, value, slowest.abs(), h) {
            Some(means) => Piece::Slides(means),
            None => Piece::Stops(self.time_to_rest(slowest, h)),
        }
    }

    /// What a joint at rest does: it breaks loose where friction does not hold it.
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

    /// Means over a piece of sliding along `direction`, faster than `slowest`: from those at the
    /// `first` velocity and the excess of friction there.
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
        // Where the search ends has nearly always been looked at last.
        Some(if velocity == last.velocity { last } else { self.body.sample(velocity, h) })
    }

    /// How long a joint takes to rest, at half its velocity on average, if that is within `h`.
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

    /// Goes through a piece: friction is what its means ask for, and that is what the model gives, to
    /// rounding, or between both sides where friction jumps with the load.
    fn go(&mut self, means: &Sample<P>, h: P) {
        carry(self.model, self.state, means, h);
        self.taken.add(means, required(means), h, self.dt);
        self.body.advance(means.velocity, h);
    }
}

/// Friction that goes with a sample (T).
pub(super) fn required<P: Scalar + PartialOrd>(sample: &Sample<P>) -> P {
    sample.motor_torque - sample.load_torque
}

/// Mean friction torque as a sample is held for `h`, from a state that stays as it is.
pub(super) fn friction_from<P: Scalar<Plain = P> + PartialOrd>(
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

/// Takes the state through a sample that is held for `h`.
pub(super) fn carry<P: Scalar<Plain = P> + PartialOrd>(
    model: &Composed<P>,
    state: &mut State<P>,
    sample: &Sample<P>,
    h: P,
) {
    if model.has_state() {
        model.step(state, sample, h);
    }
}
