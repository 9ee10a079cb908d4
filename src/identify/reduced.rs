//! The sum of squares as a function of the nonlinear parameters alone, with its gradient.

use std::vec;
use std::vec::Vec;

use super::bounded::bounded_least_squares;
use super::separable::{Bounds, LeastSquares};
use super::triangle::Triangle;

/// The least sum of squares over the linear parameters, at given nonlinear ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// The given values, with the best linear parameters within their bounds.
    pub values: Vec<f64>,
    /// Sum of squares of the residual.
    pub square: f64,
    /// Its derivative with respect to each parameter; 0 for linear and fixed ones.
    pub slope: Vec<f64>,
}

/// Evaluates the sum of squares at the nonlinear parameters of `values` (variable projection, Golub
/// and Pereyra 1973); `None` where the model is not finite.
///
/// The residual is a minimum over the linear parameters, so that its derivative with respect to the
/// nonlinear ones is that at fixed linear ones: `-2 J'r`. It is left out, and zeros, unless
/// `sloped`.
///
/// # Errors
/// Errors of the problem.
pub fn reduced<P: LeastSquares>(
    problem: &P,
    values: &[f64],
    bounds: &Bounds<'_>,
    sloped: bool,
) -> Result<Option<Reduced>, P::Error> {
    if values.iter().any(|x| !x.is_finite()) {
        return Ok(None);
    }
    let free = |&k: &usize| bounds.lower[k] < bounds.upper[k];
    let (linear, nonlinear): (Vec<usize>, Vec<usize>) =
        (0..values.len()).filter(free).partition(|&k| bounds.linear[k]);
    let mut values = values.to_vec();
    let mut slope = vec![0.0; values.len()];
    if !linear.is_empty() {
        let Some(triangle) = problem.triangle(&values, &linear, &vec![1.0; linear.len()])? else {
            return Ok(None);
        };
        let step = best_step(&triangle, &linear, &values, bounds);
        for (&k, &step) in linear.iter().zip(&step) {
            values[k] = (values[k] + step).max(bounds.lower[k]).min(bounds.upper[k]);
        }
        if !sloped {
            let square = triangle.moved(&step).square();
            return Ok(Some(Reduced { values, square, slope }));
        }
    }
    let nonlinear = if sloped { nonlinear } else { vec![] };
    let ones = vec![1.0; nonlinear.len()];
    let Some(triangle) = problem.triangle(&values, &nonlinear, &ones)? else { return Ok(None) };
    for (column, &k) in nonlinear.iter().enumerate() {
        let product = |row: usize| triangle.row(row)[column] * triangle.right(row);
        slope[k] = -2.0 * (0..=column).map(product).sum::<f64>();
    }
    Ok(Some(Reduced { square: triangle.square(), values, slope }))
}

fn best_step(triangle: &Triangle, linear: &[usize], at: &[f64], bounds: &Bounds<'_>) -> Vec<f64> {
    let count = linear.len();
    let factor: Vec<f64> = (0..count).flat_map(|row| triangle.row(row)[..count].to_vec()).collect();
    let right: Vec<f64> = (0..count).map(|row| triangle.right(row)).collect();
    let lower: Vec<f64> = linear.iter().map(|&k| bounds.lower[k] - at[k]).collect();
    let upper: Vec<f64> = linear.iter().map(|&k| bounds.upper[k] - at[k]).collect();
    bounded_least_squares(&factor, &right, &lower, &upper)
}
