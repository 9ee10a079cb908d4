//! The largest share of friction that a compensator may cancel without generating energy.
//!
//! A compensator that applies `c` times its model `g` leaves `f - c g`. In steady sliding this
//! dissipates at every operating point if and only if `c g <= f` along the motion, so the largest
//! such `c` is the minimum of `f/g` over the points with `g > 0`; where `g` brakes, any `c` is
//! admissible as long as `f` dissipates. Branch and bound gives bounds of the minimum.
//!
//! Where `g` is `f` with other parameters, the mean value theorem gives a second bound,
//! `f/g >= 1 + (sum_p df/dp (p - p0))/g`, with the derivatives enclosed over all possible
//! parameters. It converges faster, because numerator and denominator no longer vary independently.

use std::vec::Vec;

use super::enclosure::Enclosure;
use super::friction::sliding;
use super::region::{Point, Region, Side};
use super::search::Search;
use super::{PassivityError, branches, regions_of};
use crate::composed::{Composed, Spec};
use crate::error::ModelError;
use crate::scalar::Dual;

/// Relative distance of the bounds at which the search ends.
const TOLERANCE: f64 = 5e-3;

/// Number of derivatives per evaluation.
const DERIVATIVES_PER_PASS: usize = 8;

/// The largest admissible factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// Proved: with this factor friction is nowhere exceeded. Infinite where nothing is cancelled;
    /// not above zero where no factor is admissible.
    pub proved: f64,
    /// The factor that is admissible at `point` alone.
    pub at_point: f64,
    /// The point that limits the factor.
    pub point: Option<Point>,
}

/// The largest factor of a compensator (a model and its parameter values) for friction whose
/// parameters are known to lie within bounds.
///
/// # Errors
/// A model or a box that cannot be used.
pub fn largest_factor(
    (compensator, values): (&Spec, &[f64]),
    (friction, bounds): (&Spec, &[[f64; 2]]),
    sides: &[Side],
    budget: usize,
) -> Result<Factor, PassivityError> {
    let regions = regions_of(&[compensator, friction], sides)?;
    let disordered =
        |&[lower, upper]: &[f64; 2]| !(lower.is_finite() && upper.is_finite() && lower <= upper);
    if let Some(position) = bounds.iter().position(disordered) {
        return Err(PassivityError::Bounds(position, bounds[position]));
    }
    if branches(compensator) || branches(friction) {
        return Err(PassivityError::Branches);
    }
    // Refuses values that are not finite, which an interval would take for unknown.
    compensator.with(values)?;
    let bounds: Vec<_> =
        bounds.iter().map(|&[lower, upper]| Enclosure::new(lower, upper)).collect();
    let numbers: Vec<_> = values.iter().map(|&x| Enclosure::point(x)).collect();
    let pair = Pair {
        cancels: compensator.with(&numbers)?,
        resists: friction.with(&bounds)?,
        spread: if compensator == friction {
            Some(Spread::of(friction, values, &bounds)?)
        } else {
            None
        },
    };
    let share = |region: &Region| pair.share(region);
    let channels: Vec<_> = sides.iter().map(|side| side.channel).collect();
    let mut search = Search::over(&regions, &channels, &share);
    // Where a point admits no factor above zero, the bound does not matter.
    search
        .run(budget, |s| s.upper() <= 0.0 || s.upper() - s.lower() <= TOLERANCE * s.upper().abs());
    let (at_point, point) = search.best.map_or((f64::INFINITY, None), |(x, at)| (x, Some(at)));
    Ok(Factor { proved: search.lower(), at_point, point })
}

/// A compensator and the friction that it compensates.
struct Pair {
    cancels: Composed<Enclosure>,
    resists: Composed<Enclosure>,
    spread: Option<Spread>,
}

impl Pair {
    /// A lower bound of the factor over a region. Even at a single point it is the minimum over all
    /// possible parameters. `None` where any factor is admissible.
    fn share(&self, region: &Region) -> Option<Enclosure> {
        let (cancelled, there) = (sliding(&self.cancels, region), sliding(&self.resists, region));
        if cancelled.upper <= 0.0 && there.lower >= 0.0 {
            return None;
        }
        // The least ratio: friction that opposes the motion over the most that is cancelled,
        // friction that drives it over the least.
        let over = if there.lower >= 0.0 { cancelled.upper } else { cancelled.lower.max(0.0) };
        let ratio = Enclosure::point(there.lower) / Enclosure::point(over);
        let spread = self.spread.as_ref().filter(|_| cancelled.lower > 0.0);
        let mean = spread.map_or(f64::NEG_INFINITY, |spread| {
            (Enclosure::point(1.0) + spread.change(region) / cancelled).lower
        });
        Some(Enclosure::point(ratio.lower.max(mean)))
    }
}

/// The difference of friction from its nominal value when its parameters vary.
struct Spread {
    /// The model with derivatives with respect to some parameters, and the deviations of these.
    parts: Vec<(Composed<Dual<Enclosure, DERIVATIVES_PER_PASS>>, Vec<Enclosure>)>,
}

impl Spread {
    fn of(spec: &Spec, values: &[f64], bounds: &[Enclosure]) -> Result<Self, ModelError<'static>> {
        // The mean value theorem needs all parameters between the nominal and the possible ones.
        let between: Vec<_> =
            bounds.iter().zip(values).map(|(x, &v)| x.hull(Enclosure::point(v))).collect();
        let uncertain: Vec<_> =
            (0..bounds.len()).filter(|&k| bounds[k] != Enclosure::point(values[k])).collect();
        let part = |some: &[usize]| {
            let mut variables: Vec<_> = between.iter().map(|&x| Dual::constant(x)).collect();
            for (direction, &k) in some.iter().enumerate() {
                variables[k] = Dual::variable(between[k], direction);
            }
            let off = some.iter().map(|&k| bounds[k] - Enclosure::point(values[k])).collect();
            Ok::<_, ModelError<'static>>((spec.with(&variables)?, off))
        };
        let parts = uncertain.chunks(DERIVATIVES_PER_PASS).map(part).collect::<Result<_, _>>()?;
        Ok(Self { parts })
    }

    /// Friction in sliding minus the nominal friction, along the motion (T).
    fn change(&self, region: &Region) -> Enclosure {
        let mut sum = Enclosure::point(0.0);
        for (model, off) in &self.parts {
            for (&slope, &off) in sliding(model, region).derivative.iter().zip(off) {
                sum += slope * off;
            }
        }
        sum
    }
}
