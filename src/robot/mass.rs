//! The mass matrix, and accelerations by its factors.

use super::body::{Inertial, Wrench};
use super::coupling::{Coupling, rows};
use super::pose::{Pose, diagonal, product};
use super::state::{LinkState, Tree};
use crate::joint::{Matrix, Number};

impl<P: Number> Tree<'_, P> {
    /// The mass matrix, row by row: composite rigid bodies.
    pub fn mass_matrix(&self, position: &[P], links: &mut [LinkState<P>], matrix: &mut [P]) {
        let n = self.bodies.len();
        self.place(position, links);
        matrix.fill(P::zero());
        for (body, link) in self.bodies.iter().zip(links.iter_mut()) {
            link.composite = body.inertial;
        }
        for (k, body) in self.bodies.iter().enumerate().rev() {
            let LinkState { composite, pose, .. } = links[k];
            if let Some(parent) = body.parent {
                links[parent].composite.add(&composite.carried(&pose));
            }
            let mut wrench = composite.pushed(&body.twist());
            matrix[k * n + k] = body.torque(&wrench);
            if self.coupling.is_none() {
                matrix[k * n + k] += body.rotor;
            }
            let mut at = k;
            while let Some(parent) = self.bodies[at].parent {
                wrench = wrench.carried(&links[at].pose);
                at = parent;
                let entry = self.bodies[at].torque(&wrench);
                (matrix[k * n + at], matrix[at * n + k]) = (entry, entry);
            }
        }
        if let Some(Coupling { turns, .. }) = self.coupling {
            for (body, row) in self.bodies.iter().zip(rows(turns, n)) {
                for (line, first) in matrix.chunks_exact_mut(n).zip(row) {
                    for (entry, second) in line.iter_mut().zip(row) {
                        *entry += body.rotor * (*first * *second);
                    }
                }
            }
        }
    }

    /// Accelerations of the joints that torques (N m or N) cause: the mass matrix is factored in the
    /// order of the tree, `M = L' D L`, in the room of `matrix`. `false` unless it is positive
    /// definite.
    pub fn forward_dynamics(
        &self,
        position: &[P],
        velocity: &[P],
        torque: &[P],
        links: &mut [LinkState<P>],
        matrix: &mut [P],
        acceleration: &mut [P],
    ) -> bool {
        let n = self.bodies.len();
        acceleration.fill(P::zero());
        // What the motion takes without acceleration, in the room of the matrix.
        let (bias, rest) = (&mut matrix[..n], P::zero());
        bias.fill(rest);
        self.inverse_dynamics(position, velocity, acceleration, links, bias);
        for ((a, torque), bias) in acceleration.iter_mut().zip(torque).zip(bias) {
            *a = *torque - *bias;
        }
        self.mass_matrix(position, links, matrix);
        solve_definite(matrix, acceleration)
    }
}

/// Solves `M x = b` in place by `M = L' D L`, which fills no zeros of a tree (Featherstone, table
/// 6.3). `false` unless M is positive definite.
pub(super) fn solve_definite<P: Number>(matrix: &mut [P], right: &mut [P]) -> bool {
    let n = right.len();
    for k in (0..n).rev() {
        let pivot = matrix[k * n + k];
        if !pivot.is_positive() {
            return false;
        }
        for i in (0..k).rev() {
            let factor = matrix[k * n + i] / pivot;
            for j in 0..=i {
                let fall = factor * matrix[k * n + j];
                matrix[i * n + j] -= fall;
            }
            matrix[k * n + i] = factor;
        }
    }
    for k in (0..n).rev() {
        for i in 0..k {
            let fall = matrix[k * n + i] * right[k];
            right[i] -= fall;
        }
    }
    for k in 0..n {
        right[k] /= matrix[k * n + k];
        for i in 0..k {
            let fall = matrix[k * n + i] * right[i];
            right[k] -= fall;
        }
    }
    true
}

impl<P: Number> Inertial<P> {
    fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        self.moment += other.moment;
        for (sum, part) in self.inertia.iter_mut().zip(other.inertia) {
            *sum += part;
        }
    }

    /// Momentum at a velocity, as a wrench.
    pub(super) fn pushed(&self, velocity: &super::body::Twist<P>) -> Wrench<P> {
        let turned = P::product(&self.matrix(), &velocity.angular);
        Wrench {
            force: velocity.linear * self.mass + velocity.angular.cross(&self.moment),
            torque: turned + self.moment.cross(&velocity.linear),
        }
    }

    /// The same body in the outer frame, where its frame has this pose.
    fn carried(&self, pose: &Pose<P>) -> Self {
        let Pose { rotation, translation: p } = pose;
        let h = pose.turned(&self.moment);
        let turned = product(&product(rotation, &self.matrix()), &rotation.transpose());
        // About a point at -p: I - (p h' + h p') + 2 (p.h) 1 + m ((p.p) 1 - p p')
        let both = P::dot(p, &h) + P::dot(p, &h) + self.mass * P::dot(p, p);
        let outer: Matrix<P, 3, 3> =
            Matrix::from_fn(|i, j| p[i] * h[j] + h[i] * p[j] + self.mass * p[i] * p[j]);
        let inertia = turned + diagonal(both) - outer;
        Self {
            mass: self.mass,
            moment: h + p * self.mass,
            inertia: [
                inertia[(0, 0)],
                inertia[(1, 0)],
                inertia[(1, 1)],
                inertia[(2, 0)],
                inertia[(2, 1)],
                inertia[(2, 2)],
            ],
        }
    }
}
