//! Derivatives of the torques by position and velocity.

use super::body::{Inertial, Twist, Wrench};
use super::pose::zero;
use super::state::{LinkState, Tree};
use crate::joint::Number;

/// How the motion of a link, and the wrench that it takes, change with one joint: room that a
/// caller provides, one per link.
#[derive(Clone, Copy, Debug)]
pub struct LinkChange<P> {
    velocity: Twist<P>,
    acceleration: Twist<P>,
    wrench: Wrench<P>,
}

impl<P: Number> LinkChange<P> {
    /// No change.
    #[must_use]
    pub fn new() -> Self {
        Self {
            velocity: Twist::zero(),
            acceleration: Twist::zero(),
            wrench: Wrench { torque: zero(), force: zero() },
        }
    }
}

impl<P: Number> Default for LinkChange<P> {
    fn default() -> Self {
        Self::new()
    }
}

/// A joint whose position, or velocity, changes.
struct Direction {
    joint: usize,
    by_position: bool,
}

impl<P: Number> Tree<'_, P> {
    /// Derivatives of [`inverse_dynamics`](Self::inverse_dynamics) by the positions and by the
    /// velocities of the joints, row by row: one row a torque. Those by the accelerations are the
    /// [mass matrix](Self::mass_matrix).
    ///
    /// The recursion of the torques is differentiated joint by joint in the frames of the links
    /// (Carpentier and Mansard, *Robotics: Science and Systems*, 2018, section III), so that the cost
    /// grows with the square of the number of joints.
    #[allow(clippy::too_many_arguments)]
    pub fn inverse_dynamics_derivatives(
        &self,
        position: &[P],
        velocity: &[P],
        acceleration: &[P],
        links: &mut [LinkState<P>],
        changes: &mut [LinkChange<P>],
        by_position: &mut [P],
        by_velocity: &mut [P],
    ) {
        let n = self.bodies.len();
        // The torques themselves are not needed, but the wrenches summed over the links carried.
        self.inverse_dynamics(position, velocity, acceleration, links, &mut by_position[..n]);
        for joint in 0..n {
            for (matrix, of_position) in [(&mut *by_position, true), (&mut *by_velocity, false)] {
                let direction = Direction { joint, by_position: of_position };
                self.change_motion(&direction, velocity, links, changes);
                self.change_torques(&direction, links, changes, matrix);
            }
        }
    }

    /// Outwards: changes of the links' motion, and of what each link takes alone.
    fn change_motion(
        &self,
        direction: &Direction,
        velocity: &[P],
        links: &[LinkState<P>],
        changes: &mut [LinkChange<P>],
    ) {
        changes.fill(LinkChange::new());
        for k in direction.joint..self.bodies.len() {
            let (body, link) = (&self.bodies[k], &links[k]);
            let axis = body.twist();
            let (mut moved, mut pushed) = match body.parent.filter(|p| *p >= direction.joint) {
                Some(parent) => {
                    let carried = &changes[parent];
                    (carried.velocity.at(&link.pose), carried.acceleration.at(&link.pose))
                }
                None if k == direction.joint => (Twist::zero(), Twist::zero()),
                None => continue,
            };
            if k == direction.joint {
                // The joint's own part of a motion lies along its axis and does not turn with it.
                let slid = axis.times(velocity[k]);
                if direction.by_position {
                    moved = link.velocity.cross(&axis);
                    // What the parent passes on: the acceleration without the joint's own part.
                    let own = link.velocity.cross(&slid);
                    pushed = link.spatial_acceleration().minus(&own).cross(&axis);
                } else {
                    moved = axis;
                    pushed = link.velocity.cross(&axis);
                }
            }
            pushed.add(&moved.cross(&axis.times(velocity[k])));
            changes[k] = LinkChange {
                velocity: moved,
                acceleration: pushed,
                wrench: taken(&body.inertial, link, &moved, &pushed),
            };
        }
    }

    /// Inwards: changes of the torques, a column of `matrix`.
    fn change_torques(
        &self,
        direction: &Direction,
        links: &[LinkState<P>],
        changes: &mut [LinkChange<P>],
        matrix: &mut [P],
    ) {
        let n = self.bodies.len();
        for (k, body) in self.bodies.iter().enumerate().rev() {
            let mut wrench = changes[k].wrench;
            matrix[k * n + direction.joint] = body.torque(&wrench);
            if direction.by_position && k == direction.joint {
                wrench.add(&body.twist().across(&links[k].wrench));
            }
            if let Some(parent) = body.parent {
                changes[parent].wrench.add(&wrench.carried(&links[k].pose));
            }
        }
    }
}

/// Change of the wrench that a link takes alone: `I da + dv x* I v + v x* I dv`.
fn taken<P: Number>(
    inertial: &Inertial<P>,
    link: &LinkState<P>,
    moved: &Twist<P>,
    pushed: &Twist<P>,
) -> Wrench<P> {
    let mut wrench = inertial.pushed(pushed);
    wrench.add(&moved.across(&inertial.pushed(&link.velocity)));
    wrench.add(&link.velocity.across(&inertial.pushed(moved)));
    wrench
}

impl<P: Number> LinkState<P> {
    /// The spatial acceleration: that of the frame's origin without the turning of its velocity.
    fn spatial_acceleration(&self) -> Twist<P> {
        let Twist { angular, linear } = self.acceleration;
        let carried = self.velocity.angular.cross(&self.velocity.linear);
        Twist { angular, linear: linear - carried }
    }
}

impl<P: Number> Twist<P> {
    fn times(&self, factor: P) -> Self {
        Self { angular: self.angular * factor, linear: self.linear * factor }
    }

    fn minus(&self, other: &Self) -> Self {
        Self { angular: self.angular - other.angular, linear: self.linear - other.linear }
    }

    fn add(&mut self, other: &Self) {
        self.angular += other.angular;
        self.linear += other.linear;
    }

    /// Change of a motion `other` that this one carries along.
    fn cross(&self, other: &Self) -> Self {
        Self {
            angular: self.angular.cross(&other.angular),
            linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular),
        }
    }

    /// Change of a wrench that this motion carries along.
    fn across(&self, wrench: &Wrench<P>) -> Wrench<P> {
        Wrench {
            torque: self.angular.cross(&wrench.torque) + self.linear.cross(&wrench.force),
            force: self.angular.cross(&wrench.force),
        }
    }
}
