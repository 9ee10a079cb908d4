//! Motion of all links, and the torques that it takes.

use super::body::{Body, Inertial, Twist, Wrench};
use super::coupling::{Coupling, dot, rows};
use super::pose::{Pose, zero};
use crate::joint::{Number, Vector};

/// Position, velocity and acceleration of a link: room that a caller provides, one per link.
#[derive(Clone, Copy, Debug)]
pub struct LinkState<P> {
    pub(super) pose: Pose<P>,
    pub(super) velocity: Twist<P>,
    pub(super) acceleration: Twist<P>,
    pub(super) wrench: Wrench<P>,
    pub(super) composite: Inertial<P>,
    /// A joint that moves the link, and the motion of the link per unit of that joint's velocity.
    pub(super) moved_by: usize,
    pub(super) axis: Twist<P>,
}

impl<P: Number> LinkState<P> {
    /// At rest.
    #[must_use]
    pub fn new() -> Self {
        let nothing = [P::zero(); 10];
        Self {
            pose: Pose::identity(),
            velocity: Twist::zero(),
            acceleration: Twist::zero(),
            wrench: Wrench { torque: zero(), force: zero() },
            composite: Inertial::from_parameters(nothing),
            moved_by: usize::MAX,
            axis: Twist::zero(),
        }
    }
}

impl<P: Number> Default for LinkState<P> {
    fn default() -> Self {
        Self::new()
    }
}

/// A robot on slices: links with their joints, parents first, in a field of gravity.
///
/// All slices of a call have one entry per link.
#[derive(Clone, Copy, Debug)]
pub struct Tree<'a, P> {
    /// Links with their joints.
    pub bodies: &'a [Body<P>],
    /// Acceleration of gravity in the frame of the base (m/s2).
    pub gravity: [P; 3],
    /// Motors that turn with several joints; `None`: each turns its own.
    pub coupling: Option<Coupling<'a, P>>,
}

impl<P: Number> Tree<'_, P> {
    /// Poses of the links in the frames of their parents.
    pub(super) fn place(&self, position: &[P], links: &mut [LinkState<P>]) {
        for ((body, q), link) in self.bodies.iter().zip(position).zip(links) {
            link.pose = body.pose(*q);
        }
    }

    /// Velocities and accelerations of the links in their own frames. The acceleration of gravity is
    /// that of the base, reversed.
    pub(super) fn move_links(
        &self,
        position: &[P],
        velocity: &[P],
        acceleration: &[P],
        links: &mut [LinkState<P>],
    ) {
        self.place(position, links);
        let lifted = Twist { angular: zero(), linear: -Vector::from(self.gravity) };
        let joints = self.bodies.iter().zip(velocity.iter().zip(acceleration));
        for (k, (body, (&v, &a))) in joints.enumerate() {
            let Some((before, [link, ..])) = links.split_at_mut_checked(k) else { return };
            let (carried, lift) = match body.parent.and_then(|parent| before.get(parent)) {
                Some(parent) => (parent.velocity, parent.acceleration),
                None => (Twist::zero(), lifted),
            };
            let axis = body.twist();
            let mut moved = carried.at(&link.pose);
            let mut pushed = lift.at(&link.pose);
            // The parent turns: its origin accelerates the arm `translation` towards the centre.
            let around = carried.angular.cross(&link.pose.translation);
            let inward = link.pose.turned_back(&carried.angular.cross(&around));
            // Coriolis: twice the turning of the link's frame against a sliding joint.
            let slid = axis.linear * v;
            let turning = moved.angular.cross(&slid);
            pushed.linear += inward + turning + turning + axis.linear * a;
            pushed.angular += moved.angular.cross(&(axis.angular * v)) + axis.angular * a;
            moved.linear += slid;
            moved.angular += axis.angular * v;
            (link.velocity, link.acceleration) = (moved, pushed);
        }
    }

    /// Torques (N m or N) of the joints for a motion: recursive Newton-Euler. It cannot panic: a
    /// parent that does not stand before its link is taken for the base.
    pub fn inverse_dynamics(
        &self,
        position: &[P],
        velocity: &[P],
        acceleration: &[P],
        links: &mut [LinkState<P>],
        torque: &mut [P],
    ) {
        self.move_links(position, velocity, acceleration, links);
        for (body, link) in self.bodies.iter().zip(links.iter_mut()) {
            link.wrench = needed(&body.inertial, link);
        }
        self.sum_wrenches(links, torque);
        match self.coupling {
            None => {
                for ((body, torque), a) in self.bodies.iter().zip(torque).zip(acceleration) {
                    *torque += body.rotor * *a;
                }
            }
            Some(Coupling { turns, .. }) => {
                for (body, row) in self.bodies.iter().zip(rows(turns, acceleration.len())) {
                    let pushed = body.rotor * dot(row, acceleration);
                    for (torque, turn) in torque.iter_mut().zip(row) {
                        *torque += *turn * pushed;
                    }
                }
            }
        }
    }

    /// Torques (N m or N) that hold the robot against gravity.
    pub fn gravity_torque(&self, position: &[P], links: &mut [LinkState<P>], torque: &mut [P]) {
        self.place(position, links);
        let lift = -Vector::from(self.gravity);
        for (k, body) in self.bodies.iter().enumerate() {
            let Some((before, [link, ..])) = links.split_at_mut_checked(k) else { return };
            let carrier = body.parent.and_then(|parent| before.get(parent));
            let up = link.pose.turned_back(&carrier.map_or(lift, |own| own.acceleration.linear));
            link.acceleration.linear = up;
            let Inertial { mass, moment, .. } = body.inertial;
            link.wrench = Wrench { torque: moment.cross(&up), force: up * mass };
        }
        self.sum_wrenches(links, torque);
    }

    /// Adds to each link's wrench those of the links that it carries: what the joints' torques need
    /// for it.
    fn sum_wrenches(&self, links: &mut [LinkState<P>], torque: &mut [P]) {
        for (k, (body, torque)) in self.bodies.iter().zip(torque).enumerate().rev() {
            let Some((before, [link, ..])) = links.split_at_mut_checked(k) else { return };
            *torque = body.torque(&link.wrench);
            if let Some(carrier) = body.parent.and_then(|parent| before.get_mut(parent)) {
                carrier.wrench.add(&link.wrench.carried(&link.pose));
            }
        }
    }
}

/// What moves a link as it moves: Newton and Euler about the origin of its frame.
#[inline]
fn needed<P: Number>(inertial: &Inertial<P>, link: &LinkState<P>) -> Wrench<P> {
    let (turning, pushed) = (link.velocity.angular, link.acceleration);
    let Inertial { mass, moment, .. } = *inertial;
    let inertia = inertial.matrix();
    let spun = turning.cross(&P::product(&inertia, &turning));
    Wrench {
        force: pushed.linear * mass
            + pushed.angular.cross(&moment)
            + turning.cross(&turning.cross(&moment)),
        torque: P::product(&inertia, &pushed.angular) + spun + moment.cross(&pushed.linear),
    }
}
