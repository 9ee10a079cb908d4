//! The least value of a function over boxes, between bounds: branch and bound.

use core::cmp::Ordering;
use std::collections::BinaryHeap;
use std::vec::Vec;

use super::enclosure::Enclosure;
use super::region::{Point, Region, at, halves, probes};
use crate::table::Channel;

/// What is known of the least value of a function.
pub struct Search<'a> {
    function: &'a dyn Fn(&Region) -> Option<Enclosure>,
    channels: &'a [Channel],
    leaves: BinaryHeap<Leaf>,
    /// The least value that a point has (its upper bound), and that point.
    pub best: Option<(f64, Point)>,
    /// Evaluations so far.
    pub evaluations: usize,
}

/// A region and a lower bound of the function over it; the lowest comes first.
struct Leaf {
    lower: f64,
    region: Region,
}

impl<'a> Search<'a> {
    /// Over these regions; where the function is `None` it has no value in the whole region.
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

    /// No value is less; infinite where there is no value at all.
    pub fn lower(&self) -> f64 {
        self.leaves.peek().map_or(f64::INFINITY, |leaf| leaf.lower)
    }

    /// Some point has a value that is not more; infinite where none has been found.
    pub fn upper(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |(value, _)| value)
    }

    /// Cuts the region with the lowest bound; `false` if nothing is left to cut.
    pub fn refine(&mut self) -> bool {
        let Some(leaf) = self.leaves.pop() else { return false };
        let cuts: Vec<_> = self
            .channels
            .iter()
            .filter_map(|&channel| halves(&leaf.region, channel))
            .map(|halves| (self.lowest(&halves), halves))
            .collect();
        // Of all cuts the one after which the bound is best; of equal ones the widest first.
        let best = cuts.into_iter().reduce(|best, cut| {
            let better = match cut.0.total_cmp(&best.0) {
                Ordering::Equal => self.breadth(&cut.1) > self.breadth(&best.1),
                order => order == Ordering::Greater,
            };
            if better { cut } else { best }
        });
        match best {
            Some((_, halves)) => {
                halves.iter().for_each(|half| self.add(half));
                true
            }
            None => {
                self.leaves.push(leaf);
                false
            }
        }
    }

    /// Cuts until `enough`, or until the evaluations are used up.
    pub fn run(&mut self, budget: usize, enough: impl Fn(&Self) -> bool) {
        while self.evaluations < budget && !enough(self) {
            if !self.refine() {
                return;
            }
        }
    }

    /// The regions in which the function may be less than `limit`.
    pub fn below(&self, limit: f64) -> Vec<Region> {
        self.leaves.iter().filter(|leaf| leaf.lower < limit).map(|leaf| leaf.region).collect()
    }

    fn lowest(&mut self, halves: &[Region; 2]) -> f64 {
        self.evaluations += 2;
        let bound = |half| (self.function)(half).map_or(f64::INFINITY, |value| value.lower);
        halves.iter().map(bound).fold(f64::INFINITY, f64::min)
    }

    /// How much of the sign-definite ranges the halves still span, as a sum of relative widths.
    fn breadth(&self, halves: &[Region; 2]) -> f64 {
        let [low, high] = halves;
        let sides = self.channels.iter().map(|&channel| {
            let (a, b) = (super::region::get(low, channel), super::region::get(high, channel));
            (b.upper - a.lower) / (b.upper.abs() + a.lower.abs() + f64::MIN_POSITIVE)
                * f64::from(u8::from(a != b))
        });
        sides.sum()
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
