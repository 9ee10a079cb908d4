//! Separable least squares by Levenberg and Marquardt's method.
//!
//! Golub and Pereyra (1973), in Kaufman's form (1975): steps are taken in the nonlinear parameters
//! alone, and at each point the linear ones are solved for. What is damped, and what is compared
//! before and after, is therefore the error that the linear parameters leave. Damping follows
//! Nielsen (1999). Bounds hold throughout; a parameter whose bounds are equal is held.

use std::vec;
use std::vec::Vec;

use super::bounded::bounded_least_squares;
use super::triangle::Triangle;
use crate::scalar::Real;

/// Damping from which a step that is taken back goes on.
const LEAST_RETREAT: f64 = 5e-4;
/// A damping beyond which no step can be told from standing still.
const MOST_DAMPING: f64 = 1e20;
/// A damping below which there is none.
const NO_DAMPING: f64 = 1e-12;
/// The longest that a column has been scales its damping, or its parameter might run away where
/// nothing depends on it (Moré 1978). One between bounds cannot, and would be held for good by a
/// column that was once very long: its length fades, to this share with each step.
const FADING: f64 = 0.5;
/// After so many steps in a row that lower the sum of squares by less than the tolerance a search is
/// over: in the bend of a model that has one, the undamped step never foresees so little.
const MOST_IDLE: usize = 3;
/// A linear step that lowers the sum of squares by more than this share bends the columns of the
/// nonlinear parameters: they are computed anew.
const BENT: f64 = 1e-3;

/// A model against measured torque: rows in memory, or a data set that is read in passes.
pub trait LeastSquares {
    /// Why it cannot be evaluated at all.
    type Error;

    /// The problem linearised at `values` by the parameters `wanted`, their columns times `slope`;
    /// none where the model is not finite.
    ///
    /// # Errors
    /// What keeps it from being evaluated anywhere.
    fn triangle(
        &self,
        values: &[f64],
        wanted: &[usize],
        slope: &[f64],
    ) -> Result<Option<Triangle>, Self::Error>;

    /// Norm of the measured torque; asked for after the first `triangle`.
    ///
    /// # Errors
    /// As `triangle`.
    fn torque_norm(&self) -> Result<f64, Self::Error>;
}

/// Between what the parameters of a model are sought.
#[derive(Clone, Copy, Debug)]
pub struct Bounds<'a> {
    /// Lower ones; minus infinity: none.
    pub lower: &'a [f64],
    /// Upper ones; a parameter whose bounds are equal is held.
    pub upper: &'a [f64],
    /// In which parameters the torque is linear.
    pub linear: &'a [bool],
    /// Nonlinear parameters whose logarithm is stepped in; they keep their sign.
    pub logarithmic: &'a [bool],
}

impl Bounds<'_> {
    fn enclose(&self, k: usize) -> bool {
        self.lower[k].is_finite() && self.upper[k].is_finite()
    }
}

/// How a search goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// The search ends when the undamped step foresees a smaller relative fall, or some damped ones
    /// bring a smaller one.
    pub tolerance: f64,
    /// Most steps, those that are taken back included.
    pub most: usize,
    /// First damping, in squared lengths of the columns: 0 from a point near the minimum.
    pub damping: f64,
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Another step would change nothing.
    Converged,
    /// No step can be told from rounding.
    ToRounding,
    /// At the largest number of steps.
    Stopped,
    /// The model is not finite at the start.
    NotFinite,
}

/// Where a search ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// The parameters.
    pub values: Vec<f64>,
    /// Sum of squares there; infinite where the model is not finite at the start.
    pub square: f64,
    /// How it ended.
    pub outcome: Outcome,
    /// Nonlinear parameters on which the torque does not depend there: no step changes them.
    pub blind: Vec<usize>,
    /// How often the problem was linearised.
    pub evaluations: usize,
}

/// Brings the sum of squares down from `start` to the minimum it leads to.
///
/// # Errors
/// Those of the problem.
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

/// Values at which the linear parameters are the best, and the problem linearised there.
struct Point {
    values: Vec<f64>,
    triangle: Triangle,
}

/// A problem with its free parameters in order: the linear ones first.
struct Separable<'a, P> {
    problem: &'a P,
    bounds: &'a Bounds<'a>,
    order: Vec<usize>,
    /// How many of them are linear.
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

    /// Damped steps until the next one would change nothing.
    fn descend(&mut self, start: Vec<f64>, steps: Steps) -> Result<Search, P::Error> {
        let Some(mut point) = self.at(start.clone(), f64::INFINITY)? else {
            return Ok(self.ended(start, None, Outcome::NotFinite));
        };
        // Below this a fall cannot be told from the rounding of the torque itself.
        let noise = 4.0 * f64::EPSILON * self.problem.torque_norm()?;
        let mut damping = steps.damping;
        let mut scale = vec![0.0; self.order.len()];
        let mut growth = 2.0;
        let mut idle = 0;
        let mut outcome = Outcome::Stopped;
        for _ in 0..steps.most {
            let square = point.triangle.square();
            let full = self.step(&point, None);
            let least = (steps.tolerance * square).max(noise * noise);
            if idle == MOST_IDLE || point.triangle.fall(&full) <= least {
                outcome = Outcome::Converged;
                break;
            }
            let lengths = self.lengths(&point.triangle);
            for (scale, (&k, length)) in scale.iter_mut().zip(self.order.iter().zip(lengths)) {
                let kept = if self.bounds.enclose(k) { FADING * *scale } else { *scale };
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
                    damping = damping.max(LEAST_RETREAT) * growth;
                    growth *= 2.0;
                    if damping > MOST_DAMPING {
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
        let blind = there.map_or(vec![], |triangle| self.blind(triangle));
        Search { values, square, outcome, blind, evaluations: self.evaluations }
    }

    /// The nonlinear parameters whose columns are nothing.
    fn blind(&self, triangle: &Triangle) -> Vec<usize> {
        let count = self.order.len();
        let nothing = |&k: &usize| (0..count).all(|row| triangle.row(row)[k] == 0.0);
        (self.linear..count).filter(nothing).map(|k| self.order[k]).collect()
    }

    /// The point with the nonlinear parameters of `values`; none where it is not finite. Columns are
    /// not computed anew where the sum of squares is above `most`: the point is not gone on from.
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
            if left > most || square - left <= BENT * square {
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

    /// Moves the linear parameters to their best; the torque is linear in them, so R stays.
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

    /// The best step of the free parameters, damped or not.
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

    /// Lengths of the columns of the nonlinear parameters, less what linear ones explain.
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

    /// How far each free parameter may still go, down and up.
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

/// As `clamp`; what is not a number stays, and is found out where it is evaluated.
fn clip(x: f64, lower: f64, upper: f64) -> f64 {
    if x < lower {
        lower
    } else if x > upper {
        upper
    } else {
        x
    }
}
