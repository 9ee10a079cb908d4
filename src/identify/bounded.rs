//! Linear least squares within bounds: bounded variables least squares (Stark and Parker 1995).

use std::vec;
use std::vec::Vec;

use crate::scalar::Real;

/// Directions with a singular value below this share of the largest, with all columns scaled to
/// length one, are not identifiable.
const UNIDENTIFIABLE: f64 = 1e-10;
/// Where every pivot is at least this share of the largest, all directions are identifiable.
const WELL_CONDITIONED: f64 = 1e-5;
/// Jacobi rotations end when all pairs of columns are orthogonal to this accuracy, or after
/// [`MAX_ROUNDS`].
const ORTHOGONAL: f64 = 1e-15;
const MAX_ROUNDS: usize = 40;
/// A parameter leaves its bound where the slope of the error, with columns of length one, is this
/// share of the right-hand side.
const RELEASE_SLOPE: f64 = 1e-10;

/// Minimises `|A x - b|` within bounds; `x` is 0 along directions that A does not determine.
///
/// `matrix` is A, `right.len()` rows of `lower.len()` numbers. Where A or b is not finite the
/// result is zeros. Bounded variables least squares (Stark and Parker 1995).
///
/// # Examples
///
/// ```
/// use stribeck::identify::bounded_least_squares;
///
/// let line = [1.0, 0.0, 1.0, 1.0, 1.0, 2.0];
/// let lower = [f64::NEG_INFINITY; 2];
/// let best = bounded_least_squares(&line, &[1.0, 3.0, 5.0], &lower, &[9.0, 1.5]);
/// assert_eq!(best[1], 1.5);
/// assert!((best[0] - 1.5).abs() < 1e-12);
/// ```
#[must_use]
pub fn bounded_least_squares(
    matrix: &[f64],
    right: &[f64],
    lower: &[f64],
    upper: &[f64],
) -> Vec<f64> {
    let count = lower.len();
    let Some((columns, lengths)) = unit_columns(matrix, count) else { return vec![0.0; count] };
    if right.iter().any(|x| !x.is_finite()) {
        return vec![0.0; count];
    }
    let scaled = |bounds: &[f64]| bounds.iter().zip(&lengths).map(|(x, l)| x * l).collect();
    let mut search =
        Bounded { columns, right, lower: scaled(lower), upper: scaled(upper), x: vec![0.0; count] };
    search.solve();
    let unscaled = |k: usize| {
        // At a bound return it exactly, without the rounding of the column scale.
        if search.x[k] <= search.lower[k] {
            lower[k]
        } else if search.x[k] >= search.upper[k] {
            upper[k]
        } else {
            (search.x[k] / lengths[k]).max(lower[k]).min(upper[k])
        }
    };
    (0..count).map(unscaled).collect()
}

/// Columns scaled to length one, and their lengths; `None` where a length is not finite.
fn unit_columns(matrix: &[f64], count: usize) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
    let mut columns = Vec::with_capacity(count);
    let mut lengths = Vec::with_capacity(count);
    for k in 0..count {
        let mut column: Vec<f64> = matrix.iter().skip(k).step_by(count).copied().collect();
        if column.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let largest = column.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let size = if largest > 0.0 { largest } else { 1.0 };
        // Divided by the largest element first, so that no square overflows.
        column.iter_mut().for_each(|x| *x /= size);
        let length = if largest > 0.0 { Real::sqrt(dot(&column, &column)) } else { 1.0 };
        column.iter_mut().for_each(|x| *x /= length);
        lengths.push(size * length);
        columns.push(column);
    }
    lengths.iter().all(|length| length.is_finite()).then_some((columns, lengths))
}

struct Bounded<'a> {
    columns: Vec<Vec<f64>>,
    right: &'a [f64],
    lower: Vec<f64>,
    upper: Vec<f64>,
    x: Vec<f64>,
}

impl Bounded<'_> {
    fn solve(&mut self) {
        let count = self.x.len();
        let mut free = vec![true; count];
        // Parameters beyond their bound are fixed there until the others allow otherwise.
        loop {
            let best = self.best(&free);
            let mut fixed = false;
            for k in (0..count).filter(|&k| free[k]) {
                if best[k] < self.lower[k] || best[k] > self.upper[k] {
                    self.x[k] = best[k].max(self.lower[k]).min(self.upper[k]);
                    fixed = true;
                }
            }
            if !fixed {
                self.x = best;
                break;
            }
            for k in 0..count {
                free[k] &= best[k] >= self.lower[k] && best[k] <= self.upper[k];
            }
        }
        for _ in 0..10 * count {
            let Some(released) = self.steepest_into_range(&free) else { break };
            free[released] = true;
            if !self.move_to_best(&mut free, released) {
                break;
            }
        }
    }

    /// The fixed parameter with the steepest descent into its range.
    fn steepest_into_range(&self, free: &[bool]) -> Option<usize> {
        let residual = self.residual(&vec![false; self.x.len()]);
        let least = RELEASE_SLOPE * Real::sqrt(dot(self.right, self.right));
        let pull = |k: usize| {
            let slope = dot(&self.columns[k], &residual);
            let up = self.x[k] < self.upper[k] && slope > 0.0;
            let down = self.x[k] > self.lower[k] && slope < 0.0;
            if up || down { slope.abs() } else { 0.0 }
        };
        let fixed = (0..self.x.len()).filter(|&k| !free[k]).map(|k| (k, pull(k)));
        let strongest = fixed.fold((0, 0.0), |most, own| if own.1 > most.1 { own } else { most });
        (strongest.1 > least).then_some(strongest.0)
    }

    /// Moves towards the minimum over the free parameters; one that meets its bound on the way is
    /// fixed there. False where the parameter just freed does not move.
    fn move_to_best(&mut self, free: &mut [bool], freed: usize) -> bool {
        let mut first = true;
        loop {
            let best = self.best(free);
            let mut reach = 1.0;
            let mut met = None;
            for k in (0..best.len()).filter(|&k| free[k]) {
                let way = best[k] - self.x[k];
                let room = if way > 0.0 { self.upper[k] } else { self.lower[k] } - self.x[k];
                if way != 0.0 && room / way < reach {
                    (reach, met) = (room / way, Some(k));
                }
            }
            if first && met == Some(freed) && reach <= 0.0 {
                free[freed] = false;
                return false;
            }
            first = false;
            for k in (0..best.len()).filter(|&k| free[k]) {
                self.x[k] += reach * (best[k] - self.x[k]);
            }
            let Some(met) = met else { return true };
            let up = best[met] > self.x[met];
            self.x[met] = if up { self.upper[met] } else { self.lower[met] };
            free[met] = false;
        }
    }

    /// The residual of the parameters that are not in `out`.
    fn residual(&self, out: &[bool]) -> Vec<f64> {
        let mut left = self.right.to_vec();
        for (k, column) in self.columns.iter().enumerate().filter(|&(k, _)| !out[k]) {
            for (left, x) in left.iter_mut().zip(column) {
                *left -= self.x[k] * x;
            }
        }
        left
    }

    /// The minimum over the free parameters with the others fixed.
    fn best(&self, free: &[bool]) -> Vec<f64> {
        let residual = self.residual(free);
        let own = (0..self.x.len()).filter(|&k| free[k]);
        let columns: Vec<Vec<f64>> = own.clone().map(|k| self.columns[k].clone()).collect();
        let mut best = self.x.clone();
        let solved = by_reflections(columns.clone(), &residual)
            .unwrap_or_else(|| of_least_norm(columns, &residual));
        for (k, x) in own.zip(solved) {
            best[k] = x;
        }
        best
    }
}

/// The minimum by Householder reflections with column pivoting (Golub and Van Loan, section 5.4.2);
/// `None` where a direction is poorly determined.
fn by_reflections(mut columns: Vec<Vec<f64>>, right: &[f64]) -> Option<Vec<f64>> {
    let (count, mut right) = (columns.len(), right.to_vec());
    let mut order: Vec<usize> = (0..count).collect();
    let mut largest = 0.0_f64;
    for k in 0..count {
        let square = |column: &[f64]| column.get(k..).map_or(0.0, |below| dot(below, below));
        let longest = (k..count).fold((k, -1.0), |most, j| {
            let own = square(&columns[j]);
            if own > most.1 { (j, own) } else { most }
        });
        columns.swap(k, longest.0);
        order.swap(k, longest.0);
        let norm = Real::sqrt(longest.1);
        largest = largest.max(norm);
        if norm.is_nan() || norm <= WELL_CONDITIONED * largest {
            return None;
        }
        let (done, rest) = columns.split_at_mut(k + 1);
        let own = &mut done[k][k..];
        let diagonal = if own[0] > 0.0 { -norm } else { norm };
        own[0] -= diagonal;
        let scale = 1.0 / (diagonal * own[0]);
        for column in rest.iter_mut().map(|column| &mut column[k..]).chain([&mut right[k..]]) {
            let product = dot(own, column) * scale;
            for (x, entry) in column.iter_mut().zip(own.iter()) {
                *x += entry * product;
            }
        }
        own[0] = diagonal;
    }
    let mut x = vec![0.0; count];
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|j| columns[j][k] * x[order[j]]).sum();
        x[order[k]] = (right[k] - known) / columns[k][k];
    }
    Some(x)
}

/// The minimum of least norm by singular values: columns are rotated in pairs until they are
/// orthogonal (one-sided Jacobi, Hestenes 1958).
fn of_least_norm(mut columns: Vec<Vec<f64>>, right: &[f64]) -> Vec<f64> {
    let count = columns.len();
    let unit = |k: usize| (0..count).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
    let mut basis: Vec<Vec<f64>> = (0..count).map(unit).collect();
    for _ in 0..MAX_ROUNDS {
        let mut rotated = false;
        for p in 0..count {
            for q in p + 1..count {
                if let Some((cosine, sine)) = rotation(&columns[p], &columns[q]) {
                    rotate(&mut columns, p, q, cosine, sine);
                    rotate(&mut basis, p, q, cosine, sine);
                    rotated = true;
                }
            }
        }
        if !rotated {
            break;
        }
    }
    let squares: Vec<f64> = columns.iter().map(|column| dot(column, column)).collect();
    let largest = squares.iter().fold(0.0_f64, |most, &x| most.max(x));
    let mut x = vec![0.0; count];
    for ((column, basis), &square) in columns.iter().zip(&basis).zip(&squares) {
        if square > UNIDENTIFIABLE * UNIDENTIFIABLE * largest {
            let share = dot(column, right) / square;
            for (x, basis) in x.iter_mut().zip(basis) {
                *x += share * basis;
            }
        }
    }
    x
}

/// Cosine and sine of the rotation that makes two columns orthogonal, unless they are.
fn rotation(x: &[f64], y: &[f64]) -> Option<(f64, f64)> {
    let (first, second, both) = (dot(x, x), dot(y, y), dot(x, y));
    if both.abs() <= ORTHOGONAL * Real::sqrt(first * second) {
        return None;
    }
    let half = (second - first) / (2.0 * both);
    let tangent = 1.0 / (half.abs() + Real::sqrt(1.0 + half * half));
    let tangent = if half < 0.0 { -tangent } else { tangent };
    let cosine = 1.0 / Real::sqrt(1.0 + tangent * tangent);
    Some((cosine, cosine * tangent))
}

fn rotate(columns: &mut [Vec<f64>], p: usize, q: usize, cosine: f64, sine: f64) {
    let (left, right) = columns.split_at_mut(q);
    for (x, y) in left[p].iter_mut().zip(&mut right[0]) {
        (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
