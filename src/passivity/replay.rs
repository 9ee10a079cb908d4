//! Counterexamples, simulated with the exact step of the model.

use core::iter::successors;
use std::vec::Vec;

use super::region::Point;
use crate::composed::Composed;
use crate::dynamics::State;

/// An operating point held constant for some time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// The point.
    pub point: Point,
    /// Duration (s).
    pub duration: f64,
}

/// A motion in which the model generates energy and ends in the state in which it began.
#[derive(Clone, Debug, PartialEq)]
pub struct Counterexample {
    /// Deflection at the start and at the end (X); `None` for steady sliding or a model without a
    /// deflection.
    pub deflection: Option<f64>,
    /// The operating points, in their order.
    pub holds: Vec<Hold>,
    /// Work done on the model (J): negative.
    pub work: f64,
}

/// Duration of a counterexample in steady sliding (s).
const LONG: f64 = 1.0;

/// Share of the largest energy stored in the bristle that suffices as generated energy.
const SUFFICIENT_SHARE: f64 = 0.01;

/// Number of cycle sizes that are tried, each half of the one before.
const SIZES: usize = 40;

/// Largest number of halvings of the speed.
const HALVINGS: usize = 100;

/// The counterexample that generates more energy.
fn better(best: Counterexample, other: Counterexample) -> Counterexample {
    if other.work < best.work { other } else { best }
}

/// `first`, half of it, a quarter ...
fn halvings(first: f64, count: usize) -> impl Iterator<Item = f64> {
    successors(Some(first), |x| Some(0.5 * x)).take(count)
}

/// The point at its own speed, and at higher ones in powers of two up to `fastest`.
fn faster(point: &Point, fastest: f64) -> impl Iterator<Item = Point> {
    let own = *point;
    let speed = own.velocity.abs();
    halvings(fastest, HALVINGS).take_while(move |&faster| faster > speed).chain([speed]).map(
        move |speed| Point { velocity: if own.velocity > 0.0 { speed } else { -speed }, ..own },
    )
}

/// Steady sliding at a point, at the speed that generates most energy.
pub fn sliding(
    model: &Composed<f64>,
    point: &Point,
    [slowest, fastest]: [f64; 2],
) -> Counterexample {
    let limit = if point.velocity > 0.0 { fastest } else { -slowest };
    let held = |point: Point| {
        let mut state = model.settled(&point);
        let deflection =
            model.deflection(&point).filter(|_| model.has_state()).map(|_| state.bristle.z);
        let work = model.step(&mut state, &point, LONG).mean_torque * point.velocity * LONG;
        Counterexample { deflection, holds: [Hold { point, duration: LONG }].into(), work }
    };
    faster(point, limit).map(held).fold(held(*point), better)
}

/// A cycle around a bristle force `force` (T) that stays within the forces that are reached: the
/// deflection grows at `up` and falls at `down`. `None` if no such cycle generates energy.
///
/// A slower motion may generate more energy. Of all speeds of the box the fastest is chosen that
/// gives half the maximum, or enough.
pub fn cycle(
    model: &Composed<f64>,
    force: f64,
    reached: [f64; 2],
    [up, down]: [&Point; 2],
    [slowest, fastest]: [f64; 2],
) -> Option<Counterexample> {
    let limit = |point: &Point| if point.velocity > 0.0 { fastest } else { -slowest };
    let mut best = of_any_size(model, force, reached, [up, down])?;
    let strongest = reached[0].abs().max(reached[1].abs());
    let stored = 0.5 * strongest * strongest / model.deflection(up)?.stiffness;
    let enough = (0.5 * best.work).max(-SUFFICIENT_SHARE * stored);
    let half = |points: [&Point; 2]| {
        of_any_size(model, force, reached, points).filter(|cycle| cycle.work <= enough)
    };
    let mut quick = *up;
    if let Some((point, cycle)) =
        faster(up, limit(up)).find_map(|up| Some((up, half([&up, down])?)))
    {
        (quick, best) = (point, cycle);
    }
    faster(down, limit(down)).find_map(|down| half([&quick, &down])).or(Some(best))
}

fn of_any_size(
    model: &Composed<f64>,
    force: f64,
    [low, high]: [f64; 2],
    points: [&Point; 2],
) -> Option<Counterexample> {
    let stiffness = model.deflection(points[0])?.stiffness;
    let cycles = halvings(0.5 * (high - low), SIZES).filter_map(|size| {
        let ends = [(force - size).max(low), (force + size).min(high)];
        between(model, ends.map(|force| force / stiffness), points)
    });
    cycles.reduce(better)
}

fn between(
    model: &Composed<f64>,
    [low, high]: [f64; 2],
    [up, down]: [&Point; 2],
) -> Option<Counterexample> {
    let rise = duration(model, low, high, up)?;
    let fall = duration(model, high, low, down)?;
    let holds =
        [Hold { point: *up, duration: rise }, Hold { point: *down, duration: fall }].to_vec();
    let (work, end) = work(model, Some(low), &holds);
    // Energy still stored because the cycle closes only up to rounding.
    let stiffness = model.deflection(up)?.stiffness;
    let left = stiffness * low.abs().max(high.abs()) * (end - low).abs();
    (work + 2.0 * left < 0.0).then_some(Counterexample { deflection: Some(low), holds, work })
}

/// The work done on the model (J) and the final deflection, from this deflection or from steady
/// sliding.
#[must_use]
pub fn work(model: &Composed<f64>, deflection: Option<f64>, holds: &[Hold]) -> (f64, f64) {
    let mut state = match (deflection, holds.first()) {
        (Some(deflection), _) => State::with_deflection(deflection),
        (None, Some(hold)) => model.settled(&hold.point),
        (None, None) => State::default(),
    };
    let mut work = 0.0;
    for hold in holds {
        let step = model.step(&mut state, &hold.point, hold.duration);
        work += step.mean_torque * hold.point.velocity * hold.duration;
    }
    (work, state.bristle.z)
}

/// The time for the deflection to go from `from` to `to` at this point; `None` if it does not get
/// there.
fn duration(model: &Composed<f64>, from: f64, to: f64, point: &Point) -> Option<f64> {
    let passed = |dt: f64| {
        let mut state = State::with_deflection(from);
        model.step(&mut state, point, dt);
        if to > from { state.bristle.z >= to } else { state.bristle.z <= to }
    };
    if from == to {
        return None;
    }
    let mut after = (to - from).abs() / point.velocity.abs();
    while !passed(after) {
        after += after;
        if !after.is_finite() {
            return None;
        }
    }
    let mut before = 0.0;
    loop {
        let middle = 0.5 * (before + after);
        if middle <= before || middle >= after {
            return Some(after);
        }
        if passed(middle) {
            after = middle;
        } else {
            before = middle;
        }
    }
}
