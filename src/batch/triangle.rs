use std::vec;
use std::vec::Vec;

use super::BatchError;
use crate::scalar::Real;

/// Rows that are reflected together.
const BLOCK: usize = 32;

/// The triangular factors of least-squares problems, one a group of rows.
///
/// With `[J r] = Q R` the best step solves `R_jj x = R_jr`, and the last entry of the diagonal is
/// the norm of what is left. `J'J = R'R` has the square of the condition of `R`: a problem that
/// halves the digits in `R` loses all of them in the normal equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangle {
    /// `R`, `groups x (p + 1) x (p + 1)`, row by row, zero below the diagonal.
    pub factor: Vec<f64>,
}

/// Factors `[J r]` by Householder reflections, blocks of rows one after another, so that the same
/// input gives the same bits on every machine.
///
/// `jacobian` is `n x parameters`, row by row; `group` holds each row's group.
///
/// # Errors
/// Lengths that do not fit together, or a group that is not below `groups`.
pub fn triangle(
    jacobian: &[f64],
    parameters: usize,
    residual: &[f64],
    group: &[u32],
    groups: usize,
) -> Result<Triangle, BatchError> {
    let (n, p) = (residual.len(), parameters);
    let fit = |column, length| {
        if length == n { Ok(()) } else { Err(BatchError::Unequal { column, length, rows: n }) }
    };
    fit("group", group.len())?;
    if jacobian.len() != n * p {
        fit("jacobian", jacobian.len() / p.max(1))?;
    }
    let width = p + 1;
    let size = groups.checked_mul(width * width).ok_or(BatchError::TooManyGroups(groups))?;
    let mut factor = Vec::new();
    factor.try_reserve_exact(size).map_err(|_| BatchError::TooManyGroups(groups))?;
    factor.resize(size, 0.0);
    let mut blocks = vec![Vec::with_capacity(BLOCK * width); groups];
    for (row, (&r, &group)) in residual.iter().zip(group).enumerate() {
        let g = group as usize;
        let Some(block) = blocks.get_mut(g) else {
            return Err(BatchError::Group { row, group, groups });
        };
        block.extend_from_slice(&jacobian[row * p..(row + 1) * p]);
        block.push(r);
        if block.len() == BLOCK * width {
            absorb(&mut factor[g * width * width..][..width * width], block, width);
            block.clear();
        }
    }
    for (factor, block) in factor.chunks_exact_mut(width * width).zip(&mut blocks) {
        absorb(factor, block, width);
    }
    Ok(Triangle { factor })
}

/// Reflects the rows of `block` into the triangle (Golub and Van Loan, section 5.1).
fn absorb(triangle: &mut [f64], block: &mut [f64], width: usize) {
    let mut products = vec![0.0; width];
    for k in 0..width {
        let diagonal = triangle[k * width + k];
        let below = block.chunks_exact(width).fold(0.0, |sum, row| sum + row[k] * row[k]);
        if below < f64::MIN_POSITIVE {
            // Nothing below the diagonal, or so little that its square has no inverse.
            continue;
        }
        let norm = Real::sqrt(diagonal * diagonal + below);
        let norm = if diagonal > 0.0 { -norm } else { norm };
        let head = diagonal - norm;
        let scale = 1.0 / (norm * head);
        // Row by row: the sums of all columns run side by side.
        let (top, products) = (&mut triangle[k * width + k..(k + 1) * width], &mut products[k..]);
        for (product, x) in products.iter_mut().zip(&*top) {
            *product = head * x;
        }
        for row in block.chunks_exact(width) {
            let entry = row[k];
            for (product, x) in products.iter_mut().zip(&row[k..]) {
                *product += entry * x;
            }
        }
        for product in products.iter_mut() {
            *product *= scale;
        }
        for (x, product) in top.iter_mut().zip(&*products) {
            *x += head * product;
        }
        top[0] = norm;
        for row in block.chunks_exact_mut(width) {
            let entry = row[k];
            for (x, product) in row[k..].iter_mut().zip(&*products) {
                *x += entry * product;
            }
            row[k] = 0.0;
        }
    }
}
