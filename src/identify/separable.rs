//! Separable least squares with Levenberg-Marquardt steps.
//!
//! Variable projection (Golub and Pereyra 1973) in Kaufman's form (1975): steps are taken in the
//! nonlinear parameters alone, and the linear ones are solved for at each point. The error that is
//! compared before and after a step is therefore the minimum over the linear parameters. The
//! damping follows Nielsen (1999). Bounds hold at all times; a parameter whose bounds are equal is
//! fixed.

use std::vec;
use std::vec::Vec;

use super::bounded::bounded_least_squares;
use super::triangle::Triangle;
use crate::scalar::Real;

/// Least damping after a rejected step.
const MIN_REJECTED_DAMPING: f64 = 5e-4;
/// At larger damping a step is indistinguishable from none.
const MAX_DAMPING: f64 = 1e20;
/// Smaller damping is set to 0.
const NO_DAMPING: f64 = 1e-12;
/// The damping of a column scales with its largest length so far, or its parameter might diverge
/// where the torque does not depend on it (Moré 1978). A parameter between bounds cannot diverge,
/// and a column that was very long once would fix it for good: its length decays by this factor per
/// step.
const LENGTH_DECAY: f64 = 0.5;
/// A search ends after this many consecutive steps with a relative decrease below the tolerance: in
/// a curved valley the undamped step always predicts more.
const MAX_IDLE_STEPS: usize = 3;
/// A linear step with a relative decrease above this changes the columns of the nonlinear
/// parameters: they are computed again.
const RELINEARISE_ABOVE: f64 = 1e-3;

/// A model and a measured torque: samples in memory, or a data set read in passes.
pub trait LeastSquares {
    /// Why the problem cannot be evaluated at all.
    type Error;

    /// The problem linearised at `values` with respect to the parameters `wanted`, whose columns
    /// are multiplied by `slope`; `None` where the model is not finite.
    ///
    /// An error that does not depend on `values`.
    /// What keeps it from being evaluated anywhere.
    fn triangle(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> Result<Option<Triangle>, Self::Error>;

    /// Norm of the measured torque; called after the first `triangle`.
    ///
    /// # Errors
    /// As `triangle`.
    fn torque_norm(&self) -> Result<f64, Self::Error>;
}

/// Bounds and kinds of the parameters.
#[derive(Clone, Copy, Debug)]
pub struct Bounds<'a> {
    /// Lower bounds; minus infinity for none.
    pub lower: &'a [f64],
    /// Upper bounds; a parameter whose bounds are equal is fixed.
    pub upper: &'a [f64],
    /// Parameters in which the torque is linear.
    pub linear: &'a [bool],
    /// Nonlinear parameters that are searched by their logarithm; they keep their sign.
    pub logarithmic: &'a [bool],
}

impl Bounds<'_> {
    fn enclose(&self, k: usize) -> bool {
        self.lower[k].is_finite() && self.upper[k].is_finite()
    }
}

/// Options of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// The search ends when the undamped step predicts a smaller relative decrease, or when several
    /// damped steps bring a smaller one.
    pub tolerance: f64,
    /// Largest number of steps, rejected ones included.
    pub max_steps: usize,
    /// Initial damping relative to the squared lengths of the columns: 0 from a point near the
    /// minimum.
    pub damping: f64,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A further step would change nothing.
    Converged,
    /// A further decrease would be below the rounding error.
    ToRounding,
    /// The largest number of steps was reached.
    Stopped,
    /// The model is not finite at the start.
    NotFinite,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// The parameters at the end.
    pub values: Vec<f64>,
    /// Sum of squares there; infinite where the model is not finite at the start.
    pub square: f64,
    /// Why it ended.
    pub outcome: Outcome,
    /// Nonlinear parameters that do not influence the torque there: steps do not change them.
    pub insensitive: Vec<usize>,
    /// Number of linearisations.
    pub evaluations: usize,
}

/// Minimises the sum of squares from `start`, to a local minimum.
///
/// # Errors
/// Errors of the problem.
pub fn minimise<P: LeastSquares>(
    problem: &P,
    start: &[f64],
    bounds: &Bounds<'_>,
    steps: Steps,
) -> Result<Search, P::Error> {
    let mut search = Separable::new(problem, bounds);
    let start = (0..start.len()).map(|k| clip(start[k], bounds.lower[k], bounds.upper[k]));
    search.descend(start.collect(), steps)
}

/// Values with optimal linear parameters, and the problem linearised there.
struct Point {
    values: Vec<f64>,
    triangle: Triangle,
}

/// A problem with its free parameters ordered: the linear ones first.
struct Separable<'a, P> {
    problem: &'a P,
    bounds: &'a Bounds<'a>,
    order: Vec<usize>,
    /// Number of linear ones.
    linear: usize,
    evaluations: usize,
}

impl<'a, P: LeastSquares> Separable<'a, P> {
    fn new(problem: &'a P, bounds: &'a Bounds<'a>) -> Self {
        let free = |&k: &usize| bounds.lower[k] < bounds.upper[k];
        let all = || (0..bounds.lower.len()).filter(free);
        let mut order: Vec<usize> = all().filter(|&k| bounds.linear[k]).collect();
        let linear = order.len();
        order.extend(all().filter(|&k| !bounds.linear[k]));
        Self { problem, bounds, order, linear, evaluations: 0 }
    }

    /// Damped steps until convergence.
    fn descend(&mut self, start: Vec<f64>, steps: Steps) -> Result<Search, P::Error> {
        let Some(mut point) = self.at(start.clone(), f64::INFINITY)? else {
            return Ok(self.ended(start, None, Outcome::NotFinite));
        };
        // A smaller decrease is below the rounding error of the torque itself.
        let noise = 4.0 * f64::EPSILON * self.problem.torque_norm()?;
        let mut damping = steps.damping;
        let mut scale = vec![0.0; self.order.len()];
        let mut growth = 2.0;
        let mut idle = 0;
        let mut outcome = Outcome::Stopped;
        for _ in 0..steps.max_steps {
            let square = point.triangle.square();
            let full = self.step(&point, None);
            let least = (steps.tolerance * square).max(noise * noise);
            if idle == MAX_IDLE_STEPS || point.triangle.fall(&full) <= least {
                outcome = Outcome::Converged;
                break;
            }
            let lengths = self.lengths(&point.triangle);
            for (scale, (&k, length)) in scale.iter_mut().zip(self.order.iter().zip(lengths)) {
                let kept = if self.bounds.enclose(k) { LENGTH_DECAY * *scale } else { *scale };
                *scale = f64::max(kept, length);
            }
            let step = match damping {
                0.0 => full,
                _ => self.step(&point, Some((Real::sqrt(damping), &scale))),
            };
            let foreseen = point.triangle.fall(&step);
            let most = square + noise * Real::sqrt(square);
            match self.at(self.moved(&point.values, &step), most)? {
                Some(tried) if tried.triangle.square() <= most => {
                    let fall = square - tried.triangle.square();
                    idle = if fall > least { 0 } else { idle + 1 };
                    let share =
                        if foreseen > 0.0 { (fall / foreseen).clamp(0.0, 1.0) } else { 0.0 };
                    let apart = 2.0 * share - 1.0;
                    point = tried;
                    damping *= (1.0 - apart * apart * apart).max(0.1);
                    damping = if damping < NO_DAMPING { 0.0 } else { damping };
                    growth = 2.0;
                }
                _ => {
                    damping = damping.max(MIN_REJECTED_DAMPING) * growth;
                    growth *= 2.0;
                    if damping > MAX_DAMPING {
                        outcome = Outcome::ToRounding;
                        break;
                    }
                }
            }
        }
        Ok(self.ended(point.values, Some(&point.triangle), outcome))
    }

    fn ended(&self, values: Vec<f64>, there: Option<&Triangle>, outcome: Outcome) -> Search {
        let square = there.map_or(f64::INFINITY, Triangle::square);
        let insensitive = there.map_or(vec![], |triangle| self.insensitive(triangle));
        Search { values, square, outcome, insensitive, evaluations: self.evaluations }
    }

    /// The nonlinear parameters whose columns are zero.
    fn insensitive(&self, triangle: &Triangle) -> Vec<usize> {
        let count = self.order.len();
        let nothing = |&k: &usize| (0..count).all(|row| triangle.row(row)[k] == 0.0);
        (self.linear..count).filter(nothing).map(|k| self.order[k]).collect()
    }

    /// The point with the nonlinear parameters of `values`; `None` where it is not finite. Where
    /// the sum of squares is above `most` the step will be rejected, so the columns are not
    /// computed again.
    fn at(&mut self, values: Vec<f64>, most: f64) -> Result<Option<Point>, P::Error> {
        let mut found = self.linearised(values)?;
        for _ in 0..2 {
            let Some(point) = found else { return Ok(None) };
            if self.linear == 0 {
                return Ok(Some(point));
            }
            let square = point.triangle.square();
            let solved = self.with_linear_solved(point);
            let left = solved.triangle.square();
            if left > most || square - left <= RELINEARISE_ABOVE * square {
                return Ok(Some(solved));
            }
            found = self.linearised(solved.values)?;
        }
        Ok(found)
    }

    fn linearised(&mut self, values: Vec<f64>) -> Result<Option<Point>, P::Error> {
        if values.iter().any(|x| !x.is_finite()) {
            return Ok(None);
        }
        self.evaluations += 1;
        let slope = |&k: &usize| if self.in_logarithm(k) { values[k] } else { 1.0 };
        let slopes: Vec<f64> = self.order.iter().map(slope).collect();
        let made = self.problem.triangle(&values, &self.order, &slopes)?;
        Ok(made.map(|triangle| Point { values, triangle }))
    }

    /// Solves for the linear parameters; the torque is linear in them, so R stays.
    fn with_linear_solved(&self, point: Point) -> Point {
        let n = self.linear;
        let Point { values, triangle } = point;
        let inner: Vec<f64> = (0..n).flat_map(|row| triangle.row(row)[..n].to_vec()).collect();
        let right: Vec<f64> = (0..n).map(|row| triangle.right(row)).collect();
        let (lower, upper) = self.room(&values);
        let mut step = bounded_least_squares(&inner, &right, &lower[..n], &upper[..n]);
        step.resize(self.order.len(), 0.0);
        Point { values: self.moved(&values, &step), triangle: triangle.moved(&step) }
    }

    /// The optimal step of the free parameters, damped or not.
    fn step(&self, point: &Point, damping: Option<(f64, &[f64])>) -> Vec<f64> {
        let count = self.order.len();
        let triangle = &point.triangle;
        let mut matrix: Vec<f64> =
            (0..count).flat_map(|row| triangle.row(row)[..count].to_vec()).collect();
        let mut right: Vec<f64> = (0..count).map(|row| triangle.right(row)).collect();
        if let Some((root, scale)) = damping {
            for (k, scale) in scale.iter().enumerate() {
                matrix.extend((0..count).map(|j| if j == k { root * scale } else { 0.0 }));
                right.push(0.0);
            }
        }
        let (lower, upper) = self.room(&point.values);
        bounded_least_squares(&matrix, &right, &lower, &upper)
    }

    /// Lengths of the columns of the nonlinear parameters after projection onto the complement of
    /// the linear ones.
    fn lengths(&self, triangle: &Triangle) -> Vec<f64> {
        let (n, count) = (self.linear, self.order.len());
        let square =
            |k: usize| (n..count).map(|row| triangle.row(row)[k] * triangle.row(row)[k]).sum();
        let length = |k| if k < n { 0.0 } else { Real::sqrt(square(k)) };
        (0..count).map(length).collect()
    }

    /// `values` after a step of the free parameters, within bounds.
    fn moved(&self, values: &[f64], step: &[f64]) -> Vec<f64> {
        let mut after = values.to_vec();
        for (&k, &step) in self.order.iter().zip(step) {
            let gone =
                if self.in_logarithm(k) { values[k] * Real::exp(step) } else { values[k] + step };
            after[k] = clip(gone, self.bounds.lower[k], self.bounds.upper[k]);
        }
        after
    }

    /// Distances of each free parameter to its bounds, down and up.
    fn room(&self, values: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let way = |k: usize, to: f64| {
            if self.in_logarithm(k) { Real::ln((to / values[k]).max(0.0)) } else { to - values[k] }
        };
        let both = |&k: &usize| {
            let (down, up) = (way(k, self.bounds.lower[k]), way(k, self.bounds.upper[k]));
            (down.min(up), down.max(up))
        };
        self.order.iter().map(both).unzip()
    }

    fn in_logarithm(&self, k: usize) -> bool {
        self.bounds.logarithmic[k] && !self.bounds.linear[k]
    }
}

/// Like `clamp`, but NaN stays NaN; the evaluation detects it.
fn clip(x: f64, lower: f64, upper: f64) -> f64 {
    if x < lower {
        lower
    } else if x > upper {
        upper
    } else {
        x
    }
}
