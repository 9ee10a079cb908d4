//! Delay of a torque, within each segment.

#[cfg(feature = "identify")]
use core::ops::Range;
use std::vec::Vec;

use super::columns::{Columns, Rows};
use super::first_parameter;
use crate::catalog::EffectId;
use crate::composed::Spec;
use crate::dynamics::Memory;

/// Half of the time in which a reversal passes from one direction to the other, as a share of the
/// step between two samples.
const REVERSAL: f64 = 0.25;

/// The delay of a model. Its torque and the derivatives are evaluated twice: `f` from the channels
/// as recorded and `g` from the smoothed ones; `f + S(g) - g` is delayed.
pub struct Delay {
    seconds: f64,
    /// Whether dry friction jumps where the velocity changes its sign: without a bristle.
    jumps: bool,
    /// The place of its derivative among those that are wanted.
    pub own: Option<usize>,
}

impl Delay {
    /// Of a model that has one.
    pub fn of(spec: &Spec, values: &[f64], wanted: &[usize]) -> Option<Self> {
        let parameter = first_parameter(spec, EffectId::Delay)?;
        let own = wanted.iter().position(|&index| index == parameter);
        Some(Self { seconds: values[parameter], jumps: matches!(spec.memory(), Memory::None), own })
    }

    /// The shift of the torque from the smoothed channels, to which the load is added where it is
    /// delayed too.
    pub fn shift(&self, rows: &Rows, columns: &Columns<'_>, torque: &mut [f64]) -> Shift {
        columns.add_load(torque);
        let velocity = columns.smoothed().channels.velocity;
        Shift::of(rows, self.seconds, torque, self.jumps.then_some(velocity))
    }
}

/// Where a delayed series is read at each sample, `S(g)(t) = g(t - delay)`: by linear interpolation
/// between a sample and the next, constant beyond the ends of a segment. Between two directions dry
/// friction jumps: there the series passes from one sample to the other about the instant at which
/// the velocity, interpolated, is zero.
pub struct Shift {
    at: Vec<usize>,
    next: Vec<usize>,
    /// The share of the way from the value at the one to that at the other.
    weight: Vec<f64>,
    /// The derivative of the delayed series with respect to the delay, at each sample.
    pub by_delay: Vec<f64>,
}

impl Shift {
    fn of(rows: &Rows, delay: f64, series: &[f64], velocity: Option<&[f64]>) -> Self {
        let count = rows.count();
        let mut shift = Self {
            at: Vec::with_capacity(count),
            next: Vec::with_capacity(count),
            weight: Vec::with_capacity(count),
            by_delay: Vec::with_capacity(count),
        };
        let (steps, starts) = (rows.steps(), rows.starts());
        let ends = starts.iter().skip(1).map(|&(row, _)| row).chain([count]);
        for (&(start, _), end) in starts.iter().zip(ends) {
            let own = start..end;
            let segment = Segment {
                start,
                steps: &steps[own.clone()],
                series: &series[own.clone()],
                velocity: velocity.map(|column| &column[own]),
            };
            segment.place(delay, &mut shift);
        }
        shift
    }

    /// Adds `S(g) - g` to `out`, for a series `g` and `out` with `width` numbers per sample.
    pub fn add_each(&self, series: &[f64], width: usize, out: &mut [f64]) {
        let row = |row: usize| &series[row * width..(row + 1) * width];
        let places = self.at.iter().zip(&self.next).zip(&self.weight);
        for ((i, out), ((&at, &next), &weight)) in
            out.chunks_exact_mut(width).enumerate().zip(places)
        {
            let ends = row(at).iter().zip(row(next));
            for ((out, &x), (&here, &next)) in out.iter_mut().zip(row(i)).zip(ends) {
                *out += between(here, next, weight) - x;
            }
        }
    }

    /// The sample that the first of `rows` is read at, if each of them is read at a later one than
    /// that before, by one.
    #[cfg(feature = "identify")]
    pub fn parallel(&self, rows: &Range<usize>) -> Option<usize> {
        let first = self.at[rows.start];
        let mut expected = first..;
        let mut places = self.at[rows.clone()].iter().zip(&self.next[rows.clone()]);
        places.all(|(&at, &next)| expected.next() == Some(at) && next == at + 1).then_some(first)
    }

    /// Like [`add_each`](Self::add_each), for some samples of a column; `parallel` is that of these
    /// samples.
    #[cfg(feature = "identify")]
    #[inline(always)]
    pub fn add(
        &self,
        rows: &Range<usize>,
        parallel: Option<usize>,
        column: &[f64],
        out: &mut [f64],
    ) {
        let weight = &self.weight[rows.clone()];
        let own = out.iter_mut().zip(&column[rows.clone()]).zip(weight);
        if let Some(first) = parallel {
            let here = &column[first..][..weight.len()];
            let next = &column[first + 1..][..weight.len()];
            for (((out, x), &weight), (&here, &next)) in own.zip(here.iter().zip(next)) {
                *out += between(here, next, weight) - x;
            }
        } else {
            let places = self.at[rows.clone()].iter().zip(&self.next[rows.clone()]);
            for (((out, x), &weight), (&at, &next)) in own.zip(places) {
                *out += between(column[at], column[next], weight) - x;
            }
        }
    }
}

/// The number at this share of the way between two.
#[inline(always)]
fn between(here: f64, next: f64, weight: f64) -> f64 {
    here + weight * (next - here)
}

struct Segment<'a> {
    start: usize,
    steps: &'a [f64],
    series: &'a [f64],
    /// Of a series that jumps where it changes its sign.
    velocity: Option<&'a [f64]>,
}

impl Segment<'_> {
    fn place(&self, delay: f64, shift: &mut Shift) {
        let last = self.steps.len() - 1;
        // Times relative to samples k and i: only differences matter, so rounding does not
        // accumulate.
        let mut k = 0;
        let mut ahead = -delay;
        for i in 0..=last {
            if i > 0 {
                ahead += self.steps[i];
            }
            while k < last && ahead >= self.steps[k + 1] {
                k += 1;
                ahead -= self.steps[k];
            }
            // `ahead` is now t_i - delay - t_k.
            let inside = ahead > 0.0 && k < last;
            shift.at.push(self.start + k);
            shift.next.push(self.start + (k + 1).min(last));
            let (weight, slope) = if inside {
                let share = ahead / self.steps[k + 1];
                let passage = self.passage(k);
                (passage.done(share), self.slope(k, passage.pace(share)))
            } else if ahead == 0.0 {
                // At a sample the interpolation has a kink: the mean of both slopes.
                let before = k.wrapping_sub(1);
                let slopes = self.slope(before, self.passage(before).pace(1.0))
                    + self.slope(k, self.passage(k).pace(0.0));
                (0.0, 0.5 * slopes)
            } else {
                (0.0, 0.0)
            };
            shift.weight.push(weight);
            shift.by_delay.push(-slope);
        }
    }

    /// Slope between a sample and the next, which is `pace` times that of the straight line; 0
    /// beyond the ends.
    fn slope(&self, row: usize, pace: f64) -> f64 {
        match self.steps.get(row.wrapping_add(1)) {
            Some(&dt) if row < self.steps.len() => {
                pace * (self.series[row + 1] - self.series[row]) / dt
            }
            _ => 0.0,
        }
    }

    /// How the series passes from a sample to the next.
    fn passage(&self, row: usize) -> Passage {
        let ends = self.velocity.and_then(|v| Some((*v.get(row)?, *v.get(row.wrapping_add(1))?)));
        match ends {
            Some((here, next)) if here * next < 0.0 => {
                let zero = here.abs() / (here.abs() + next.abs());
                Passage { start: (zero - REVERSAL).max(0.0), end: (zero + REVERSAL).min(1.0) }
            }
            _ => Passage { start: 0.0, end: 1.0 },
        }
    }
}

/// The part of a step, from 0 to 1, in which a series passes from one sample to the next.
struct Passage {
    start: f64,
    end: f64,
}

impl Passage {
    /// The share of the way that is done after this share of the step.
    fn done(&self, share: f64) -> f64 {
        ((share - self.start) / (self.end - self.start)).clamp(0.0, 1.0)
    }

    /// The derivative of `done`; at a border that of the inside.
    fn pace(&self, share: f64) -> f64 {
        let inside = share >= self.start && share <= self.end;
        if inside { 1.0 / (self.end - self.start) } else { 0.0 }
    }
}
