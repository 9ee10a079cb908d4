//! The minimum of a function over boxes, with bounds: branch and bound.

use core::cmp::Ordering;
use std::collections::BinaryHeap;
use std::vec::Vec;

use super::enclosure::Enclosure;
use super::region::{Point, Region, at, flattened, halves, probes};
use crate::table::Channel;

/// Bounds of the minimum of a function.
pub struct Search<'a> {
    function: &'a dyn Fn(&Region) -> Option<Enclosure>,
    channels: &'a [Channel],
    leaves: BinaryHeap<Leaf>,
    /// The least value found at a point (an upper bound of the minimum), and that point.
    pub best: Option<(f64, Point)>,
    /// Number of evaluations so far.
    pub evaluations: usize,
}

/// A region and a lower bound of the function over it; the heap returns the lowest first.
struct Leaf {
    lower: f64,
    region: Region,
}

impl<'a> Search<'a> {
    /// A search over these regions; where the function is `None` it has no value in the whole
    /// region.
    pub fn over(
        regions: &[Region],
        channels: &'a [Channel],
        function: &'a dyn Fn(&Region) -> Option<Enclosure>,
    ) -> Self {
        let leaves = BinaryHeap::new();
        let mut search = Self { function, channels, leaves, best: None, evaluations: 0 };
        for region in regions {
            search.add(region);
        }
        search
    }

    /// Lower bound of the minimum; infinite if the function has no value anywhere.
    pub fn lower(&self) -> f64 {
        self.leaves.peek().map_or(f64::INFINITY, |leaf| leaf.lower)
    }

    /// Upper bound of the minimum; infinite if no value was found.
    pub fn upper(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |(value, _)| value)
    }

    /// Splits the region with the lowest bound; `false` if none can be split.
    pub fn refine(&mut self) -> bool {
        let Some(leaf) = self.leaves.pop() else { return false };
        match self.widest(&leaf.region) {
            Some(halves) => {
                halves.iter().for_each(|half| self.add(half));
                true
            }
            None => {
                self.leaves.push(leaf);
                false
            }
        }
    }

    /// The halves along the channel that matters most: the one without whose width the bound would
    /// be highest; if none matters, the one that is relatively widest.
    fn widest(&mut self, region: &Region) -> Option<[Region; 2]> {
        self.evaluations += self.channels.len();
        let cuts = self.channels.iter().filter_map(|&channel| {
            let halves = halves(region, channel)?;
            let flat = (self.function)(&flattened(region, channel));
            let bound = flat.map_or(f64::INFINITY, |value| value.lower);
            Some((bound, relative_width(region.channel(channel)), halves))
        });
        let order =
            |a: &(f64, f64, _), b: &(f64, f64, _)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
        cuts.max_by(order).map(|(_, _, halves)| halves)
    }

    /// Splits regions until `enough`, or until the budget of evaluations is spent.
    pub fn run(&mut self, budget: usize, enough: impl Fn(&Self) -> bool) {
        while self.evaluations < budget && !enough(self) {
            if !self.refine() {
                return;
            }
        }
    }

    /// The regions in which the function may be below `limit`.
    pub fn below(&self, limit: f64) -> Vec<Region> {
        self.leaves.iter().filter(|leaf| leaf.lower < limit).map(|leaf| leaf.region).collect()
    }

    fn add(&mut self, region: &Region) {
        self.evaluations += 1;
        let Some(value) = (self.function)(region) else { return };
        for point in probes(region) {
            self.evaluations += 1;
            if let Some(value) = (self.function)(&at(&point))
                && value.upper < self.upper()
            {
                self.best = Some((value.upper, point));
            }
        }
        self.leaves.push(Leaf { lower: value.lower, region: *region });
    }
}

/// Relative width: 1 where the ends differ by decades.
fn relative_width(side: Enclosure) -> f64 {
    (side.upper - side.lower) / side.upper.abs().max(side.lower.abs()).max(f64::MIN_POSITIVE)
}

impl Ord for Leaf {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower)
    }
}

impl PartialOrd for Leaf {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Leaf {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Leaf {}
