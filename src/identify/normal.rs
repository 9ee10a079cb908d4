//! Normal equations of a tall Jacobian, one set a group of rows.

use core::fmt;
use std::vec;
use std::vec::Vec;

/// `J'J`, `J'r` and `r'r` of every group, one group after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NormalSums {
    /// `J'J`, row-major, `p * p` numbers a group.
    pub matrix: Vec<f64>,
    /// `J'r`, `p` numbers a group.
    pub vector: Vec<f64>,
    /// `r'r`, one number a group.
    pub square: Vec<f64>,
}

/// Columns that do not belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalError {
    /// The Jacobian, the residual and the groups differ in rows.
    Length,
    /// A row's group is not below the number of groups.
    Group,
}

impl fmt::Display for NormalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length => "the Jacobian, the residual and the groups have unequal rows",
            Self::Group => "a row's group is not below the number of groups",
        })
    }
}

impl core::error::Error for NormalError {}

/// Sums the normal equations of each group, row by row in the order given.
///
/// `jacobian` is row-major with `parameters` numbers a row; `group` holds one index a row, below
/// `groups`.
///
/// # Errors
/// Lengths that do not match; a group out of range.
pub fn normal_equations(
    jacobian: &[f64],
    parameters: usize,
    residual: &[f64],
    group: &[u32],
    groups: usize,
) -> Result<NormalSums, NormalError> {
    let p = parameters;
    if jacobian.len() != residual.len() * p || group.len() != residual.len() {
        return Err(NormalError::Length);
    }
    if group.iter().any(|&g| g as usize >= groups) {
        return Err(NormalError::Group);
    }
    let mut sums = NormalSums {
        matrix: vec![0.0; groups * p * p],
        vector: vec![0.0; groups * p],
        square: vec![0.0; groups],
    };
    for (row, (&r, &g)) in residual.iter().zip(group).enumerate() {
        let g = g as usize;
        let line = &jacobian[row * p..(row + 1) * p];
        let matrix = &mut sums.matrix[g * p * p..(g + 1) * p * p];
        for (i, &left) in line.iter().enumerate() {
            // The lower triangle; the upper one mirrors it below.
            for (cell, &right) in matrix[i * p..=i * p + i].iter_mut().zip(line) {
                *cell += left * right;
            }
        }
        for (cell, &x) in sums.vector[g * p..(g + 1) * p].iter_mut().zip(line) {
            *cell += x * r;
        }
        sums.square[g] += r * r;
    }
    for matrix in sums.matrix.chunks_exact_mut((p * p).max(1)) {
        for i in 0..p {
            for j in 0..i {
                matrix[j * p + i] = matrix[i * p + j];
            }
        }
    }
    Ok(sums)
}
