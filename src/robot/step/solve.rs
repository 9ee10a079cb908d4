//! The equations of a piece: mean velocities at which load and friction are the motor torque.
//!
//! Load is taken as linear about the last mean velocities, which converges within a few rounds.
//! Each round solves the joints one after the other with the equation of a single joint, which
//! finds what sticks, and all that slide at once by Newton's method, which converges fast.

use super::{Axis, Mode, Step};
use crate::joint::{Equation, Number, mean_friction, required, rounding};
use crate::robot::mass::solve_definite;
use crate::sample::Sample;

/// A speed (rad/s or m/s) that stands for the onset of motion in the friction law.
const EDGE: f64 = 1e-30;
/// Rounds with the loads of the rigid bodies, sweeps over the joints within each, and Newton steps
/// after each sweep.
const ROUNDS: usize = 40;
const SWEEPS: usize = 60;
const STEPS: usize = 8;
/// Halvings of a Newton step.
const HALVINGS: usize = 4;
/// Rounding errors of a torque, in units in the last place of its largest term.
const SLACK: f64 = 16.0;
/// The least by which the load's own growth counts where friction grows with the load.
const LEAST_GROWTH: f64 = 0.1;
/// Bounds of speeds, in speeds that all torques together would give.
const FARTHEST: f64 = 100.0;

impl<P: Number> Step<'_, '_, P> {
    /// Magnitude of the terms of a joint's equation (N m or N).
    fn size(&self, joint: usize) -> P {
        let axis = &self.axes[joint];
        let speeds = axis.mean.abs() + axis.velocity.abs();
        self.pushed.motor[joint].abs() + axis.load.abs() + self.own(joint) * speeds
    }

    /// Means of a joint over a piece of length `h`, at another mean velocity of it alone.
    pub(super) fn sample(&self, joint: usize, mean: P, h: P) -> Sample<P> {
        let half = h * P::from_f64(0.5);
        let axis = &self.axes[joint];
        Sample {
            velocity: mean,
            position: axis.position + mean * half,
            acceleration: (mean - axis.velocity) / half,
            temperature: self.pushed.temperature[joint],
            load_torque: axis.load + self.own(joint) * (mean - axis.mean),
            load_torque_curvature: P::zero(),
            temperature_rate: P::zero(),
            motor_torque: self.pushed.motor[joint],
            external_torque: P::zero(),
            time: self.pushed.time + self.elapsed + half,
        }
    }

    /// Mean friction at a sample (N m or N); dry friction against `direction`, if there is one.
    fn friction(&self, joint: usize, sample: &Sample<P>, h: P, direction: Option<P>) -> P {
        let edge = P::from_f64(EDGE);
        let velocity = match direction {
            Some(direction) if sample.velocity * direction < edge => direction * edge,
            _ => sample.velocity,
        };
        let acting = Sample { velocity, ..*sample };
        mean_friction(&self.moving.friction[joint], &self.states[joint], &acting, h)
    }

    /// Friction minus the friction that the motion requires, at another mean velocity of a joint.
    fn excess(&self, joint: usize, mean: P, h: P, direction: Option<P>) -> P {
        let sample = self.sample(joint, mean, h);
        self.friction(joint, &sample, h, direction) - required(&sample)
    }

    /// The direction that dry friction acts against.
    fn direction(&self, joint: usize) -> Option<P> {
        match self.axes[joint].mode {
            Mode::Any | Mode::Held | Mode::Stops => None,
            Mode::Along(direction) | Mode::Breaks(direction) => Some(direction),
        }
    }

    /// Mean velocities over a piece of length `h` in which no joint stops.
    pub(super) fn solve(&mut self, h: P) {
        self.weigh(h);
        self.bound_speeds(h);
        for round in 0..ROUNDS {
            if round > 0 {
                self.find_load(h);
            }
            let settled = self.solve_linear(h);
            let moved = (0..self.axes.len()).any(|joint| {
                let axis = &self.axes[joint];
                let change = self.own(joint) * (axis.mean - axis.about).abs();
                change > self.size(joint) * rounding::<P>() * P::from_f64(SLACK)
            });
            if !moved {
                self.solved = self.solved && settled;
                return;
            }
        }
        self.solved = false;
    }

    /// The same with the linear load; whether it is solved to rounding.
    fn solve_linear(&mut self, h: P) -> bool {
        for _ in 0..SWEEPS {
            if !self.sweep(h) {
                return true;
            }
            self.newton(h);
        }
        false
    }

    /// Solves the equation of each joint in turn; whether one changed by more than rounding.
    fn sweep(&mut self, h: P) -> bool {
        let mut moved = false;
        for joint in 0..self.axes.len() {
            let before = self.axes[joint].mode;
            let mean = self.alone(joint, h);
            let change = self.own(joint) * (mean - self.axes[joint].mean).abs();
            moved |= change > self.size(joint) * rounding::<P>() * P::from_f64(SLACK)
                || self.axes[joint].mode != before;
            self.shift(joint, mean);
        }
        moved
    }

    /// The mean velocity at which a joint's equation holds, the others' given; also whether a joint
    /// at rest is held.
    fn alone(&mut self, joint: usize, h: P) -> P {
        let zero = P::zero();
        if self.axes[joint].mode == Mode::Stops {
            return self.axes[joint].velocity * P::from_f64(0.5);
        }
        if matches!(self.axes[joint].mode, Mode::Held | Mode::Breaks(_)) {
            let one = P::one();
            let breaks = [one, -one].into_iter().find(|direction| {
                self.excess(joint, zero, h, Some(*direction)) * *direction < zero
            });
            match breaks {
                None => {
                    self.axes[joint].mode = Mode::Held;
                    return zero;
                }
                Some(direction) => self.axes[joint].mode = Mode::Breaks(direction),
            }
        }
        let direction = self.direction(joint);
        let start = match self.axes[joint].mode {
            Mode::Breaks(direction) if self.axes[joint].mean * direction < zero => zero,
            _ => self.axes[joint].mean,
        };
        let excess = |mean| self.excess(joint, mean, h, direction);
        let (slope, size, reach) = (self.own(joint), self.size(joint), self.axes[joint].reach);
        let value = excess(start);
        let found = match direction {
            None => Equation { start, value, slope, size }.solve(excess),
            Some(d) => {
                let forward = Equation { start: start * d, value: value * d, slope, size };
                forward
                    .solve_above(-reach, |speed| excess(speed * d) * d)
                    .map_or(-reach * d, |s| s * d)
            }
        };
        if found.abs() <= reach {
            found
        } else if found > reach {
            reach
        } else {
            // Also where it is not a number.
            -reach
        }
    }

    /// Finds speeds that the mean velocities do not exceed while friction dissipates: those that all
    /// torques would give, many times. Friction that grows faster with the load than the load itself
    /// has no solution, and would lead beyond any speed.
    fn bound_speeds(&mut self, h: P) {
        for axis in self.axes.iter_mut() {
            if !axis.mode.is_given() {
                axis.mean = axis.velocity;
            }
        }
        self.find_load(h);
        let mut sum = P::zero();
        for joint in 0..self.axes.len() {
            let sample = self.sample(joint, self.axes[joint].mean, h);
            let friction = self.friction(joint, &sample, h, self.direction(joint));
            let torques = sample.motor_torque.abs() + sample.load_torque.abs() + friction.abs();
            let root = self.own(joint).sqrt();
            sum += root * sample.velocity.abs() + torques / root;
        }
        for joint in 0..self.axes.len() {
            self.axes[joint].reach = sum * P::from_f64(FARTHEST) / self.own(joint).sqrt();
        }
    }

    /// Newton steps for all joints that are not held, while they help.
    fn newton(&mut self, h: P) {
        for joint in 0..self.axes.len() {
            self.axes[joint].scale = self.size(joint);
        }
        let mut left = self.lack(h);
        for _ in 0..STEPS {
            if left <= rounding::<P>() * P::from_f64(4.0) || !self.newton_step(h) {
                return;
            }
            for axis in self.axes.iter_mut() {
                axis.kept = [axis.mean, axis.load];
            }
            let mut share = P::one();
            let before = left;
            for _ in 0..HALVINGS {
                self.shift_all(share);
                let now = self.lack(h);
                if now < left {
                    left = now;
                    break;
                }
                share *= P::from_f64(0.5);
            }
            if left == before {
                self.shift_all(P::zero());
                return;
            }
        }
    }

    /// Takes a share of the Newton step.
    fn shift_all(&mut self, share: P) {
        for axis in self.axes.iter_mut() {
            [axis.mean, axis.load] = axis.kept;
        }
        if share.is_zero() {
            return;
        }
        for joint in 0..self.axes.len() {
            let Axis { mean, change, .. } = self.axes[joint];
            self.shift(joint, mean + change * share);
        }
    }

    /// The largest error of an equation of a joint whose mean velocity is sought, as a share of its
    /// terms at the start.
    fn lack(&self, h: P) -> P {
        let mut largest = P::zero();
        for joint in 0..self.axes.len() {
            if self.axes[joint].mode.is_given() {
                continue;
            }
            let (mean, direction) = (self.axes[joint].mean, self.direction(joint));
            let lack = self.excess(joint, mean, h, direction).abs() / self.axes[joint].scale;
            // A lack that is not a number is the largest.
            if lack > largest || !lack.value().is_finite() {
                largest = lack;
            }
        }
        largest
    }

    /// The Newton step of each joint; `false` if its matrix is not positive definite.
    fn newton_step(&mut self, h: P) -> bool {
        let n = self.axes.len();
        for joint in 0..n {
            let (rest, slope) = self.linearised(joint, h);
            (self.axes[joint].change, self.axes[joint].slope) = (rest, slope);
        }
        let (matrix, rest) = self.room.numbers.split_at_mut(n * n);
        let (work, right) = rest.split_at_mut(n * n);
        let right = &mut right[..n];
        work.copy_from_slice(matrix);
        for (k, axis) in self.axes.iter().enumerate() {
            right[k] = axis.change;
            work[k * n + k] += axis.slope;
            if axis.mode.is_given() {
                for j in 0..n {
                    (work[k * n + j], work[j * n + k]) = (P::zero(), P::zero());
                }
                (work[k * n + k], right[k]) = (P::one(), P::zero());
            }
        }
        if !solve_definite(work, right) {
            return false;
        }
        for (axis, change) in self.axes.iter_mut().zip(right.iter()) {
            axis.change = *change;
        }
        right.iter().all(|change| change.value().is_finite())
    }

    /// What is left of a joint's equation, and the slope of its friction: both over the growth of
    /// friction and load with the load.
    fn linearised(&self, joint: usize, h: P) -> (P, P) {
        let (axis, direction) = (&self.axes[joint], self.direction(joint));
        let (one, size) = (P::one(), self.size(joint));
        let small = if rounding::<P>() > P::from_f64(1e-10) { 3e-4 } else { 1e-8 };
        let more = size * P::from_f64(small);
        let sample = self.sample(joint, axis.mean, h);
        let here = self.friction(joint, &sample, h, direction);
        let loaded = Sample { load_torque: sample.load_torque + more, ..sample };
        let growth = one + (self.friction(joint, &loaded, h, direction) - here) / more;
        let least = P::from_f64(LEAST_GROWTH);
        let growth = if growth > least { growth } else { least };
        let faster = more / self.own(joint);
        let load_torque = sample.load_torque;
        let moved = Sample { load_torque, ..self.sample(joint, axis.mean + faster, h) };
        let slope = (self.friction(joint, &moved, h, direction) - here) / faster;
        ((required(&sample) - here) / growth, slope / growth)
    }
}
