//! How much of one friction another may cancel without ever exceeding it.
//!
//! A compensator that gives `c` times its own friction `g` leaves `f - c g`. In steady sliding that
//! takes energy at every operating point if and only if `c g <= f` along the motion, so the largest
//! such `c` is the least value of `f/g` over the points at which `g > 0`; where `g` brakes by
//! itself, any `c` will do as long as `f` does. The least value is bounded by subdivision.

use std::vec::Vec;

use super::PassivityError;
use super::enclosure::Enclosure;
use super::friction::sliding;
use super::region::{Point, Region, Side, pieces};
use super::search::Search;
use crate::composed::Spec;
use crate::table::Channel;

/// How close to each other the bounds have to be, relative to them.
const CLOSE: f64 = 1e-3;

/// The largest factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// With this one the friction is nowhere exceeded: proved. Infinite where nothing is cancelled.
    pub proved: f64,
    /// What the same bound comes to at the single `point`.
    pub at_point: f64,
    /// The point that stands in the way.
    pub point: Option<Point>,
}

/// The largest factor of a compensator (a model and its values) for a friction whose parameters
/// are known to lie within bounds.
///
/// # Errors
/// A model or a box that cannot be used.
pub fn largest(
    (compensator, values): (&Spec, &[f64]),
    (friction, bounds): (&Spec, &[Enclosure]),
    sides: &[Side],
    budget: usize,
) -> Result<Factor, PassivityError> {
    let numbers: Vec<_> = values.iter().map(|&x| Enclosure::point(x)).collect();
    let (cancels, resists) = (compensator.with(&numbers)?, friction.with(bounds)?);
    let channels: Vec<_> = sides.iter().map(|side| side.channel).collect();
    for spec in [compensator, friction] {
        check_sides(spec, sides)?;
    }
    let share = |region: &Region| {
        let (cancelled, there) = (sliding(&cancels, region), sliding(&resists, region));
        if cancelled.upper <= 0.0 && there.lower >= 0.0 {
            return None;
        }
        let least = Enclosure::point(there.lower) / Enclosure::point(cancelled.upper.max(0.0));
        // Over all frictions within the bounds: the least of them counts, at a point as well.
        Some(Enclosure::point(least.lower))
    };
    let regions = pieces(sides);
    let mut search = Search::over(&regions, &channels, &share);
    search.run(budget, |s| s.upper() - s.lower() <= CLOSE * s.upper().abs());
    let (at_point, point) = search.best.map_or((f64::INFINITY, None), |(x, at)| (x, Some(at)));
    Ok(Factor { proved: search.lower(), at_point, point })
}

/// All channels that the model reads have a side, and none holds its pole.
fn check_sides(spec: &Spec, sides: &[Side]) -> Result<(), PassivityError> {
    for channel in spec.channels() {
        let side = sides.iter().find(|side| side.channel == channel);
        let side = side.ok_or(PassivityError::Missing(channel))?;
        if let (Channel::Temperature, Some(pole)) = (channel, spec.pole())
            && (side.lower..=side.upper).contains(&pole)
        {
            return Err(PassivityError::Pole(pole));
        }
    }
    Ok(())
}
