//! Normal equations, summed in a fixed order.

use std::vec::Vec;

use super::BatchError;

/// Sums of `J'J`, `J'r` and `r'r` over groups of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalEquations {
    /// `J'J`, `groups x p x p`, row-major.
    pub matrix: Vec<f64>,
    /// `J'r`, `groups x p`.
    pub vector: Vec<f64>,
    /// `r'r`, one per group.
    pub square: Vec<f64>,
}

/// Sums sample by sample, so that the same input gives the same bits on every machine.
///
/// `jacobian` is `n x parameters`, row-major; `group` is the group of each row.
///
/// # Errors
/// Inconsistent lengths, or a group that is not below `groups`.
pub fn normal_equations(
    jacobian: &[f64],
    parameters: usize,
    residual: &[f64],
    group: &[u32],
    groups: usize,
) -> Result<NormalEquations, BatchError> {
    let (n, p) = (residual.len(), parameters);
    let fit = |column, length| {
        if length == n { Ok(()) } else { Err(BatchError::Unequal { column, length, rows: n }) }
    };
    fit("group", group.len())?;
    if jacobian.len() != n * p {
        fit("jacobian", jacobian.len() / p.max(1))?;
    }
    let mut sums = NormalEquations {
        matrix: zeros(groups, p * p)?,
        vector: zeros(groups, p)?,
        square: zeros(groups, 1)?,
    };
    for (i, (&r, &group)) in residual.iter().zip(group).enumerate() {
        let g = group as usize;
        let Some(square) = sums.square.get_mut(g) else {
            return Err(BatchError::Group { row: i, group, groups });
        };
        *square += r * r;
        let row = &jacobian[i * p..(i + 1) * p];
        let matrix = &mut sums.matrix[g * p * p..(g + 1) * p * p];
        for (j, (&x, v)) in row.iter().zip(&mut sums.vector[g * p..]).enumerate() {
            *v += x * r;
            for (sum, &y) in matrix[j * p..=j * p + j].iter_mut().zip(row) {
                *sum += x * y;
            }
        }
    }
    for matrix in sums.matrix.chunks_exact_mut((p * p).max(1)) {
        for j in 0..p {
            for k in 0..j {
                matrix[k * p + j] = matrix[j * p + k];
            }
        }
    }
    Ok(sums)
}

fn zeros(groups: usize, each: usize) -> Result<Vec<f64>, BatchError> {
    let mut sums = Vec::new();
    let length = groups.checked_mul(each).ok_or(BatchError::TooManyGroups(groups))?;
    sums.try_reserve_exact(length).map_err(|_| BatchError::TooManyGroups(groups))?;
    sums.resize(length, 0.0);
    Ok(sums)
}
