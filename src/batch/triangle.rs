use std::vec;
use std::vec::Vec;

use pulp::{Arch, Simd, WithSimd};

use super::BatchError;
use crate::scalar::Real;

/// Rows that are reflected together.
const BLOCK: usize = 128;
/// Sums that run side by side.
const LANES: usize = 16;

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
    let mut blocks = vec![Block::new(width); groups];
    for (row, (&r, &group)) in residual.iter().zip(group).enumerate() {
        let g = group as usize;
        let Some(block) = blocks.get_mut(g) else {
            return Err(BatchError::Group { row, group, groups });
        };
        block.push(&jacobian[row * p..(row + 1) * p], r);
        if block.rows == BLOCK {
            block.absorb(&mut factor[g * width * width..][..width * width]);
        }
    }
    for (factor, block) in factor.chunks_exact_mut(width * width).zip(&mut blocks) {
        block.absorb(factor);
    }
    Ok(Triangle { factor })
}

/// Rows on their way into a triangle, column by column: sums along columns run side by side.
#[derive(Clone)]
struct Block {
    columns: Vec<[f64; BLOCK]>,
    rows: usize,
}

impl Block {
    fn new(width: usize) -> Self {
        Self { columns: vec![[0.0; BLOCK]; width], rows: 0 }
    }

    fn push(&mut self, slopes: &[f64], residual: f64) {
        for (column, &x) in self.columns.iter_mut().zip(slopes.iter().chain([&residual])) {
            column[self.rows] = x;
        }
        self.rows += 1;
    }

    /// Reflects the rows into the triangle and forgets them.
    fn absorb(&mut self, triangle: &mut [f64]) {
        if self.rows > 0 {
            Arch::new().dispatch(Absorbing { columns: &mut self.columns, triangle });
            self.columns.iter_mut().for_each(|column| column.fill(0.0));
            self.rows = 0;
        }
    }
}

struct Absorbing<'a> {
    columns: &'a mut [[f64; BLOCK]],
    triangle: &'a mut [f64],
}

impl WithSimd for Absorbing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        simd.vectorize(
            #[inline(always)]
            || self.all(),
        );
    }
}

impl Absorbing<'_> {
    /// Householder reflections (Golub and Van Loan, section 5.1), those of a column after another.
    #[inline(always)]
    fn all(self) {
        let width = self.columns.len();
        for k in 0..width {
            let (done, right) = self.columns.split_at_mut(k + 1);
            let own = &done[k];
            let top = &mut self.triangle[k * width + k..(k + 1) * width];
            let below = dot(own, own);
            if below < f64::MIN_POSITIVE {
                // Nothing below the diagonal, or so little that its square has no inverse.
                continue;
            }
            let diagonal = top[0];
            let norm = Real::sqrt(diagonal * diagonal + below);
            let norm = if diagonal > 0.0 { -norm } else { norm };
            let head = diagonal - norm;
            let scale = 1.0 / (norm * head);
            top[0] = norm;
            for (x, column) in top[1..].iter_mut().zip(right) {
                let product = (head * *x + dot(own, column)) * scale;
                *x += head * product;
                for (x, entry) in column.iter_mut().zip(own) {
                    *x += entry * product;
                }
            }
        }
    }
}

/// The sum of products, in the same order whatever the width of the registers.
#[inline(always)]
fn dot(x: &[f64; BLOCK], y: &[f64; BLOCK]) -> f64 {
    let mut sums = [0.0; LANES];
    for (x, y) in x.as_chunks::<LANES>().0.iter().zip(y.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    sums.iter().sum()
}
