//! Motors that turn with several joints, as those of wrists and differentials.
//!
//! Positions and velocities of the motors are a constant matrix times those of the joints, and by
//! their power torques at the joints are its transpose times those of the motors. Gear ratios are
//! not part of it: a motor that turns one joint alone has a row of the unit matrix.

use crate::joint::Number;

/// The matrix between joints and motors, and its inverse: row by row, on slices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling<'a, P> {
    /// Velocity of each motor (row) per velocity of each joint (column).
    pub turns: &'a [P],
    /// Velocity of each joint per velocity of each motor: the inverse.
    pub inverse: &'a [P],
}

/// The same for a robot whose size is known at compile time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupled<P, const N: usize> {
    /// Velocity of each motor (row) per velocity of each joint (column).
    pub turns: [[P; N]; N],
    /// Velocity of each joint per velocity of each motor: the inverse.
    pub inverse: [[P; N]; N],
}

impl<P: Number, const N: usize> Coupled<P, N> {
    /// From the velocity of each motor (row) per velocity of each joint (column); `None` if joints
    /// may move while all motors rest.
    ///
    /// ```
    /// use stribeck::robot::Coupled;
    ///
    /// // A differential: the motors turn by sum and difference of the joints.
    /// let wrist = Coupled::new([[1.0, 1.0], [1.0, -1.0]]).unwrap();
    /// assert_eq!(wrist.inverse, [[0.5, 0.5], [0.5, -0.5]]);
    /// assert_eq!(Coupled::new([[1.0, 1.0], [2.0, 2.0]]), None);
    /// ```
    #[must_use]
    pub fn new(turns: [[P; N]; N]) -> Option<Self> {
        let (mut room, mut inverse) = (turns, [[P::zero(); N]; N]);
        invert(room.as_flattened_mut(), inverse.as_flattened_mut(), N)
            .then_some(Self { turns, inverse })
    }

    /// The same on slices.
    #[must_use]
    pub fn on_slices(&self) -> Coupling<'_, P> {
        Coupling { turns: self.turns.as_flattened(), inverse: self.inverse.as_flattened() }
    }
}

/// Inverts a matrix `[n, n]`, which is spent, by elimination with pivots in its columns. `false` if
/// it is singular to rounding.
pub fn invert<P: Number>(matrix: &mut [P], inverse: &mut [P], n: usize) -> bool {
    let mut largest = P::zero();
    for entry in matrix.iter() {
        largest = if entry.abs() > largest { entry.abs() } else { largest };
    }
    for (k, entry) in inverse.iter_mut().enumerate() {
        *entry = if k % (n + 1) == 0 { P::one() } else { P::zero() };
    }
    for k in 0..n {
        let mut pivot = k;
        for row in k + 1..n {
            if matrix[row * n + k].abs() > matrix[pivot * n + k].abs() {
                pivot = row;
            }
        }
        // A comparison that NaN fails too.
        let far = matrix[pivot * n + k].abs() > largest * P::from_f64(1e-6);
        if !far {
            return false;
        }
        for column in 0..n {
            matrix.swap(k * n + column, pivot * n + column);
            inverse.swap(k * n + column, pivot * n + column);
        }
        let scale = matrix[k * n + k];
        for column in 0..n {
            matrix[k * n + column] /= scale;
            inverse[k * n + column] /= scale;
        }
        for row in (0..n).filter(|row| *row != k) {
            let factor = matrix[row * n + k];
            for column in 0..n {
                let (own, other) = (matrix[k * n + column], inverse[k * n + column]);
                matrix[row * n + column] -= factor * own;
                inverse[row * n + column] -= factor * other;
            }
        }
    }
    true
}

impl<P: Number> Coupling<'_, P> {
    /// Positions, velocities or accelerations of the motors from those of the joints.
    #[inline]
    pub fn motors(&self, joints: &[P], motors: &mut [P]) {
        by_rows(self.turns, joints, motors);
    }

    /// Positions, velocities or accelerations of the joints from those of the motors.
    #[inline]
    pub fn joints(&self, motors: &[P], joints: &mut [P]) {
        by_rows(self.inverse, motors, joints);
    }

    /// Torques of the motors that torques at the joints need.
    #[inline]
    pub fn motor_torque(&self, at_joints: &[P], of_motors: &mut [P]) {
        by_columns(self.inverse, at_joints, of_motors);
    }

    /// Torques at the joints of torques of the motors.
    #[inline]
    pub fn joint_torque(&self, of_motors: &[P], at_joints: &mut [P]) {
        by_columns(self.turns, of_motors, at_joints);
    }
}

/// Rows of the matrix, one a motor.
#[inline]
pub(super) fn rows<P>(matrix: &[P], n: usize) -> core::slice::ChunksExact<'_, P> {
    matrix.chunks_exact(if n == 0 { 1 } else { n })
}

/// `A x`, each row summed from the left.
#[inline]
fn by_rows<P: Number>(matrix: &[P], x: &[P], made: &mut [P]) {
    for (row, made) in rows(matrix, x.len()).zip(made) {
        *made = dot(row, x);
    }
}

/// `A' x`, row by row.
#[inline]
fn by_columns<P: Number>(matrix: &[P], x: &[P], made: &mut [P]) {
    made.fill(P::zero());
    for (row, x) in rows(matrix, x.len()).zip(x) {
        for (made, entry) in made.iter_mut().zip(row) {
            *made += *entry * *x;
        }
    }
}

/// `u' v`, summed from the left.
#[inline]
pub(super) fn dot<P: Number>(left: &[P], right: &[P]) -> P {
    let mut sum = P::zero();
    for (a, b) in left.iter().zip(right) {
        sum += *a * *b;
    }
    sum
}
