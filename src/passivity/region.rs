//! Boxes of operating points, split so that laws do not branch inside them.

use std::vec;
use std::vec::Vec;

use super::enclosure::Enclosure;
use crate::sample::Sample;
use crate::table::Channel;

/// Smaller values count as zero: far below any motion, far above the range where products
/// underflow.
pub const SMALLEST: f64 = 1e-30;

/// A box of operating points; a channel that is not read is zero.
pub type Region = Sample<Enclosure>;

/// One operating point.
pub type Point = Sample<f64>;

/// The range of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// The channel.
    pub channel: Channel,
    /// Lower bound.
    pub lower: f64,
    /// Upper bound.
    pub upper: f64,
}

/// The product of the sides, split at zero in every channel, without rest.
///
/// Laws branch on the signs of channels: in each piece every channel has one sign.
#[must_use]
pub fn pieces(sides: &[Side]) -> Vec<Region> {
    let mut made = vec![Sample::at(Enclosure::point(0.0))];
    for side in sides {
        let parts = parts(side);
        made = made
            .iter()
            .flat_map(|region| parts.iter().map(|&part| set(region, side.channel, part)))
            .collect();
    }
    made
}

fn parts(side: &Side) -> Vec<Enclosure> {
    let mut parts = Vec::new();
    if side.lower <= -SMALLEST {
        parts.push(Enclosure::new(side.lower, side.upper.min(-SMALLEST)));
    }
    if side.upper >= SMALLEST {
        parts.push(Enclosure::new(side.lower.max(SMALLEST), side.upper));
    }
    // At rest nothing is dissipated or generated.
    if side.channel != Channel::Velocity && side.lower < SMALLEST && side.upper > -SMALLEST {
        parts.push(Enclosure::point(0.0));
    }
    parts
}

/// The sample with another value of one channel.
pub fn set<P: Copy>(sample: &Sample<P>, channel: Channel, value: P) -> Sample<P> {
    let mut changed = *sample;
    let own = match channel {
        Channel::Velocity => &mut changed.velocity,
        Channel::Position => &mut changed.position,
        Channel::Acceleration => &mut changed.acceleration,
        Channel::Temperature => &mut changed.temperature,
        Channel::TemperatureRate => &mut changed.temperature_rate,
        Channel::LoadTorque => &mut changed.load_torque,
        Channel::LoadTorqueCurvature => &mut changed.load_torque_curvature,
        Channel::MotorTorque => &mut changed.motor_torque,
        Channel::ExternalTorque => &mut changed.external_torque,
        Channel::Time => &mut changed.time,
    };
    *own = value;
    changed
}

/// Applies `change` to every channel.
fn map<P: Copy, Q>(sample: &Sample<P>, change: impl Fn(P) -> Q) -> Sample<Q> {
    Sample {
        velocity: change(sample.velocity),
        position: change(sample.position),
        acceleration: change(sample.acceleration),
        temperature: change(sample.temperature),
        temperature_rate: change(sample.temperature_rate),
        load_torque: change(sample.load_torque),
        load_torque_curvature: change(sample.load_torque_curvature),
        motor_torque: change(sample.motor_torque),
        external_torque: change(sample.external_torque),
        time: change(sample.time),
    }
}

/// The point as a region, to bound the rounding errors of what is computed there.
#[must_use]
pub fn at(point: &Point) -> Region {
    map(point, Enclosure::point)
}

/// The midpoint of a region.
#[must_use]
pub fn middle_of(region: &Region) -> Point {
    map(region, middle)
}

/// Trial points of a region: its midpoint and two opposite corners.
#[must_use]
pub fn probes(region: &Region) -> [Point; 3] {
    [middle_of(region), map(region, |x| x.lower), map(region, |x| x.upper)]
}

/// Both halves of a region along a channel; `None` where no number lies between its ends.
#[must_use]
pub fn halves(region: &Region, channel: Channel) -> Option<[Region; 2]> {
    let whole = region.channel(channel);
    let cut = middle(whole);
    (whole.lower < cut && cut < whole.upper).then(|| {
        let lower = Enclosure::new(whole.lower, cut);
        let upper = Enclosure::new(cut, whole.upper);
        [set(region, channel, lower), set(region, channel, upper)]
    })
}

/// The parts of the regions above this speed, in both directions.
#[must_use]
pub fn faster_than(regions: &[Region], speed: f64) -> Vec<Region> {
    let fast = |region: &Region| {
        let v = region.velocity;
        let side = if v.lower > 0.0 {
            Enclosure { lower: v.lower.max(speed), upper: v.upper }
        } else {
            Enclosure { lower: v.lower, upper: v.upper.min(-speed) }
        };
        (side.lower <= side.upper).then(|| set(region, Channel::Velocity, side))
    };
    regions.iter().filter_map(fast).collect()
}

/// The region reduced to the midpoint in one channel.
#[must_use]
pub fn flattened(region: &Region, channel: Channel) -> Region {
    set(region, channel, Enclosure::point(middle(region.channel(channel))))
}

/// The midpoint: geometric where the ends differ by decades.
fn middle(x: Enclosure) -> f64 {
    let (near, far) = (x.lower.abs().min(x.upper.abs()), x.lower.abs().max(x.upper.abs()));
    let one_sign = x.lower > 0.0 || x.upper < 0.0;
    if one_sign && near > 0.0 && far > 4.0 * near {
        let size = crate::math::f64::sqrt(near) * crate::math::f64::sqrt(far);
        return if x.lower > 0.0 { size } else { -size };
    }
    0.5 * x.lower + 0.5 * x.upper
}
