//! Vectors and matrices of mechanics, by nalgebra: of static size, on the stack.
//!
//! nalgebra's number traits also have sine, exponential and others, whose bits depend on the
//! platform. Code generic over [`Number`] does not see them: it has sums, products and factors, whose
//! operations (`+ - * /`, square root) IEEE 754 rounds correctly everywhere, and the elementary
//! functions of [`crate::math`].

use core::ops::{DivAssign, SubAssign};

use nalgebra::{Cholesky, RealField, SMatrix, SVector};

use crate::scalar::Scalar;

/// One number per joint, or per coordinate: 3 of a position or force, 6 of a twist or wrench.
pub type Vector<P, const N: usize> = SVector<P, N>;

/// A linear map of vectors.
pub type Matrix<P, const ROWS: usize, const COLUMNS: usize> = SMatrix<P, ROWS, COLUMNS>;

/// Maps velocities to momenta; symmetric.
pub type MassMatrix<P, const N: usize> = Matrix<P, N, N>;

/// A number that vectors and matrices can hold: `f32` or `f64`.
pub trait Number:
    Scalar<Plain = Self> + PartialOrd + nalgebra::Scalar + SubAssign + DivAssign
{
    /// `M v`, each row summed from the left.
    fn product<const R: usize, const C: usize>(
        matrix: &Matrix<Self, R, C>,
        vector: &Vector<Self, C>,
    ) -> Vector<Self, R>;

    /// `u' v`, summed in an order that depends on `N` alone.
    fn dot<const N: usize>(left: &Vector<Self, N>, right: &Vector<Self, N>) -> Self;

    /// `M^-1 v` for a symmetric `M`; `None` unless it is positive definite.
    fn solve_definite<const N: usize>(
        matrix: &Matrix<Self, N, N>,
        vector: &Vector<Self, N>,
    ) -> Option<Vector<Self, N>>;
}

impl<P: Scalar<Plain = P> + PartialOrd + RealField> Number for P {
    #[inline]
    fn product<const R: usize, const C: usize>(
        matrix: &Matrix<P, R, C>,
        vector: &Vector<P, C>,
    ) -> Vector<P, R> {
        matrix * vector
    }

    #[inline]
    fn dot<const N: usize>(left: &Vector<P, N>, right: &Vector<P, N>) -> P {
        left.dot(right)
    }

    #[inline]
    fn solve_definite<const N: usize>(
        matrix: &Matrix<P, N, N>,
        vector: &Vector<P, N>,
    ) -> Option<Vector<P, N>> {
        Some(Cholesky::new(*matrix)?.solve(vector))
    }
}

#[cfg(test)]
mod tests {
    use super::{MassMatrix, Matrix, Number, Vector};

    /// Rounding shows the order of a sum.
    #[test]
    fn rows_are_summed_from_the_left() {
        let rows = [[0.1, 0.7, -0.3], [1e16, 1.0, -1e16]];
        let matrix = Matrix::<f64, 2, 3>::from_fn(|i, j| rows[i][j]);
        let [a, b, c] = [0.9, 1.1, 0.7];
        let expected = rows.map(|[x, y, z]| x * a + y * b + z * c);
        assert_eq!(f64::product(&matrix, &Vector::from([a, b, c])), Vector::from(expected));
    }

    #[test]
    fn a_definite_matrix_is_solved() {
        let root = Matrix::<f64, 6, 6>::from_fn(|i, j| 1.0 / (1 + i + 2 * j) as f64);
        let matrix: MassMatrix<f64, 6> = root * root.transpose() + Matrix::identity();
        let expected = Vector::<f64, 6>::from_fn(|i, _| 1.0 - i as f64);
        let found = f64::solve_definite(&matrix, &f64::product(&matrix, &expected)).unwrap();
        assert!((found - expected).amax() < 1e-14);
    }

    #[test]
    fn a_matrix_that_is_not_definite_is_refused() {
        let right = Vector::from([1.0_f32, 1.0]);
        for corner in [0.9, 1.0, f32::NAN] {
            let matrix = MassMatrix::from([[1.0, 1.0], [1.0, corner]]);
            assert_eq!(f32::solve_definite(&matrix, &right), None);
        }
    }
}
