//! A step of the arm with friction, in pieces that end where a joint stops.

use super::super::algebra::{Number, Vector};
use super::super::coupling::{JointStep, advance_state, mean_friction, required};
use super::super::root::Equation;
use super::{ArmPush, Beginning, PlanarArm};
use crate::composed::Composed;
use crate::dynamics::{Memory, State};
use crate::sample::Sample;

/// Both joints may stop and break away in a step; after this many pieces the rest of the step is
/// computed like the last piece.
const MAX_PIECES: usize = 5;
/// A speed (rad/s) that stands for the onset of motion in the friction law.
const EDGE: f64 = 1e-30;
/// At the end of a piece that ends in rest, a joint below this speed, relative to the start of the
/// piece, is at rest.
const STOPPED: f64 = 1e-9;

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
pub(super) struct ArmStep<'a, P: Number> {
    pub arm: &'a PlanarArm<P>,
    pub friction: [&'a Composed<P>; 2],
    pub states: &'a mut [State<P>; 2],
    pub from: Beginning<P>,
    pub push: &'a ArmPush<P>,
    pub elapsed: P,
}

impl<P: Number> ArmStep<'_, P> {
    /// Means over a step of `dt` (s), and positions and velocities at its end.
    pub(super) fn over(&mut self, dt: P) -> ([JointStep<P>; 2], [Vector<P, 2>; 2]) {
        let mut result = [JointStep::at_rest(); 2];
        let mut end = [self.from.position, self.from.velocity];
        for piece in 1..=MAX_PIECES {
            let left = dt - self.elapsed;
            if left <= P::zero() {
                break;
            }
            let (mean, h, stopped) = self.piece(left, piece < MAX_PIECES);
            self.advance::<0>(&mut result, &mean, h, dt);
            self.advance::<1>(&mut result, &mean, h, dt);
            self.elapsed += h;
            let after = self.from.after(&mean);
            let velocity =
                after.zip_map(&stopped.into(), |v, stops| if stops { P::zero() } else { v });
            end = [self.from.position + mean * h, velocity];
            if h == left {
                break;
            }
            self.from = self.arm.beginning(end[0], end[1]);
        }
        (result, end)
    }

    fn mode<const JOINT: usize>(&self) -> Mode<P> {
        let velocity = self.from.velocity[JOINT];
        if !matches!(self.friction[JOINT].memory(), Memory::None) {
            Mode::Any
        } else if velocity.abs() <= P::from_f64(EDGE) {
            Mode::Resting
        } else {
            Mode::Along(velocity.sign())
        }
    }

    fn sample<const JOINT: usize>(&self, mean: &Vector<P, 2>, h: P) -> Sample<P> {
        let half = P::from_f64(0.5);
        let velocity = mean[JOINT];
        Sample {
            velocity,
            position: self.from.position[JOINT] + velocity * h * half,
            acceleration: (velocity - self.from.velocity[JOINT]) / (h * half),
            temperature: self.push.temperature[JOINT],
            load_torque: self.arm.load(&self.from, mean, h)[JOINT],
            load_torque_curvature: P::zero(),
            temperature_rate: P::zero(),
            motor_torque: self.push.motor[JOINT],
            external_torque: P::zero(),
            time: self.push.time + self.elapsed + h * half,
        }
    }

    /// Friction of a joint minus the friction that these mean velocities require (N m).
    fn excess<const JOINT: usize>(&self, mean: &Vector<P, 2>, h: P, direction: Option<P>) -> P {
        let sample = self.sample::<JOINT>(mean, h);
        let edge = P::from_f64(EDGE);
        let velocity = match direction {
            Some(direction) if sample.velocity * direction < edge => direction * edge,
            _ => sample.velocity,
        };
        let acting = Sample { velocity, ..sample };
        mean_friction(self.friction[JOINT], &self.states[JOINT], &acting, h) - required(&sample)
    }

    /// The mean velocity of a joint at which the friction is the required one; `mean` gives both
    /// mean velocities from it.
    fn solve<const JOINT: usize>(&self, slope: P, h: P, mean: impl Fn(P) -> Vector<P, 2>) -> P {
        let zero = P::zero();
        let before = self.from.velocity[JOINT];
        let size = slope * before.abs() + self.push.motor[JOINT].abs();
        let root = |start: P, direction: Option<P>| {
            let excess = |velocity| self.excess::<JOINT>(&mean(velocity), h, direction);
            Equation { start, value: excess(start), slope, size }.solve(excess)
        };
        match self.mode::<JOINT>() {
            Mode::Any => root(before, None),
            Mode::Along(direction) => root(before, Some(direction)),
            Mode::Resting => {
                let at_rest = mean(zero);
                let one = P::one();
                if self.excess::<JOINT>(&at_rest, h, Some(one)) < zero {
                    root(zero, Some(one))
                } else if self.excess::<JOINT>(&at_rest, h, Some(-one)) > zero {
                    root(zero, Some(-one))
                } else {
                    zero
                }
            }
        }
    }

    /// Mean velocities over a piece in which no joint stops.
    fn velocities(&self, h: P) -> Vector<P, 2> {
        let mass = self.arm.mass_matrix(self.from.coupling);
        let per_step = P::from_f64(2.0) / h;
        let second = |first: P| {
            self.solve::<1>(mass.m22 * per_step, h, |second| Vector::from([first, second]))
        };
        // The inertia of the first joint while the second one moves freely.
        let free = mass.m11 - mass.m12 * mass.m12 / mass.m22;
        let first =
            self.solve::<0>(free * per_step, h, |first| Vector::from([first, second(first)]));
        Vector::from([first, second(first)])
    }

    /// How far the velocity of a joint has passed zero at the end of a piece, relative to its start,
    /// the larger of both: negative while both keep their direction.
    fn overshoot(&self, mean: &Vector<P, 2>) -> P {
        let (first, second) = (self.beyond::<0>(mean), self.beyond::<1>(mean));
        if second > first { second } else { first }
    }

    /// The same of one joint; at least -1.
    fn beyond<const JOINT: usize>(&self, mean: &Vector<P, 2>) -> P {
        let least = -P::one();
        let Mode::Along(direction) = self.mode::<JOINT>() else { return least };
        let before = self.from.velocity[JOINT];
        let beyond = (before - mean[JOINT] - mean[JOINT]) * direction / before.abs();
        if beyond > least { beyond } else { least }
    }

    /// Mean velocities and length of the next piece, and which joints are at rest at its end.
    fn piece(&self, left: P, may_stop: bool) -> (Vector<P, 2>, P, [bool; 2]) {
        let mean = self.velocities(left);
        if !may_stop || self.overshoot(&mean) < P::zero() {
            return (mean, left, [false; 2]);
        }
        let one = P::one();
        let start = P::from_f64(0.5);
        let overshoot = |share| {
            let share = if share > P::zero() { share } else { return -one };
            self.overshoot(&self.velocities(left * if share < one { share } else { one }))
        };
        let size = P::from_f64(0.25);
        let share = Equation { start, value: overshoot(start), slope: one, size }.solve(overshoot);
        let h = left * if share < one { share } else { one };
        let mean = self.velocities(h);
        (mean, h, [self.stops::<0>(&mean), self.stops::<1>(&mean)])
    }

    /// Whether a joint is at rest at the end of a piece that may end in rest.
    fn stops<const JOINT: usize>(&self, mean: &Vector<P, 2>) -> bool {
        let Mode::Along(direction) = self.mode::<JOINT>() else { return false };
        let near = P::from_f64(STOPPED) * self.from.velocity[JOINT].abs();
        self.from.after(mean)[JOINT] * direction <= near
    }

    /// Advances state and result of a joint by a piece.
    fn advance<const JOINT: usize>(
        &mut self,
        result: &mut [JointStep<P>; 2],
        mean: &Vector<P, 2>,
        h: P,
        dt: P,
    ) {
        let sample = self.sample::<JOINT>(mean, h);
        advance_state(self.friction[JOINT], &mut self.states[JOINT], &sample, h);
        result[JOINT].add(&sample, required(&sample), h, dt);
    }
}
