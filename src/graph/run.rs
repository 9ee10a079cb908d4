//! Carries out a graph on rows.

use core::mem::take;
use std::vec;
use std::vec::Vec;

use pulp::{Arch, Simd, WithSimd};

use super::block::{Rows, binary, binary_once, choose, unary, unary_once};
use super::operation::{Operation, Relaxing, Start};
use super::schedule::{Place, Schedule, Task};

/// Rows of a block: what all operations leave stays in the first cache.
pub const BLOCK: usize = 128;

/// What a graph is carried out on.
pub struct Given<'a> {
    /// The parameters.
    pub parameters: &'a [f64],
    /// The columns, by their numbers; one that no operation reads may be empty.
    pub columns: &'a [&'a [f64]],
    /// How many rows.
    pub rows: usize,
    /// What a state is where a segment starts.
    pub start: f64,
    /// How each row begins.
    pub beginning: &'a dyn Fn(usize) -> Beginning,
}

/// How a row begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beginning {
    /// Where the one before ends.
    Continued,
    /// A segment starts with the state that is given.
    Fresh,
    /// A segment starts settled.
    Settled,
}

/// Carries out the operations; `sink` takes the outputs of each block and its first row.
pub fn run(schedule: &Schedule, given: &Given<'_>, sink: impl FnMut(usize, &[Rows<'_>])) {
    Arch::new().dispatch(Running { schedule, given, sink });
}

struct Running<'a, F> {
    schedule: &'a Schedule,
    given: &'a Given<'a>,
    sink: F,
}

impl<F: FnMut(usize, &[Rows<'_>])> WithSimd for Running<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        simd.vectorize(
            #[inline(always)]
            || self.all(),
        );
    }
}

impl<F: FnMut(usize, &[Rows<'_>])> Running<'_, F> {
    #[inline(always)]
    fn all(mut self) {
        let schedule = self.schedule;
        let uniforms = once(schedule, self.given.parameters);
        let mut buffers: Vec<Vec<f64>> = vec![vec![0.0; BLOCK]; schedule.buffers];
        let mut memories = vec![0.0; schedule.memories];
        let mut beginnings = [Beginning::Continued; BLOCK];
        for first in (0..self.given.rows).step_by(BLOCK) {
            let count = BLOCK.min(self.given.rows - first);
            if !memories.is_empty() {
                for (i, beginning) in beginnings[..count].iter_mut().enumerate() {
                    *beginning = (self.given.beginning)(first + i);
                }
            }
            for task in &schedule.each {
                let mut out = take(&mut buffers[task.to]);
                let rows = |place| match place {
                    Place::Uniform(i) => Rows::Same(uniforms[i]),
                    Place::Column(i) => Rows::Each(&self.given.columns[i][first..first + count]),
                    Place::Buffer(i) => Rows::Each(&buffers[i][..count]),
                };
                let memory = memories.get_mut(task.memory);
                let moment =
                    Moment { beginnings: &beginnings[..count], start: self.given.start, memory };
                moment.carry_out(task, &mut out[..count], rows);
                buffers[task.to] = out;
            }
            let outputs: Vec<Rows<'_>> = schedule
                .outputs
                .iter()
                .map(|&place| match place {
                    Place::Uniform(i) => Rows::Same(uniforms[i]),
                    Place::Column(i) => Rows::Each(&self.given.columns[i][first..first + count]),
                    Place::Buffer(i) => Rows::Each(&buffers[i][..count]),
                })
                .collect();
            (self.sink)(first, &outputs);
        }
    }
}

/// What all rows share.
fn once(schedule: &Schedule, parameters: &[f64]) -> Vec<f64> {
    let mut shared = vec![0.0; schedule.uniforms];
    for task in &schedule.once {
        let at = |k: usize| match task.from[k] {
            Place::Uniform(i) => shared[i],
            Place::Column(_) | Place::Buffer(_) => f64::NAN,
        };
        shared[task.to] = match task.operation {
            Operation::Constant(bits) => f64::from_bits(bits),
            Operation::Parameter(index) => parameters[index],
            Operation::Unary(operation, _) => unary_once(operation, at(0)),
            Operation::Binary(operation, _, _) => binary_once(operation, at(0), at(1)),
            Operation::Choose(..) => {
                if at(0) == 0.0 {
                    at(2)
                } else {
                    at(1)
                }
            }
            Operation::Column(_)
            | Operation::Previous(_)
            | Operation::Relax(_)
            | Operation::Before(..) => f64::NAN,
        };
    }
    shared
}

/// What the operations with a memory need to know about a block.
struct Moment<'a> {
    beginnings: &'a [Beginning],
    start: f64,
    memory: Option<&'a mut f64>,
}

impl Moment<'_> {
    #[inline(always)]
    fn carry_out<'b>(self, task: &Task, out: &mut [f64], rows: impl Fn(Place) -> Rows<'b>) {
        let [a, b, c, d, e] = task.from;
        match task.operation {
            Operation::Unary(operation, _) => unary(out, operation, rows(a)),
            Operation::Binary(operation, _, _) => binary(out, operation, rows(a), rows(b)),
            Operation::Choose(..) => choose(out, rows(a), rows(b), rows(c)),
            Operation::Previous(_) => self.previous(out, rows(a)),
            Operation::Relax(Relaxing { start, .. }) => {
                self.relax(out, [rows(a), rows(b), rows(c), rows(d), rows(e)], start);
            }
            Operation::Before(_, _, start) => self.before(out, rows(a), rows(b), start),
            Operation::Constant(_) | Operation::Parameter(_) | Operation::Column(_) => {}
        }
    }

    /// Where the state is before a row that begins so.
    #[inline(always)]
    fn from(&self, row: usize, state: f64, settled: f64, start: Start) -> f64 {
        match self.beginnings[row] {
            Beginning::Continued => state,
            Beginning::Settled => settled,
            Beginning::Fresh if start == Start::Given => self.start,
            Beginning::Fresh => 0.0,
        }
    }

    #[inline(always)]
    fn previous(self, out: &mut [f64], x: Rows<'_>) {
        let Some(memory) = self.memory else { return };
        for (i, out) in out.iter_mut().enumerate() {
            let own = x.at(i);
            *out = if self.beginnings[i] == Beginning::Continued { *memory } else { own };
            *memory = own;
        }
    }

    #[inline(always)]
    fn relax(
        mut self,
        out: &mut [f64],
        [share, target, extra, shift, settled]: [Rows<'_>; 5],
        start: Start,
    ) {
        let Some(memory) = self.memory.take() else { return };
        let [share, target, extra, shift] =
            [share, target, extra, shift].map(|from| spread(from, out.len()));
        let mut z = *memory;
        let continued = self.beginnings.iter().all(|&own| own == Beginning::Continued);
        let rows = share.iter().zip(&target).zip(&extra).zip(&shift).zip(out).enumerate();
        for (i, ((((share, target), extra), shift), out)) in rows {
            let before = if continued { z } else { self.from(i, z, settled.at(i), start) };
            // What does not wait for the way is added meanwhile.
            z = (before + extra) + share * (target - before) + shift;
            *out = z;
        }
        *memory = z;
    }

    #[inline(always)]
    fn before(mut self, out: &mut [f64], state: Rows<'_>, settled: Rows<'_>, start: Start) {
        let Some(memory) = self.memory.take() else { return };
        for (i, out) in out.iter_mut().enumerate() {
            let state_before = if i == 0 { *memory } else { state.at(i - 1) };
            *out = self.from(i, state_before, settled.at(i), start);
        }
        *memory = state.at(out.len() - 1);
    }
}

/// One number a row, also of what all share.
#[inline(always)]
fn spread(from: Rows<'_>, count: usize) -> [f64; BLOCK] {
    let mut rows = [0.0; BLOCK];
    match from {
        Rows::Same(x) => rows[..count].fill(x),
        Rows::Each(x) => rows[..count].copy_from_slice(x),
    }
    rows
}
