//! The pieces of a step: they end where a joint stops.

use super::{Mode, Step};
use crate::dynamics::Memory;
use crate::joint::{Equation, JointStep, Number, advance_state, required};

/// A speed (rad/s or m/s) below which a joint is at rest.
const EDGE: f64 = 1e-30;
/// At the end of a piece that ends in rest, a joint below this speed, relative to the start of the
/// piece, is at rest.
const STOPPED: f64 = 1e-9;
/// Friction that grows faster with the load than the load itself stops a joint at once: in this
/// share of a step.
const JAMMED: f64 = 1e-9;

impl<P: Number> Step<'_, '_, P> {
    /// A step of `dt` (s), and means over it.
    pub(super) fn over(&mut self, dt: P, result: &mut [JointStep<P>]) {
        // Every joint may stop and break away; the rest of the step is computed like the last piece.
        let most = 2 * self.axes.len() + 1;
        for piece in 1..=most {
            let left = dt - self.elapsed;
            if left <= P::zero() {
                return;
            }
            self.begin();
            let h = self.piece(left, piece < most);
            self.advance(result, h, dt);
            self.elapsed += h;
            if h == left {
                return;
            }
        }
    }

    /// What each joint does at the start of a piece.
    fn begin(&mut self) {
        for (axis, friction) in self.axes.iter_mut().zip(self.moving.friction) {
            let resting = axis.velocity.abs() <= P::from_f64(EDGE);
            axis.mode = if !matches!(friction.memory(), Memory::None) {
                Mode::Any
            } else if resting {
                Mode::Held
            } else {
                Mode::Along(axis.velocity.sign())
            };
            axis.mean = if axis.mode == Mode::Held { P::zero() } else { axis.velocity };
        }
    }

    /// The length of the next piece, at most `left`, with the mean velocities over it.
    fn piece(&mut self, left: P, may_stop: bool) -> P {
        self.solve(left);
        if !may_stop || self.overshoot() < P::zero() {
            return left;
        }
        let one = P::one();
        let (start, size) = (P::from_f64(0.5), P::from_f64(0.25));
        let shortest = P::from_f64(JAMMED);
        let length = |share: P| left * if share < one { share } else { one };
        let mut overshoot = |share: P| {
            if share <= shortest {
                return -one;
            }
            self.solve(length(share));
            self.overshoot()
        };
        let value = overshoot(start);
        let share = Equation { start, value, slope: one, size }.solve(&mut overshoot);
        let h = length(if share > shortest { share } else { shortest });
        self.solve(h);
        for axis in self.axes.iter_mut() {
            if let Mode::Along(direction) = axis.mode {
                let after = axis.mean + axis.mean - axis.velocity;
                if after * direction <= P::from_f64(STOPPED) * axis.velocity.abs() {
                    axis.mode = Mode::Stops;
                }
            }
        }
        self.solve(h);
        h
    }

    /// How far the velocity of a joint has passed zero at the end of a piece, relative to its start,
    /// the largest of all: negative while all keep their direction.
    fn overshoot(&self) -> P {
        let mut largest = -P::one();
        for axis in self.axes.iter() {
            let Mode::Along(direction) = axis.mode else { continue };
            let twice = axis.mean + axis.mean;
            let beyond = (axis.velocity - twice) * direction / axis.velocity.abs();
            if beyond > largest {
                largest = beyond;
            }
        }
        largest
    }

    /// Advances postures, states and results by a piece.
    fn advance(&mut self, result: &mut [JointStep<P>], h: P, dt: P) {
        for (joint, result) in result.iter_mut().enumerate() {
            let sample = self.sample(joint, self.axes[joint].mean, h);
            advance_state(&self.moving.friction[joint], &mut self.states[joint], &sample, h);
            result.add(&sample, required(&sample), h, dt);
        }
        for axis in self.axes.iter_mut() {
            axis.position += axis.mean * h;
            axis.velocity = if axis.mode.is_given() {
                P::zero()
            } else {
                axis.mean + axis.mean - axis.velocity
            };
        }
    }
}
