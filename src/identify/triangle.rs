//! QR factorisation of least-squares problems, block by block, without the Jacobian in memory.
//!
//! The reflections are written out here: faer's QR of the same blocks takes 3 to 5 times as long for
//! 2 to 25 parameters (`benches/decompositions.rs`), and its bits depend on the vector unit.

use core::ops::Range;
use std::vec;
use std::vec::Vec;

use pulp::{Arch, Simd, WithSimd};

use crate::batch::BatchError;
use crate::scalar::Real;

/// Number of samples per reflection.
const BLOCK: usize = 128;
/// Number of partial sums of a dot product.
const LANES: usize = 16;
/// Magnitudes whose squares, and sums of very many of them, neither overflow nor underflow.
const SAFE_RANGE: Range<f64> = 1e-100..1e100;

/// The triangular factor of a least-squares problem.
///
/// With `[J r] = Q R` the optimal step solves `R_jj x = R_jr`, and the last diagonal entry is the
/// norm of the remaining residual. `J'J = R'R` squares the condition number of `R`: where `R` loses
/// half the digits, the normal equations lose all.
#[derive(Clone, Debug, PartialEq)]
pub struct Triangle {
    width: usize,
    factor: Vec<f64>,
}

impl Triangle {
    /// From `R`, `(p + 1) x (p + 1)`, row by row, zero below the diagonal.
    #[must_use]
    pub fn new(width: usize, factor: Vec<f64>) -> Self {
        Self { width, factor }
    }

    /// Number of columns of `R`: the parameters and the residual.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// `R`, row by row.
    #[must_use]
    pub fn factor(&self) -> &[f64] {
        &self.factor
    }

    /// A row of `R`.
    #[must_use]
    pub fn row(&self, row: usize) -> &[f64] {
        &self.factor[row * self.width..(row + 1) * self.width]
    }

    /// One entry of `Q'r`; the last one is the norm of the residual that no step explains.
    #[must_use]
    pub fn right(&self, row: usize) -> f64 {
        self.row(row)[self.width - 1]
    }

    /// Sum of squares of the residual before any step.
    #[must_use]
    pub fn square(&self) -> f64 {
        (0..self.width).map(|row| self.right(row) * self.right(row)).sum()
    }

    /// The decrease of the sum of squares for a step of the parameters, computed without
    /// cancellation.
    #[must_use]
    pub fn fall(&self, step: &[f64]) -> f64 {
        let lowered = |row: usize| {
            let change = self.change(row, step);
            change * (2.0 * self.right(row) - change)
        };
        (0..step.len()).map(lowered).sum()
    }

    /// The same problem after a step of parameters in which it is linear.
    #[must_use]
    pub fn moved(mut self, step: &[f64]) -> Self {
        for row in 0..step.len() {
            self.factor[(row + 1) * self.width - 1] -= self.change(row, step);
        }
        self
    }

    fn change(&self, row: usize, step: &[f64]) -> f64 {
        self.row(row).iter().zip(step).skip(row).map(|(x, step)| x * step).sum()
    }

    /// Whether all entries are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.factor.iter().all(|x| x.is_finite()) && self.square().is_finite()
    }
}

/// The factors of the problems whose samples `pass` supplies, one per group.
///
/// `pass` is called a second time with scaled columns where squares would overflow or underflow.
/// The same samples give the same bits on every machine.
///
/// # Errors
/// Errors of `pass`, and more groups than fit into memory.
pub fn factored<E: From<BatchError>>(
    width: usize,
    groups: usize,
    mut pass: impl FnMut(&mut Factoring) -> Result<(), E>,
) -> Result<Vec<Triangle>, E> {
    let mut factoring = Factoring::new(vec![1.0; width], groups)?;
    pass(&mut factoring)?;
    factoring.reduce();
    if let Some(scale) = factoring.better_scale() {
        factoring = Factoring::new(scale, groups)?;
        pass(&mut factoring)?;
        factoring.reduce();
    }
    Ok(factoring.triangles())
}

/// The factors of `[J r]`, one per group: `jacobian` is `n x parameters`, row-major; `group` is the
/// group of each row.
///
/// # Errors
/// Inconsistent lengths, or a group that is not below `groups`.
pub fn triangles(
    jacobian: &[f64],
    parameters: usize,
    residual: &[f64],
    group: &[u32],
    groups: usize,
) -> Result<Vec<Triangle>, BatchError> {
    let (n, p) = (residual.len(), parameters);
    let fit = |column, length| {
        if length == n { Ok(()) } else { Err(BatchError::Unequal { column, length, rows: n }) }
    };
    fit("group", group.len())?;
    if jacobian.len() != n * p {
        fit("jacobian", jacobian.len() / p.max(1))?;
    }
    if let Some(row) = group.iter().position(|&group| group as usize >= groups) {
        return Err(BatchError::Group { row, group: group[row], groups });
    }
    factored(p + 1, groups, |into| {
        let mut first = 0;
        for alike in group.chunk_by(|x, y| x == y) {
            into.push(alike[0], alike.len(), |column, taken, out| {
                let from = first + taken;
                if column == p {
                    out.copy_from_slice(&residual[from..from + out.len()]);
                } else {
                    let slopes = jacobian[from * p + column..].iter().step_by(p);
                    out.iter_mut().zip(slopes).for_each(|(x, &slope)| *x = slope);
                }
            });
            first += alike.len();
        }
        Ok(())
    })
}

/// Combines the factors of parts of the samples: each part has one per group.
///
/// # Errors
/// More groups than fit into memory.
pub fn joined(
    width: usize,
    groups: usize,
    parts: &[Vec<Triangle>],
) -> Result<Vec<Triangle>, BatchError> {
    factored(width, groups, |into| {
        for part in parts {
            for (group, triangle) in (0..).zip(part) {
                into.push(group, width, |column, taken, out| {
                    for (row, x) in (taken..).zip(out) {
                        *x = triangle.row(row)[column];
                    }
                });
            }
        }
        Ok(())
    })
}

/// Samples that are being reduced to triangles.
pub struct Factoring {
    scale: Vec<f64>,
    largest: Vec<f64>,
    groups: Vec<Group>,
}

/// Samples not yet reduced, column by column, so that sums along columns vectorise.
#[derive(Clone)]
struct Group {
    columns: Vec<[f64; BLOCK]>,
    rows: usize,
    factor: Vec<f64>,
}

impl Factoring {
    fn new(scale: Vec<f64>, groups: usize) -> Result<Self, BatchError> {
        let width = scale.len();
        let waiting =
            Group { columns: vec![[0.0; BLOCK]; width], rows: 0, factor: vec![0.0; width * width] };
        let mut all = Vec::new();
        let numbers = width.checked_mul(width + BLOCK).and_then(|each| each.checked_mul(groups));
        let room = numbers.is_some_and(|numbers| Vec::<f64>::new().try_reserve(numbers).is_ok());
        if !room || all.try_reserve_exact(groups).is_err() {
            return Err(BatchError::TooManyGroups(groups));
        }
        all.resize(groups, waiting);
        Ok(Self { largest: vec![0.0; width], scale, groups: all })
    }

    /// Takes `count` samples of a group; `fill` writes a column's numbers from an index on.
    #[inline(always)]
    pub fn push(
        &mut self,
        group: u32,
        count: usize,
        mut fill: impl FnMut(usize, usize, &mut [f64]),
    ) {
        let Some(own) = self.groups.get_mut(group as usize) else { return };
        let mut taken = 0;
        while taken < count {
            let more = (count - taken).min(BLOCK - own.rows);
            let room = own.rows..own.rows + more;
            for (k, (column, &scale)) in own.columns.iter_mut().zip(&self.scale).enumerate() {
                let out = &mut column[room.clone()];
                fill(k, taken, out);
                if scale != 1.0 {
                    out.iter_mut().for_each(|x| *x *= scale);
                }
            }
            taken += more;
            own.rows += more;
            if own.rows == BLOCK {
                own.reduce(&mut self.largest);
            }
        }
    }

    /// Reduces all remaining samples.
    fn reduce(&mut self) {
        for group in &mut self.groups {
            group.reduce(&mut self.largest);
        }
    }

    /// Factors that bring the columns into the safe range, if they are not.
    fn better_scale(&self) -> Option<Vec<f64>> {
        let is_unsafe = |x: &f64| *x > 0.0 && x.is_finite() && !SAFE_RANGE.contains(x);
        self.largest.iter().any(is_unsafe).then(|| {
            let scale = |x: &f64| if is_unsafe(x) { (1.0 / x).min(f64::MAX) } else { 1.0 };
            self.largest.iter().map(scale).collect()
        })
    }

    fn triangles(self) -> Vec<Triangle> {
        let width = self.scale.len();
        let whole = |mut group: Group| {
            for row in group.factor.chunks_exact_mut(width) {
                for (x, scale) in row.iter_mut().zip(&self.scale) {
                    *x /= scale;
                }
            }
            Triangle { width, factor: group.factor }
        };
        self.groups.into_iter().map(whole).collect()
    }
}

impl Group {
    /// Reduces the samples into the triangle and empties the block.
    fn reduce(&mut self, largest: &mut [f64]) {
        if self.rows > 0 {
            let Self { columns, factor, .. } = self;
            Arch::new().dispatch(Reduction { columns, triangle: factor, largest });
            self.columns.iter_mut().for_each(|column| column.fill(0.0));
            self.rows = 0;
        }
    }
}

struct Reduction<'a> {
    columns: &'a mut [[f64; BLOCK]],
    triangle: &'a mut [f64],
    largest: &'a mut [f64],
}

impl WithSimd for Reduction<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        simd.vectorize(
            #[inline(always)]
            || self.all(),
        );
    }
}

impl Reduction<'_> {
    /// Householder reflections (Golub and Van Loan, section 5.1), column after column; for the times
    /// of faer's see `benches/decompositions.rs`.
    #[inline(always)]
    fn all(self) {
        let width = self.columns.len();
        for (largest, column) in self.largest.iter_mut().zip(self.columns.iter()) {
            *largest = largest.max(largest_magnitude(column));
        }
        for k in 0..width {
            let (done, right) = self.columns.split_at_mut(k + 1);
            let own = &done[k];
            let top = &mut self.triangle[k * width + k..(k + 1) * width];
            let below = dot(own, own);
            if below < f64::MIN_POSITIVE {
                // Zero below the diagonal, or so small that its square underflows.
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

/// The dot product, with the same order of sums whatever the vector width.
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

/// The largest magnitude.
#[inline(always)]
fn largest_magnitude(x: &[f64; BLOCK]) -> f64 {
    let mut largest = [0.0_f64; LANES];
    for x in x.as_chunks::<LANES>().0 {
        for lane in 0..LANES {
            let size = x[lane].abs();
            largest[lane] = if size > largest[lane] { size } else { largest[lane] };
        }
    }
    largest.iter().fold(0.0, |most, &x| most.max(x))
}
