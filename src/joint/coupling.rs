//! A step of a body and its friction together.
//!
//! A model with a memory has one friction torque for each velocity, and one equation. A model
//! without one holds the joint at rest by any torque up to its level: then a step falls into pieces,
//! sliding until rest, rest, and sliding away from it, each with its own equation. So a joint that
//! sticks stands exactly still.

use super::body::Body;
use super::root::Equation;
use crate::composed::Composed;
use crate::dynamics::{Interval, Memory, State};
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
    /// It moves at this mean velocity to the end of the step.
    Slides(P),
    /// It comes to rest, after this time.
    Stops(P),
}

impl<P: Scalar<Plain = P> + PartialOrd, B: Body<P>> Course<'_, P, B> {
    /// Mean friction torque over a piece, from the present state.
    fn friction(&self, sample: &Sample<P>, h: P) -> P {
        let mut state = *self.state;
        friction_over(self.model, &mut state, sample, h)
    }

    /// Friction in excess of what a mean velocity over a piece asks for (T): zero where it is right.
    fn excess(&self, velocity: P, h: P) -> P {
        let sample = self.body.sample(velocity, h);
        self.friction(&sample, h) - required(&sample)
    }

    /// Size of what is summed in `excess` (T).
    fn size(&self, velocity: P, h: P) -> P {
        let sample = self.body.sample(velocity, h);
        let momentum = self.body.inertia() * (velocity.abs() + self.body.velocity().abs()) / h;
        sample.motor_torque.abs() + sample.external_torque.abs() + momentum
    }

    /// Least growth of `excess` with the velocity (T s/X).
    fn slope(&self, h: P) -> P {
        self.body.inertia() / (h * P::from_f64(0.5))
    }

    fn at_once(&mut self) {
        let (start, h) = (self.body.velocity(), self.dt);
        let equation = Equation { start, slope: self.slope(h), size: self.size(start, h) };
        let velocity = equation.solve(|velocity| self.excess(velocity, h));
        self.go(velocity, h);
    }

    fn in_pieces(&mut self) {
        let mut left = self.dt;
        if self.body.velocity().abs() <= P::from_f64(EDGE) {
            self.body.rest();
        }
        for _ in 0..MOST_PIECES {
            match self.piece(left) {
                Piece::Slides(velocity) => return self.go(velocity, left),
                Piece::Held => break,
                Piece::Stops(after) => {
                    self.go(self.body.velocity() * P::from_f64(0.5), after);
                    self.body.rest();
                    left = left - after;
                    if left <= P::zero() {
                        return;
                    }
                }
            }
        }
        // At rest friction is whatever that asks for.
        self.go(P::zero(), left);
    }

    /// What a piece that may last for `h` begins with.
    fn piece(&self, h: P) -> Piece<P> {
        let (velocity, half) = (self.body.velocity(), P::from_f64(0.5));
        if velocity.is_zero() {
            return match self.way_out(h) {
                Some(direction) => Piece::Slides(self.slide(direction, P::zero(), h)),
                None => Piece::Held,
            };
        }
        let (direction, slowest) = (velocity.sign(), velocity * half);
        // Halfway to rest on average: slower than that, and it is at rest before the end.
        if self.excess(slowest, h) * direction < P::zero() {
            Piece::Slides(self.slide(direction, slowest, h))
        } else {
            Piece::Stops(self.time_to_rest(slowest, h))
        }
    }

    /// Which way a joint at rest breaks loose; `None` where friction holds it.
    fn way_out(&self, h: P) -> Option<P> {
        let needed = required(&self.body.sample(P::zero(), h));
        let level = |direction: P| {
            let sample = Sample {
                velocity: direction * P::from_f64(EDGE),
                ..self.body.sample(P::zero(), h)
            };
            self.friction(&sample, h)
        };
        let one = P::one();
        if needed > level(one) {
            Some(one)
        } else if needed < level(-one) {
            Some(-one)
        } else {
            None
        }
    }

    /// Mean velocity along `direction`, at least `slowest`.
    fn slide(&self, direction: P, slowest: P, h: P) -> P {
        let edge = P::from_f64(EDGE);
        let equation = Equation {
            start: (slowest * direction).abs(),
            slope: self.slope(h),
            size: self.size(slowest, h),
        };
        let speed = equation.solve(|speed| {
            let speed = if speed > edge { speed } else { edge };
            self.excess(speed * direction, h) * direction
        });
        speed * direction
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
        let equation =
            Equation { start: speed / h, slope: self.body.inertia(), size: self.size(mean, h) };
        time(equation.solve(|deceleration| -(self.excess(mean, time(deceleration)) * direction)))
    }

    /// Goes through a piece: friction is what it asks for, and that is what the model gives, to
    /// rounding, or between both sides where friction jumps with the load.
    fn go(&mut self, velocity: P, h: P) {
        let sample = self.body.sample(velocity, h);
        friction_over(self.model, self.state, &sample, h);
        self.taken.add(&sample, required(&sample), h, self.dt);
        self.body.advance(velocity, h);
    }
}

/// Friction that goes with a sample (T).
pub(super) fn required<P: Scalar + PartialOrd>(sample: &Sample<P>) -> P {
    sample.motor_torque - sample.load_torque
}

/// Mean friction torque as a sample is held for `h`; the state goes along.
pub(super) fn friction_over<P: Scalar<Plain = P> + PartialOrd>(
    model: &Composed<P>,
    state: &mut State<P>,
    sample: &Sample<P>,
    h: P,
) -> P {
    let interval = Interval { mean: true, ..Interval::held(*sample, h) };
    model.over(state, &interval).mean_torque
}
