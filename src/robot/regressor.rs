//! Torques as a linear function of the inertial parameters.

use super::body::{PARAMETERS, Twist};
use super::coupling::{Coupling, dot, rows};
use super::state::{LinkState, Tree};
use crate::joint::{Number, Vector};

impl<P: Number> Tree<'_, P> {
    /// Derivatives of all torques by all inertial parameters, row by row: one row a joint, and
    /// [`PARAMETERS`] columns a link: mass, first moment (x, y, z), inertia (xx, xy, yy, xz, yz, zz)
    /// about its frame, rotor inertia. The torques are the matrix times the parameters.
    ///
    /// The axis of each joint is carried out to the links that it moves, where the power of a wrench
    /// has few terms.
    pub fn regressor(
        &self,
        position: &[P],
        velocity: &[P],
        acceleration: &[P],
        links: &mut [LinkState<P>],
        matrix: &mut [P],
    ) {
        let columns = PARAMETERS * self.bodies.len();
        self.move_links(position, velocity, acceleration, links);
        matrix.fill(P::zero());
        for joint in 0..self.bodies.len() {
            let row = &mut matrix[joint * columns..(joint + 1) * columns];
            if self.coupling.is_none() {
                row[joint * PARAMETERS + 10] = acceleration[joint];
            }
            // Which links this joint moves, and their motion with it.
            for k in joint..self.bodies.len() {
                let axis = if k == joint {
                    Some(self.bodies[k].twist())
                } else {
                    let carrier = self.bodies[k].parent.filter(|parent| *parent >= joint);
                    carrier
                        .filter(|parent| links[*parent].moved_by == joint)
                        .map(|parent| links[parent].axis.at(&links[k].pose))
                };
                let Some(axis) = axis else {
                    links[k].moved_by = usize::MAX;
                    continue;
                };
                (links[k].axis, links[k].moved_by) = (axis, joint);
                let of_link = &mut row[k * PARAMETERS..k * PARAMETERS + 10];
                of_link.copy_from_slice(&powers(&axis, &links[k]));
            }
        }
        // A rotor that several joints turn loads all of them.
        if let Some(Coupling { turns, .. }) = self.coupling {
            for (k, turns) in rows(turns, self.bodies.len()).enumerate() {
                let spun = dot(turns, acceleration);
                for (joint, turn) in turns.iter().enumerate() {
                    matrix[joint * columns + k * PARAMETERS + 10] = *turn * spun;
                }
            }
        }
    }
}

/// Power of what moves the link, per unit of each of its ten parameters, in a motion `axis`.
#[inline]
fn powers<P: Number>(axis: &Twist<P>, link: &LinkState<P>) -> [P; 10] {
    let (turning, pushed) = (link.velocity.angular, link.acceleration);
    // The axis is moved inside the triple products: s.(a x h) = (s x a).h
    let by_force = {
        let inward = axis.linear.cross(&turning).cross(&turning);
        axis.linear.cross(&pushed.angular) + inward
    };
    let moment: Vector<P, 3> = by_force + pushed.linear.cross(&axis.angular);
    let [x, y, z] = axis.angular.into();
    let [ax, ay, az] = pushed.angular.into();
    // s.(w x I w) = (s x w).(I w)
    let [sx, sy, sz] = axis.angular.cross(&turning).into();
    let [wx, wy, wz] = turning.into();
    [
        P::dot(&axis.linear, &pushed.linear),
        moment.x,
        moment.y,
        moment.z,
        x * ax + sx * wx,
        x * ay + y * ax + sx * wy + sy * wx,
        y * ay + sy * wy,
        x * az + z * ax + sx * wz + sz * wx,
        y * az + z * ay + sy * wz + sz * wy,
        z * az + sz * wz,
    ]
}
