//! A planar arm with two joints in a horizontal plane (Indri et al., eq 4), with friction in both.
//!
//! The second angle is relative to the first link. With the coupling `h(q2)`,
//! `M = [[a + d + 2h, d + h], [d + h, d]]`. Over a step with mean velocities `w`, momentum changes
//! by `M+ v+ - M v`, and the second joint is loaded by the mean of `dT/dq2`,
//! `v+' N v dh/(2 dq2)` with `dM = N dh`: then kinetic energy changes exactly by the work of motors
//! and friction.

use super::coupling::{JointStep, advance_state, mean_friction, required};
use super::gravity::{Gravity, GravityAbout};
use super::root::Equation;
use crate::composed::Composed;
use crate::dynamics::{Memory, State};
use crate::sample::Sample;
use crate::scalar::Scalar;

/// Both joints may stop and break away in a step; after this many pieces the rest of the step is
/// computed like the last piece.
const MAX_PIECES: usize = 5;
/// A speed (rad/s) that stands for the onset of motion in the friction law.
const EDGE: f64 = 1e-30;
/// At the end of a piece that ends in rest, a joint below this speed, relative to the start of the
/// piece, is at rest.
const STOPPED: f64 = 1e-9;

/// The inertial parameters of eq 12.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarArm<P> {
    /// `Gamma_1z + m2 l1^2`, link 1 with link 2 at its end (kg m2).
    pub inertia_1: P,
    /// `Gamma_2z`, link 2 about its joint (kg m2).
    pub inertia_2: P,
    /// `l1 m2 s_2x`, first moment of link 2 along it, times the length of link 1 (kg m2).
    pub moment_x: P,
    /// `l1 m2 s_2y`, the same across it (kg m2).
    pub moment_y: P,
}

/// Positions and velocities of both joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPosture<P> {
    /// Angles (rad).
    pub position: [P; 2],
    /// Velocities (rad/s).
    pub velocity: [P; 2],
}

/// The inputs of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPush<P> {
    /// Motor torques (N m), constant over the step.
    pub motor: [P; 2],
    /// Joint temperatures (degC).
    pub temperature: [P; 2],
    /// Time at the start of the step (s).
    pub time: P,
}

/// The start of a piece of a step.
#[derive(Clone, Copy)]
struct Beginning<P> {
    velocity: [P; 2],
    second: P,
    /// `h` there, and its slope as a function of the angle from there.
    coupling: P,
    slope: GravityAbout<P>,
    momentum: [P; 2],
}

impl<P: Scalar<Plain = P> + PartialOrd> PlanarArm<P> {
    /// `h` has the form of the potential of gravity, its mean slope that of its torque.
    fn coupling(&self) -> Gravity<P> {
        Gravity { constant: P::zero(), cos: -self.moment_y, sin: -self.moment_x }
    }

    /// `M11`, `M12` and `M22` at the second angle (kg m2).
    #[must_use]
    pub fn inertia(&self, second: P) -> [P; 3] {
        self.inertia_with(self.coupling().potential(second))
    }

    fn inertia_with(&self, coupling: P) -> [P; 3] {
        let across = self.inertia_2 + coupling;
        [self.inertia_1 + across + coupling, across, self.inertia_2]
    }

    /// Kinetic energy (J).
    #[must_use]
    pub fn energy(&self, posture: &ArmPosture<P>) -> P {
        let coupling = self.coupling().potential(posture.position[1]);
        let momentum = self.momentum(coupling, posture.velocity);
        let [first, second] = posture.velocity;
        P::from_f64(0.5) * (momentum[0] * first + momentum[1] * second)
    }

    fn momentum(&self, coupling: P, [v1, v2]: [P; 2]) -> [P; 2] {
        let [own, across, other] = self.inertia_with(coupling);
        [own * v1 + across * v2, across * v1 + other * v2]
    }

    fn beginning(&self, posture: &ArmPosture<P>) -> Beginning<P> {
        let (velocity, second) = (posture.velocity, posture.position[1]);
        let coupling = self.coupling().potential(second);
        let (slope, momentum) = (self.coupling().about(second), self.momentum(coupling, velocity));
        Beginning { velocity, second, coupling, slope, momentum }
    }

    /// Mean torques that the motion over a piece of length `h` requires, at these mean velocities
    /// (N m).
    fn load(&self, from: &Beginning<P>, mean: [P; 2], h: P) -> [P; 2] {
        let (before, start) = (from.velocity, from.momentum);
        let after = [0, 1].map(|i| mean[i] + mean[i] - before[i]);
        let way = mean[1] * h;
        let slope = from.slope.mean(from.second, way);
        let end = self.momentum(from.coupling + slope * way, after);
        let [[v1, v2], [u1, u2]] = [before, after];
        let turning = (u1 * v1 + u1 * v1 + u1 * v2 + u2 * v1) * slope * P::from_f64(0.5);
        [(end[0] - start[0]) / h, (end[1] - start[1]) / h - turning]
    }

    /// Advances the arm by `dt` (s) with the friction of both joints, and their states.
    pub fn step(
        &self,
        friction: [&Composed<P>; 2],
        states: &mut [State<P>; 2],
        posture: &mut ArmPosture<P>,
        push: &ArmPush<P>,
        dt: P,
    ) -> [JointStep<P>; 2] {
        let elapsed = P::zero();
        let mut step = ArmStep {
            arm: self,
            friction,
            states,
            posture: *posture,
            beginning: self.beginning(posture),
            push,
            elapsed,
        };
        let mut result = [JointStep::zero(); 2];
        for piece in 1..=MAX_PIECES {
            let left = dt - step.elapsed;
            if left <= P::zero() {
                break;
            }
            let (mean, h, stopped) = step.piece(left, piece < MAX_PIECES);
            step.advance(&mut result, mean, h, dt);
            for (joint, stopped) in stopped.into_iter().enumerate() {
                if stopped {
                    step.posture.velocity[joint] = P::zero();
                }
            }
            if h == left {
                break;
            }
            step.beginning = self.beginning(&step.posture);
        }
        *posture = step.posture;
        result
    }
}

/// The motion of a joint in a piece of a step.
#[derive(Clone, Copy)]
enum Mode<P> {
    /// Friction has a state: one torque for each velocity.
    Any,
    /// Dry friction acts against this direction, continued beyond rest.
    Along(P),
    /// At rest, unless friction cannot hold the joint.
    Resting,
}

/// An arm within a step.
struct ArmStep<'a, P: Scalar + PartialOrd> {
    arm: &'a PlanarArm<P>,
    friction: [&'a Composed<P>; 2],
    states: &'a mut [State<P>; 2],
    posture: ArmPosture<P>,
    beginning: Beginning<P>,
    push: &'a ArmPush<P>,
    elapsed: P,
}

impl<P: Scalar<Plain = P> + PartialOrd> ArmStep<'_, P> {
    fn mode(&self, joint: usize) -> Mode<P> {
        let velocity = self.posture.velocity[joint];
        if !matches!(self.friction[joint].memory(), Memory::None) {
            Mode::Any
        } else if velocity.abs() <= P::from_f64(EDGE) {
            Mode::Resting
        } else {
            Mode::Along(velocity.sign())
        }
    }

    fn sample(&self, joint: usize, mean: [P; 2], h: P) -> Sample<P> {
        let half = P::from_f64(0.5);
        let velocity = mean[joint];
        Sample {
            velocity,
            position: self.posture.position[joint] + velocity * h * half,
            acceleration: (velocity - self.posture.velocity[joint]) / (h * half),
            temperature: self.push.temperature[joint],
            load_torque: self.arm.load(&self.beginning, mean, h)[joint],
            load_torque_curvature: P::zero(),
            motor_torque: self.push.motor[joint],
            external_torque: P::zero(),
            time: self.push.time + self.elapsed + h * half,
        }
    }

    /// Friction of a joint minus the friction that these mean velocities require (N m).
    fn excess(&self, joint: usize, mean: [P; 2], h: P, direction: Option<P>) -> P {
        let sample = self.sample(joint, mean, h);
        let edge = P::from_f64(EDGE);
        let velocity = match direction {
            Some(direction) if sample.velocity * direction < edge => direction * edge,
            _ => sample.velocity,
        };
        let acting = Sample { velocity, ..sample };
        mean_friction(self.friction[joint], &self.states[joint], &acting, h) - required(&sample)
    }

    /// The mean velocity of a joint at which the friction is the required one; `mean` gives both
    /// mean velocities from it.
    fn solve(&self, joint: usize, slope: P, h: P, mean: impl Fn(P) -> [P; 2]) -> P {
        let zero = P::zero();
        let before = self.posture.velocity[joint];
        let size = slope * before.abs() + self.push.motor[joint].abs();
        let root = |start: P, direction: Option<P>| {
            let excess = |velocity| self.excess(joint, mean(velocity), h, direction);
            Equation { start, value: excess(start), slope, size }.solve(excess)
        };
        match self.mode(joint) {
            Mode::Any => root(before, None),
            Mode::Along(direction) => root(before, Some(direction)),
            Mode::Resting => {
                let at_rest = mean(zero);
                let one = P::one();
                if self.excess(joint, at_rest, h, Some(one)) < zero {
                    root(zero, Some(one))
                } else if self.excess(joint, at_rest, h, Some(-one)) > zero {
                    root(zero, Some(-one))
                } else {
                    zero
                }
            }
        }
    }

    /// Mean velocities over a piece in which no joint stops.
    fn velocities(&self, h: P) -> [P; 2] {
        let [own, across, other] = self.arm.inertia_with(self.beginning.coupling);
        let per_step = P::from_f64(2.0) / h;
        let second = |first: P| self.solve(1, other * per_step, h, |second| [first, second]);
        let free = own - across * across / other;
        let first = self.solve(0, free * per_step, h, |first| [first, second(first)]);
        [first, second(first)]
    }

    /// How far the velocity of a joint has passed zero at the end of a piece (rad/s), the larger of
    /// both: negative while both keep their direction.
    fn overshoot(&self, mean: [P; 2]) -> P {
        let mut most = -P::one();
        for (joint, mean) in mean.into_iter().enumerate() {
            if let Mode::Along(direction) = self.mode(joint) {
                let beyond = (self.posture.velocity[joint] - mean - mean) * direction;
                let beyond = beyond / self.posture.velocity[joint].abs();
                if beyond > most {
                    most = beyond;
                }
            }
        }
        most
    }

    /// Mean velocities and length of the next piece, and which joints are at rest at its end.
    fn piece(&self, left: P, may_stop: bool) -> ([P; 2], P, [bool; 2]) {
        let mean = self.velocities(left);
        if !may_stop || self.overshoot(mean) < P::zero() {
            return (mean, left, [false; 2]);
        }
        let one = P::one();
        let start = P::from_f64(0.5);
        let overshoot = |share| {
            let share = if share > P::zero() { share } else { return -one };
            self.overshoot(self.velocities(left * if share < one { share } else { one }))
        };
        let size = P::from_f64(0.25);
        let share = Equation { start, value: overshoot(start), slope: one, size }.solve(overshoot);
        let h = left * if share < one { share } else { one };
        let mean = self.velocities(h);
        let near = P::from_f64(STOPPED);
        let stopped = [0, 1].map(|joint| match self.mode(joint) {
            Mode::Along(direction) => {
                let before = self.posture.velocity[joint];
                (mean[joint] + mean[joint] - before) * direction <= near * before.abs()
            }
            _ => false,
        });
        (mean, h, stopped)
    }

    /// Advances the arm by a piece.
    fn advance(&mut self, result: &mut [JointStep<P>; 2], mean: [P; 2], h: P, dt: P) {
        let samples = [0, 1].map(|joint| self.sample(joint, mean, h));
        for (joint, sample) in samples.iter().enumerate() {
            advance_state(self.friction[joint], &mut self.states[joint], sample, h);
            result[joint].add(sample, required(sample), h, dt);
            self.posture.position[joint] += mean[joint] * h;
            let before = self.posture.velocity[joint];
            self.posture.velocity[joint] = mean[joint] + mean[joint] - before;
        }
        self.elapsed += h;
    }
}
