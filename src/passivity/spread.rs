//! Conditions of passivity at points spread over a box. They prove nothing; they guide a fit.

use core::iter::successors;
use std::vec;
use std::vec::Vec;

use super::friction::{Bristled, sliding};
use super::region::{Point, Region, middle_of, set};
use super::requirement::Requirement;
use crate::composed::Composed;
use crate::scalar::Real;
use crate::table::Channel;

/// Number of speeds per region, each half of the one before.
const SPEEDS: usize = 28;

/// Number of values of a channel along which friction may oscillate, and of any other.
const VALUES: (usize, usize) = (13, 5);

/// Number of bristle forces, evenly spaced over those that are reached.
const EVEN_FORCES: u8 = 24;

/// Number of forces in each direction, each half of the one before: around zero the work of the two
/// legs cancels.
const SMALL_FORCES: usize = 10;

/// The least strength and sliding friction of each region, and the worst cycle around each force.
#[must_use]
pub fn worst(
    model: &Composed<f64>,
    regions: &[Region],
    channels: &[Channel],
    bristle: bool,
) -> Vec<Requirement> {
    let points: Vec<_> = regions.iter().map(|region| points(region, channels)).collect();
    let mut found = Vec::new();
    for points in &points {
        found.extend(least(points, |point| sliding(model, point)).map(Requirement::Sliding));
        if bristle {
            let dry = |point: &Point| model.split(point).dry();
            found.extend(least(points, dry).map(Requirement::Strength));
        }
    }
    if bristle {
        found.extend(cycles(model, &points.concat()));
    }
    found
}

/// The point with the least value.
fn least(points: &[Point], value: impl Fn(&Point) -> f64) -> Option<Point> {
    let valued = points.iter().map(|point| (value(point), point));
    valued.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| *point)
}

/// The points of least work where the deflection grows and where it falls, around each force.
fn cycles(model: &Composed<f64>, points: &[Point]) -> Vec<Requirement> {
    let bristles: Vec<_> =
        points.iter().filter_map(|point| Some((*point, Bristled::of(model, point)?))).collect();
    let [low, high] = bristles.iter().fold([0.0_f64; 2], |[low, high], (point, bristled)| {
        let force = bristled.strength() * point.velocity.sign();
        [low.min(force), high.max(force)]
    });
    let even = (1..EVEN_FORCES)
        .map(|k| low + (high - low) * f64::from(k) / f64::from(EVEN_FORCES))
        .chain([0.0]);
    let small = [low, high].into_iter().flat_map(|end| halvings(end).skip(3).take(SMALL_FORCES));
    even.chain(small)
        .filter_map(|force| {
            let cheapest = |rising: bool| {
                let work = bristles.iter().filter_map(|(point, bristled)| {
                    let direction = point.velocity.sign();
                    let leg = bristled.leg(force * direction, (direction > 0.0) == rising);
                    Some((leg.work()?, *point))
                });
                work.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
            };
            Some(Requirement::Cycle { force, up: cheapest(true)?, down: cheapest(false)? })
        })
        .collect()
}

/// `first`, half of it, a quarter ...
fn halvings(first: f64) -> impl Iterator<Item = f64> {
    successors(Some(first), |x| Some(0.5 * x))
}

/// All combinations of the values of the channels, with speeds over decades.
pub(super) fn points(region: &Region, channels: &[Channel]) -> Vec<Point> {
    let mut made = vec![middle_of(region)];
    for &channel in channels {
        let values = values(region, channel);
        made = made
            .iter()
            .flat_map(|point| values.iter().map(|&value| set(point, channel, value)))
            .collect();
    }
    made
}

#[allow(clippy::cast_precision_loss)]
fn values(region: &Region, channel: Channel) -> Vec<f64> {
    let side = region.channel(channel);
    if channel == Channel::Velocity {
        let forward = side.lower > 0.0;
        let (slowest, fastest) =
            if forward { (side.lower, side.upper) } else { (side.upper, side.lower) };
        let between = halvings(fastest).take(SPEEDS).filter(|v| v.abs() > slowest.abs());
        return between.chain([slowest]).collect();
    }
    if side.lower == side.upper {
        return vec![side.lower];
    }
    let (many, few) = VALUES;
    let count = if channel == Channel::Position { many } else { few };
    let step = (side.upper - side.lower) / (count - 1) as f64;
    (0..count).map(|k| (side.lower + step * k as f64).min(side.upper)).collect()
}
