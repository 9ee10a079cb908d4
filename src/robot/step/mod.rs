//! A step of a robot with friction in every joint, as steps of single joints (`crate::joint`).
//!
//! Mean velocities `w` over a piece of length `h` solve `tl(w) + tf(w) = u` for all joints at once.
//! The load `tl` is that of the rigid bodies at the middle of the piece, with `a = 2 (w - v)/h`, and
//! with the mean of gravity on the way; `tf` is the mean friction of the exact step of each law's
//! state. A joint whose law has no state stops where its velocity reaches zero, and rests while dry
//! friction can hold it: pieces end there. The rule is symmetric in time, so that energy does not
//! drift, and with one joint it is that of the single joint.
//!
//! | file | content |
//! |---|---|
//! | `load` | torques of the rigid bodies over a piece |
//! | `solve` | the equations of a piece: joint by joint, and by Newton's method |
//! | `pieces` | where joints stop; states and results |

mod load;
mod pieces;
mod solve;

use super::state::{LinkState, Tree};
use crate::composed::Composed;
use crate::dynamics::State;
use crate::joint::{JointStep, Number};

/// The inputs of a step: one entry per motor, constant over the step.
#[derive(Clone, Copy, Debug)]
pub struct Pushed<'a, P> {
    /// Motor torques (N m or N).
    pub motor: &'a [P],
    /// Temperatures (degC).
    pub temperature: &'a [P],
    /// Time at the start of the step (s).
    pub time: P,
}

/// A coordinate of a robot in motion, that of its motor: room and posture.
#[derive(Clone, Copy, Debug)]
pub struct Axis<P> {
    /// Position of the motor (rad or m).
    pub position: P,
    /// Velocity of the motor.
    pub velocity: P,
    /// Mean velocity over the piece, and mean load at it.
    mean: P,
    load: P,
    mode: Mode<P>,
    /// What the linear load is about: mean velocity and load of the rigid bodies.
    about: P,
    /// Mean velocity and load before a Newton step, the step, and what friction adds to the diagonal
    /// of its matrix.
    kept: [P; 2],
    change: P,
    /// Magnitude of the terms of its equation then.
    scale: P,
    /// What its mean speed does not exceed.
    reach: P,
    slope: P,
}

/// The motion of a joint in a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode<P> {
    /// Friction has a state: one torque for each velocity.
    Any,
    /// Dry friction acts against this direction, continued beyond rest.
    Along(P),
    /// At rest, held by friction.
    Held,
    /// It comes to rest at the end of the piece, by the friction that this takes.
    Stops,
    /// At rest at the start of the piece; friction cannot hold it in this direction.
    Breaks(P),
}

impl<P> Mode<P> {
    /// Whether the mean velocity is given, and friction is what it takes.
    const fn is_given(&self) -> bool {
        matches!(self, Self::Held | Self::Stops)
    }
}

impl<P: Number> Axis<P> {
    /// At a position and velocity of its motor.
    #[must_use]
    pub fn at(position: P, velocity: P) -> Self {
        let zero = P::zero();
        Self {
            position,
            velocity,
            mean: velocity,
            load: zero,
            mode: Mode::Any,
            about: zero,
            kept: [zero; 2],
            change: zero,
            scale: zero,
            reach: zero,
            slope: zero,
        }
    }
}

/// Room that a caller provides: one entry per joint but for `numbers`.
#[derive(Debug)]
pub struct Room<'a, P> {
    /// For the links.
    pub links: &'a mut [LinkState<P>],
    /// [`Room::numbers`] of them.
    pub numbers: &'a mut [P],
}

impl<P> Room<'_, P> {
    /// How many numbers `n` joints need.
    #[must_use]
    pub const fn numbers(n: usize) -> usize {
        2 * n * n + 6 * n
    }
}

/// A robot with the friction of every motor.
#[derive(Debug)]
pub struct Moving<'a, P: Number> {
    /// The rigid bodies.
    pub tree: Tree<'a, P>,
    /// Friction of each motor.
    pub friction: &'a [Composed<P>],
}

/// A step in progress.
struct Step<'a, 'b, P: Number> {
    moving: &'a Moving<'a, P>,
    states: &'a mut [State<P>],
    axes: &'a mut [Axis<P>],
    pushed: &'a Pushed<'a, P>,
    room: &'a mut Room<'b, P>,
    elapsed: P,
    /// Whether the equations of every piece were solved to rounding.
    solved: bool,
}

impl<P: Number> Moving<'_, P> {
    /// Advances positions and velocities of `axes` by `dt` (s), and the states of friction; `result`
    /// has the means over the step. `false` if the equations could not be solved to rounding, as
    /// where friction grows faster with the load than the load itself.
    ///
    /// # Panics
    /// If slices have another length than that of the robot.
    pub fn step(
        &self,
        states: &mut [State<P>],
        axes: &mut [Axis<P>],
        pushed: &Pushed<'_, P>,
        room: &mut Room<'_, P>,
        result: &mut [JointStep<P>],
        dt: P,
    ) -> bool {
        result.fill(JointStep::at_rest());
        let (elapsed, solved) = (P::zero(), true);
        let mut step = Step { moving: self, states, axes, pushed, room, elapsed, solved };
        step.over(dt, result);
        step.solved
    }
}
