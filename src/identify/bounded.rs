//! Linear least squares within bounds: bounded variables least squares (Stark and Parker 1995).

use std::vec;
use std::vec::Vec;

use super::dense::Dense;
use crate::scalar::Real;

/// Directions with a singular value below this share of the largest, with all columns scaled to
/// length one, are not identifiable.
const UNIDENTIFIABLE: f64 = 1e-10;
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
    let mut search = Bounded {
        dense: Dense::new(right.len(), count),
        columns,
        right,
        lower: scaled(lower),
        upper: scaled(upper),
        x: vec![0.0; count],
    };
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
    dense: Dense,
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
    fn best(&mut self, free: &[bool]) -> Vec<f64> {
        let residual = self.residual(free);
        let own = (0..self.x.len()).filter(|&k| free[k]);
        let columns = own.clone().map(|k| &self.columns[k][..]);
        let mut best = self.x.clone();
        let solved = self.dense.least_squares(columns, &residual, UNIDENTIFIABLE);
        // Finite columns of length one have singular values.
        for (k, x) in own.zip(solved.unwrap_or_default()) {
            best[k] = x;
        }
        best
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
