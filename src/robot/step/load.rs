//! Torques of the rigid bodies over a piece of a step.

use super::Step;
use crate::joint::Number;
use crate::robot::state::Tree;

/// Nodes of the quadrature of gravity on the way, from its middle (Gauss and Legendre, two nodes):
/// exact to the fourth power of the way.
const NODE: f64 = 0.288_675_134_594_812_9;

impl<P: Number> Step<'_, '_, P> {
    /// The matrix by which the load grows with the mean velocities over a piece of length `h`, in
    /// the room for it: twice the mass matrix of the motors over `h`.
    pub(super) fn weigh(&mut self, h: P) {
        let n = self.axes.len();
        let tree = &self.moving.tree;
        let (matrix, rest) = self.room.numbers.split_at_mut(n * n);
        let (work, rest) = rest.split_at_mut(n * n);
        let (motors, rest) = rest.split_at_mut(n);
        let joints = &mut rest[..n];
        for (motor, axis) in motors.iter_mut().zip(self.axes.iter()) {
            *motor = axis.position;
        }
        match tree.coupling {
            None => tree.mass_matrix(motors, self.room.links, matrix),
            Some(coupling) => {
                coupling.joints(motors, joints);
                tree.mass_matrix(joints, self.room.links, work);
                // Row by row and column by column: (C^-1)' M C^-1 is symmetric.
                for (row, made) in work.chunks_exact(n).zip(matrix.chunks_exact_mut(n)) {
                    coupling.motor_torque(row, made);
                }
                for k in 0..n {
                    for (j, motor) in motors.iter_mut().enumerate() {
                        *motor = matrix[j * n + k];
                    }
                    coupling.motor_torque(motors, joints);
                    for (j, made) in joints.iter().enumerate() {
                        work[j * n + k] = *made;
                    }
                }
                matrix.copy_from_slice(work);
            }
        }
        let scale = P::from_f64(2.0) / h;
        for entry in matrix {
            *entry *= scale;
        }
    }

    /// Mean loads at the mean velocities over a piece of length `h`; the linear load is about them
    /// from now on.
    pub(super) fn find_load(&mut self, h: P) {
        let n = self.axes.len();
        let Tree { coupling, .. } = self.moving.tree;
        let half = h * P::from_f64(0.5);
        let tree = &self.moving.tree;
        let still = Tree { gravity: [P::zero(); 3], ..*tree };
        let (_, rest) = self.room.numbers.split_at_mut(2 * n * n);
        let (position, rest) = rest.split_at_mut(n);
        let (velocity, rest) = rest.split_at_mut(n);
        let (acceleration, rest) = rest.split_at_mut(n);
        let (torque, rest) = rest.split_at_mut(n);
        let (node, other) = rest.split_at_mut(n);
        for (k, axis) in self.axes.iter().enumerate() {
            position[k] = axis.position + axis.mean * half;
            velocity[k] = axis.mean;
            acceleration[k] = (axis.mean - axis.velocity) / half;
        }
        if let Some(coupling) = coupling {
            for moved in [&mut *position, &mut *velocity, &mut *acceleration] {
                other.copy_from_slice(moved);
                coupling.joints(other, moved);
            }
        }
        still.inverse_dynamics(position, velocity, acceleration, self.room.links, torque);
        for side in [-NODE, NODE] {
            let way = h * P::from_f64(side);
            for ((node, position), velocity) in
                node.iter_mut().zip(position.iter()).zip(velocity.iter())
            {
                *node = *position + *velocity * way;
            }
            tree.gravity_torque(node, self.room.links, other);
            for (torque, held) in torque.iter_mut().zip(other.iter()) {
                *torque += *held * P::from_f64(0.5);
            }
        }
        if let Some(coupling) = coupling {
            other.copy_from_slice(torque);
            coupling.motor_torque(other, torque);
        }
        for (axis, torque) in self.axes.iter_mut().zip(torque.iter()) {
            (axis.load, axis.about) = (*torque, axis.mean);
        }
    }

    /// Moves the mean velocity of a joint; loads follow linearly.
    pub(super) fn shift(&mut self, joint: usize, mean: P) {
        let n = self.axes.len();
        let change = mean - self.axes[joint].mean;
        self.axes[joint].mean = mean;
        for k in 0..n {
            self.axes[k].load += self.room.numbers[k * n + joint] * change;
        }
    }

    /// The entry of the matrix of a joint with itself.
    pub(super) fn own(&self, joint: usize) -> P {
        self.room.numbers[joint * (self.axes.len() + 1)]
    }
}
