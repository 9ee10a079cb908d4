//! How much of one friction another may cancel without ever exceeding it.
//!
//! A compensator that gives `c` times its own friction `g` leaves `f - c g`. In steady sliding that
//! takes energy at every operating point if and only if `c g <= f` along the motion, so the largest
//! such `c` is the least value of `f/g` over the points at which `g > 0`; where `g` brakes by
//! itself, any `c` will do as long as `f` does. The least value is bounded by subdivision.
//!
//! Where `g` is `f` with other numbers, the mean value theorem gives a second bound,
//! `f/g >= 1 + (sum_p df/dp (p - p0))/g` with the derivatives over all numbers that are possible: it
//! closes in faster, since both sides of the ratio no longer vary by themselves.

use std::vec::Vec;

use super::PassivityError;
use super::enclosure::Enclosure;
use super::friction::sliding;
use super::region::{Point, Region, Side, pieces};
use super::search::Search;
use crate::composed::{Composed, Spec};
use crate::error::ModelError;
use crate::scalar::Dual;
use crate::table::Channel;

/// How close to each other the bounds have to be, relative to them.
const CLOSE: f64 = 5e-3;

/// Derivatives that are carried along in one evaluation.
const AT_ONCE: usize = 8;

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
    for spec in [compensator, friction] {
        check_sides(spec, sides)?;
    }
    let numbers: Vec<_> = values.iter().map(|&x| Enclosure::point(x)).collect();
    let pair = Pair {
        cancels: compensator.with(&numbers)?,
        resists: friction.with(bounds)?,
        spread: if compensator == friction {
            Some(Spread::of(friction, values, bounds)?)
        } else {
            None
        },
    };
    let share = |region: &Region| pair.share(region);
    let channels: Vec<_> = sides.iter().map(|side| side.channel).collect();
    let regions = pieces(sides);
    let mut search = Search::over(&regions, &channels, &share);
    search.run(budget, |s| s.upper() - s.lower() <= CLOSE * s.upper().abs());
    let (at_point, point) = search.best.map_or((f64::INFINITY, None), |(x, at)| (x, Some(at)));
    Ok(Factor { proved: search.lower(), at_point, point })
}

/// A compensator and the friction that it works against.
struct Pair {
    cancels: Composed<Enclosure>,
    resists: Composed<Enclosure>,
    spread: Option<Spread>,
}

impl Pair {
    /// A lower bound of the factor over a region, as a single number: at a point as well it is the
    /// least of all possible frictions that counts. `None` where any factor will do.
    fn share(&self, region: &Region) -> Option<Enclosure> {
        let (cancelled, there) = (sliding(&self.cancels, region), sliding(&self.resists, region));
        if cancelled.upper <= 0.0 && there.lower >= 0.0 {
            return None;
        }
        let ratio = Enclosure::point(there.lower) / Enclosure::point(cancelled.upper.max(0.0));
        let spread = self.spread.as_ref().filter(|_| cancelled.lower > 0.0);
        let mean = spread.map_or(f64::NEG_INFINITY, |spread| {
            (Enclosure::point(1.0) + spread.change(region) / cancelled).lower
        });
        Some(Enclosure::point(ratio.lower.max(mean)))
    }
}

/// How far a model's friction may be from that with its nominal values.
struct Spread {
    /// With derivatives by some parameters, and how far these may be off.
    parts: Vec<(Composed<Dual<Enclosure, AT_ONCE>>, Vec<Enclosure>)>,
}

impl Spread {
    fn of(spec: &Spec, values: &[f64], bounds: &[Enclosure]) -> Result<Self, ModelError<'static>> {
        // The theorem speaks of all numbers between the nominal ones and the others.
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
            Ok((spec.with(&variables)?, off))
        };
        let parts = uncertain.chunks(AT_ONCE).map(part).collect::<Result<_, _>>()?;
        Ok(Self { parts })
    }

    /// The friction in sliding minus the nominal one, along the motion (T).
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
