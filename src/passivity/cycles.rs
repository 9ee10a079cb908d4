//! Whether a closed cycle of a single deflection can generate energy.
//!
//! At a bristle force `f`, let `A` be the least work per deflection over all operating points at
//! which the deflection grows, and `B` over those at which it falls. A storage function exists if
//! and only if `A + B >= 0` at every force that is reached: its slope lies between `-B` and `A`.
//! Where the slope may be `f` itself, the storage function is `f^2/(2 s0)`, and one condition per
//! operating point is sufficient.

use std::vec;
use std::vec::Vec;

use super::enclosure::Enclosure;
use super::friction::Bristled;
use super::region::{Point, Region};
use super::search::Search;
use crate::composed::Composed;
use crate::scalar::Real;
use crate::table::Channel;

/// Evaluations per range of forces before it is split, and the extra ones that each half gets.
const SHARE: (usize, usize) = (600, 200);

/// The bristle forces that are reached, in backward and forward motion (T).
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// No force outside these is reached.
    pub outer: [f64; 2],
    /// Every force inside these is reached.
    pub inner: [f64; 2],
}

/// The result of the search over forces.
pub enum Outcome {
    /// No cycle generates energy.
    Passive {
        /// Least dissipation per travel, or least work per deflection up and down (T).
        margin: f64,
        /// Whether a storage function other than `f^2/(2 s0)` was needed.
        by_cycles: bool,
    },
    /// A cycle generates energy.
    Active {
        /// The bristle force of the cycle (T).
        force: f64,
        /// The deflection grows at the first and falls at the second.
        points: [Point; 2],
        /// Work per deflection, up and down (T).
        sum: f64,
    },
    /// Undecided at this force.
    Undecided {
        /// The force (T).
        force: f64,
        /// Points of least work where the deflection grows and where it falls, if there are both.
        points: Option<[Point; 2]>,
    },
}

/// A range of forces, and the regions in which a cycle may violate the condition.
struct Range {
    force: Enclosure,
    share: usize,
    up: Vec<Region>,
    down: Vec<Region>,
}

/// Examines all forces until the budget of evaluations is spent.
pub fn examine(
    model: &Composed<Enclosure>,
    regions: &[Region],
    channels: &[Channel],
    reach: Reach,
    mut budget: usize,
) -> Outcome {
    let [low, high] = reach.outer;
    let whole = Range {
        force: Enclosure::new(low, high),
        share: SHARE.0,
        up: regions.to_vec(),
        down: regions.to_vec(),
    };
    let mut open = vec![whole];
    let mut margin = f64::INFINITY;
    let mut by_cycles = false;
    while let Some(range) = open.pop() {
        let middle = 0.5 * range.force.lower + 0.5 * range.force.upper;
        if budget == 0 {
            let points = least(model, channels, &range, middle);
            return Outcome::Undecided { force: middle, points };
        }
        let stored = |region: &Region| {
            let along = range.force * region.velocity.sign();
            Bristled::of(model, region).map(|bristled| bristled.dissipated(along))
        };
        let mut dissipated = Search::over(regions, channels, &stored);
        dissipated.run(range.share, |s| s.lower() >= 0.0 || s.upper() < 0.0);
        budget = budget.saturating_sub(dissipated.evaluations);
        if dissipated.lower() >= 0.0 {
            margin = margin.min(dissipated.lower());
            continue;
        }
        let rising = |region: &Region| work(model, region, range.force, true);
        let falling = |region: &Region| work(model, region, range.force, false);
        let mut up = Search::over(&range.up, channels, &rising);
        let mut down = Search::over(&range.down, channels, &falling);
        refine(&mut up, &mut down, range.share);
        budget = budget.saturating_sub(up.evaluations + down.evaluations);
        let sum = up.lower() + down.lower();
        // The difference of two infinities: at this force the deflection never grows, or never
        // falls.
        if sum >= 0.0 || sum.is_nan() {
            margin = margin.min(sum);
            by_cycles = true;
            continue;
        }
        let inside = reach.inner[0] < middle && middle < reach.inner[1];
        if inside && let Some((points, sum)) = violating_points(model, channels, &range, middle) {
            return Outcome::Active { force: middle, points, sum };
        }
        if !(range.force.lower < middle && middle < range.force.upper) {
            let points = up.best.zip(down.best).map(|(up, down)| [up.1, down.1]);
            return Outcome::Undecided { force: middle, points };
        }
        // Keep only regions that some region of the other side can bring below zero.
        let (up, down) = (up.below(-down.lower()), down.below(-up.lower()));
        for force in
            [Enclosure::new(range.force.lower, middle), Enclosure::new(middle, range.force.upper)]
        {
            let share = range.share + SHARE.1;
            open.push(Range { force, share, up: up.clone(), down: down.clone() });
        }
    }
    Outcome::Passive { margin, by_cycles }
}

/// Refines the side with the larger uncertainty until the sum is decided or its share is spent.
fn refine<'a>(up: &mut Search<'a>, down: &mut Search<'a>, share: usize) {
    while up.evaluations + down.evaluations < share && up.lower() + down.lower() < 0.0 {
        let unknown = |search: &Search<'_>| search.upper() - search.lower();
        // The difference of two infinities: nothing is known yet.
        let upwards = unknown(up).is_nan() || unknown(up) >= unknown(down);
        let order = if upwards { [&mut *up, &mut *down] } else { [&mut *down, &mut *up] };
        let cut = order.into_iter().any(Search::refine);
        if !cut {
            return;
        }
    }
}

/// Points that violate the condition at one force.
fn violating_points(
    model: &Composed<Enclosure>,
    channels: &[Channel],
    range: &Range,
    force: f64,
) -> Option<([Point; 2], f64)> {
    let force = Enclosure::point(force);
    let rising = |region: &Region| work(model, region, force, true);
    let falling = |region: &Region| work(model, region, force, false);
    let mut up = Search::over(&range.up, channels, &rising);
    let mut down = Search::over(&range.down, channels, &falling);
    let broken = |up: &Search<'_>, down: &Search<'_>| up.upper() + down.upper() < 0.0;
    while !broken(&up, &down) && up.evaluations + down.evaluations < range.share {
        let (before_up, before_down) = (up.evaluations, down.evaluations);
        if up.lower() + down.lower() >= 0.0 {
            return None;
        }
        up.refine();
        down.refine();
        if (before_up, before_down) == (up.evaluations, down.evaluations) {
            return None;
        }
    }
    let (best_up, best_down) = (up.best?, down.best?);
    broken(&up, &down).then_some(([best_up.1, best_down.1], best_up.0 + best_down.0))
}

/// Approximate points of least work where the deflection grows and where it falls, at one force.
fn least(
    model: &Composed<Enclosure>,
    channels: &[Channel],
    range: &Range,
    force: f64,
) -> Option<[Point; 2]> {
    let force = Enclosure::point(force);
    let best = |regions: &[Region], rising: bool| {
        let work = |region: &Region| work(model, region, force, rising);
        let mut search = Search::over(regions, channels, &work);
        search.run(range.share, |s| s.upper() <= s.lower());
        search.best.map(|(_, point)| point)
    };
    Some([best(&range.up, true)?, best(&range.down, false)?])
}

/// Work per deflection where the deflection grows, or where it falls (T).
fn work(
    model: &Composed<Enclosure>,
    region: &Region,
    force: Enclosure,
    rising: bool,
) -> Option<Enclosure> {
    let direction = region.velocity.sign();
    let [grows, falls] = Bristled::of(model, region)?.work_per_deflection(force * direction);
    if (direction.lower > 0.0) == rising { grows } else { falls }
}
