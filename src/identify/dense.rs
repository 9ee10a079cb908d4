//! Least squares with few parameters, by faer on the thread that calls: QR with column pivoting,
//! singular values where directions are poorly determined.

use std::vec;
use std::vec::Vec;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::qr::col_pivoting::factor::{qr_in_place, qr_in_place_scratch};
use faer::linalg::qr::col_pivoting::solve::{solve_lstsq_in_place, solve_lstsq_in_place_scratch};
use faer::linalg::svd::{ComputeSvdVectors, svd, svd_scratch};
use faer::{Mat, MatRef, Par};

/// Where every pivot is at least this share of the largest, all directions are identifiable.
const WELL_CONDITIONED: f64 = 1e-5;

/// Least squares with a number of rows and at most a number of columns, in its own memory.
pub struct Dense {
    columns: Mat<f64>,
    right: Mat<f64>,
    reflections: Mat<f64>,
    order: Vec<usize>,
    place: Vec<usize>,
    scratch: MemBuffer,
}

impl Dense {
    /// Memory for `rows` rows and at most `most` columns.
    pub fn new(rows: usize, most: usize) -> Self {
        let needed = StackReq::or(
            qr_in_place_scratch::<usize, f64>(rows, most, 1, Par::Seq, Default::default()),
            solve_lstsq_in_place_scratch::<usize, f64>(rows, most, 1, 1, Par::Seq),
        );
        Self {
            columns: Mat::zeros(rows, most),
            right: Mat::zeros(rows, 1),
            reflections: Mat::zeros(1, rows.min(most)),
            order: vec![0; most],
            place: vec![0; most],
            scratch: MemBuffer::new(needed),
        }
    }

    /// The x of least norm that minimises `|A x - b|`, from the columns of A; directions with a
    /// singular value below the share `unseen` of the largest do not count. `None` where A is not
    /// finite.
    pub fn least_squares<'a>(
        &mut self,
        columns: impl Iterator<Item = &'a [f64]> + Clone,
        right: &[f64],
        unseen: f64,
    ) -> Option<Vec<f64>> {
        let count = self.fill(columns.clone());
        if let Some(x) = self.by_pivots(count, right) {
            return Some(x);
        }
        self.fill(columns);
        let found = SingularValues::of(self.columns.as_ref().subcols(0, count))?;
        Some(found.least_squares(right, unseen))
    }

    /// Copies the columns and returns their number.
    fn fill<'a>(&mut self, columns: impl Iterator<Item = &'a [f64]>) -> usize {
        let mut count = 0;
        for column in columns {
            self.columns.col_as_slice_mut(count).copy_from_slice(column);
            count += 1;
        }
        count
    }

    /// The solution by QR with column pivoting (Golub and Van Loan, section 5.4.2); `None` where a
    /// direction is poorly determined.
    fn by_pivots(&mut self, count: usize, right: &[f64]) -> Option<Vec<f64>> {
        if count > right.len() {
            return None;
        }
        let mut columns = self.columns.as_mut().subcols_mut(0, count);
        let mut reflections = self.reflections.as_mut().subcols_mut(0, count);
        let (_, order) = qr_in_place(
            columns.as_mut(),
            reflections.as_mut(),
            &mut self.order[..count],
            &mut self.place[..count],
            Par::Seq,
            MemStack::new(&mut self.scratch),
            Default::default(),
        );
        let columns = columns.as_ref();
        let pivot = |k: usize| columns[(k, k)].abs();
        let largest = (0..count).map(pivot).fold(0.0, f64::max);
        // NaN, the pivot of a zero matrix, is poorly determined as well.
        if !(0..count).all(|k| pivot(k) > WELL_CONDITIONED * largest) {
            return None;
        }
        self.right.col_as_slice_mut(0).copy_from_slice(right);
        solve_lstsq_in_place(
            columns,
            reflections.as_ref(),
            columns,
            order,
            self.right.as_mut(),
            Par::Seq,
            MemStack::new(&mut self.scratch),
        );
        Some(self.right.col_as_slice(0)[..count].to_vec())
    }
}

/// A matrix as `U S V'`.
pub struct SingularValues {
    /// The diagonal of S, in decreasing order.
    pub values: Vec<f64>,
    left: Mat<f64>,
    right: Mat<f64>,
}

impl SingularValues {
    /// `None` where the matrix is not finite.
    pub fn of(matrix: MatRef<'_, f64>) -> Option<Self> {
        let (rows, columns) = matrix.shape();
        let least = rows.min(columns);
        let mut values = Mat::zeros(least, 1);
        let mut left = Mat::zeros(rows, least);
        let mut right = Mat::zeros(columns, least);
        let thin = ComputeSvdVectors::Thin;
        let needed = svd_scratch::<f64>(rows, columns, thin, thin, Par::Seq, Default::default());
        svd(
            matrix,
            values.as_mut().col_mut(0).as_diagonal_mut(),
            Some(left.as_mut()),
            Some(right.as_mut()),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(needed)),
            Default::default(),
        )
        .ok()?;
        Some(Self { values: values.col_as_slice(0).to_vec(), left, right })
    }

    /// The columns of V: directions in the parameters, one for each singular value.
    pub fn directions(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.values.len()).map(|k| self.right.col_as_slice(k))
    }

    /// The x of least norm that minimises `|A x - b|`; directions with a singular value below the
    /// share `unseen` of the largest do not count.
    pub fn least_squares(&self, right: &[f64], unseen: f64) -> Vec<f64> {
        let mut x = vec![0.0; self.right.nrows()];
        for ((k, value), direction) in self.values.iter().enumerate().zip(self.directions()) {
            if *value > unseen * self.values[0] {
                let along = self.left.col_as_slice(k).iter().zip(right);
                let size = along.map(|(u, b)| u * b).sum::<f64>() / value;
                x.iter_mut().zip(direction).for_each(|(x, v)| *x += size * v);
            }
        }
        x
    }
}
