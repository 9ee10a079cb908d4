//! Rotations and translations between frames.

use crate::joint::{Matrix, Number, Vector};

/// Where a frame stands in another: the columns of `rotation` are its axes there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<P> {
    /// Axes of the frame, one a column.
    pub rotation: Matrix<P, 3, 3>,
    /// Origin of the frame (m).
    pub translation: Vector<P, 3>,
}

impl<P: Number> Pose<P> {
    /// The frame itself.
    #[must_use]
    pub fn identity() -> Self {
        Self { rotation: diagonal(P::one()), translation: zero() }
    }

    /// A vector of the frame, seen from outside.
    #[inline]
    #[must_use]
    pub fn turned(&self, vector: &Vector<P, 3>) -> Vector<P, 3> {
        P::product(&self.rotation, vector)
    }

    /// A vector from outside, seen in the frame.
    #[inline]
    #[must_use]
    pub fn turned_back(&self, vector: &Vector<P, 3>) -> Vector<P, 3> {
        Vector::from([
            P::dot(&self.rotation.column(0).into_owned(), vector),
            P::dot(&self.rotation.column(1).into_owned(), vector),
            P::dot(&self.rotation.column(2).into_owned(), vector),
        ])
    }

    /// The pose in the outer frame of a frame that has the pose `inner` in this one.
    #[must_use]
    pub fn after(&self, inner: &Self) -> Self {
        Self {
            rotation: product(&self.rotation, &inner.rotation),
            translation: self.translation + self.turned(&inner.translation),
        }
    }
}

/// Rotation by an angle about a unit vector (Rodrigues).
pub(super) fn about<P: Number>(axis: &Vector<P, 3>, angle: P) -> Matrix<P, 3, 3> {
    let (sin, cos) = angle.sin_cos();
    let [x, y, z] = (*axis).into();
    let turn = P::one() - cos;
    let entry = |a: P, b: P| a * b * turn;
    Matrix::from([
        [entry(x, x) + cos, entry(x, y) + z * sin, entry(x, z) - y * sin],
        [entry(x, y) - z * sin, entry(y, y) + cos, entry(y, z) + x * sin],
        [entry(x, z) + y * sin, entry(y, z) - x * sin, entry(z, z) + cos],
    ])
}

/// `A B`, each column summed from the left.
pub(super) fn product<P: Number>(a: &Matrix<P, 3, 3>, b: &Matrix<P, 3, 3>) -> Matrix<P, 3, 3> {
    let column = |k: usize| P::product(a, &b.column(k).into_owned());
    Matrix::from_columns(&[column(0), column(1), column(2)])
}

/// A multiple of the unit matrix.
pub(super) fn diagonal<P: Number>(x: P) -> Matrix<P, 3, 3> {
    Matrix::from_fn(|i, j| if i == j { x } else { P::zero() })
}

/// The vector of zeros.
#[inline]
pub(super) fn zero<P: Number>() -> Vector<P, 3> {
    Vector::from([P::zero(); 3])
}
