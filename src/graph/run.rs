//! Carries out a graph on rows.

use core::array::from_fn;
use core::mem::take;
use core::ops::Range;
use std::vec;
use std::vec::Vec;

use pulp::{Arch, Simd, WithSimd};

use super::block::{BLOCK, Buffer, Numbers, binary, binary_once, choose, unary, unary_once};
use super::operation::{Operation, Relaxing, Start};
use super::schedule::{Place, Schedule, Task};

/// Derivatives of a state that run together.
const MOST_TOGETHER: usize = 8;

/// Where operands of states that run together are spread out if all rows share them.
type Scratch = [[Buffer; MOST_TOGETHER]; 4];

/// A number that all rows share, and that is often nothing.
const NOTHING: &Buffer = &Buffer::ZERO;

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
    /// The rows at which segments start, from the first row on, and how.
    pub starts: &'a [(usize, Beginning)],
}

/// How a segment starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beginning {
    /// With the state that is given.
    Fresh,
    /// Settled.
    Settled,
}

/// Carries out the operations; `sink` takes the outputs of each block of rows.
pub fn run(schedule: &Schedule, given: &Given<'_>, sink: impl FnMut(Range<usize>, &[Numbers<'_>])) {
    Arch::new().dispatch(Running { schedule, given, sink });
}

struct Running<'a, F> {
    schedule: &'a Schedule,
    given: &'a Given<'a>,
    sink: F,
}

impl<F: FnMut(Range<usize>, &[Numbers<'_>])> WithSimd for Running<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        simd.vectorize(
            #[inline(always)]
            || self.all(),
        );
    }
}

impl<F: FnMut(Range<usize>, &[Numbers<'_>])> Running<'_, F> {
    #[inline(always)]
    fn all(mut self) {
        let schedule = self.schedule;
        let uniforms = once(schedule, self.given.parameters);
        let mut buffers: Vec<Vec<Buffer>> = vec![vec![Buffer::ZERO]; schedule.buffers];
        let mut memories = vec![0.0; schedule.memories];
        let mut starts = self.given.starts;
        let mut scratch: Scratch = [[Buffer::ZERO; MOST_TOGETHER]; 4];
        for first in (0..self.given.rows).step_by(BLOCK) {
            let count = BLOCK.min(self.given.rows - first);
            let (own, later) = starts.split_at(starts.partition_point(|s| s.0 < first + count));
            starts = later;
            macro_rules! reader {
                ($buffers:expr) => {
                    |place| match place {
                        Place::Uniform(i) => Numbers::Same(uniforms[i]),
                        Place::Column(i) => {
                            Numbers::Each(&self.given.columns[i][first..first + count])
                        }
                        Place::Buffer(i) => Numbers::Each(&$buffers[i][0].0[..count]),
                    }
                };
            }
            let moment = Moment { first, count, starts: own, given: self.given.start };
            let mut tasks = &schedule.each[..];
            while let Some(task) = tasks.first() {
                let together = relaxing_alike(tasks);
                let (now, later) = tasks.split_at(together);
                tasks = later;
                let mut out = take(&mut buffers[task.to]);
                if now.len() == 1 {
                    let rows = reader!(buffers);
                    let memory = memories.get_mut(task.memory);
                    moment.carry_out(task, &mut out[0].0[..count], rows, memory, &mut scratch);
                    buffers[task.to] = out;
                    continue;
                }
                let mut outs = from_fn(|_| vec![]);
                outs[0] = out;
                for (out, task) in outs.iter_mut().zip(now).skip(1) {
                    *out = take(&mut buffers[task.to]);
                }
                let rows = reader!(buffers);
                match now.len() {
                    2 => moment.relax_alike::<2>(now, &mut outs, rows, &mut memories, &mut scratch),
                    3 => moment.relax_alike::<3>(now, &mut outs, rows, &mut memories, &mut scratch),
                    4 => moment.relax_alike::<4>(now, &mut outs, rows, &mut memories, &mut scratch),
                    5 => moment.relax_alike::<5>(now, &mut outs, rows, &mut memories, &mut scratch),
                    6 => moment.relax_alike::<6>(now, &mut outs, rows, &mut memories, &mut scratch),
                    7 => moment.relax_alike::<7>(now, &mut outs, rows, &mut memories, &mut scratch),
                    _ => moment.relax_alike::<8>(now, &mut outs, rows, &mut memories, &mut scratch),
                }
                for (out, task) in outs.into_iter().zip(now) {
                    buffers[task.to] = out;
                }
            }
            let outputs: Vec<Numbers<'_>> =
                schedule.outputs.iter().map(|&place| reader!(buffers)(place)).collect();
            (self.sink)(first..first + count, &outputs);
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

/// How many tasks from the first on are derivatives of one state, as far as they run together.
fn relaxing_alike(tasks: &[Task]) -> usize {
    let alike = |task: &&Task| match (tasks[0].operation, task.operation) {
        (Operation::Relax(first), Operation::Relax(own)) => {
            first.start == Start::Zero && own.start == Start::Zero && first.share == own.share
        }
        _ => false,
    };
    tasks.iter().take(MOST_TOGETHER).take_while(alike).count().max(1)
}

/// What the operations with a memory need to know about a block.
struct Moment<'a> {
    first: usize,
    count: usize,
    /// The starts of segments in this block.
    starts: &'a [(usize, Beginning)],
    /// What a state is where a segment starts.
    given: f64,
}

impl Moment<'_> {
    #[inline(always)]
    fn carry_out<'b>(
        &self,
        task: &Task,
        out: &mut [f64],
        rows: impl Fn(Place) -> Numbers<'b>,
        memory: Option<&mut f64>,
        scratch: &mut Scratch,
    ) {
        let [a, b, c, d, e] = task.from;
        match (task.operation, memory) {
            (Operation::Unary(operation, _), _) => unary(out, operation, rows(a)),
            (Operation::Binary(operation, _, _), _) => binary(out, operation, rows(a), rows(b)),
            (Operation::Choose(..), _) => choose(out, rows(a), rows(b), rows(c)),
            (Operation::Previous(_), Some(memory)) => self.previous(out, rows(a), memory),
            (Operation::Relax(Relaxing { start, .. }), Some(memory)) => {
                let mut states = [*memory];
                let given = [[rows(a)], [rows(b)], [rows(c)], [rows(d)], [rows(e)]];
                self.relax(&mut [out], given, start, &mut states, scratch);
                [*memory] = states;
            }
            (Operation::Before(_, _, start), Some(memory)) => {
                self.before(out, rows(a), rows(b), start, memory);
            }
            _ => {}
        }
    }

    /// The rows of the block in stretches without a start, and how their first one starts.
    #[inline(always)]
    fn stretches(&self) -> impl Iterator<Item = (Option<Beginning>, Range<usize>)> {
        let starts =
            self.starts.iter().map(|&(row, beginning)| (Some(beginning), row - self.first));
        let continued = match self.starts.first() {
            Some(&(row, _)) if row == self.first => None,
            _ => Some((None, 0)),
        };
        let ends = self.starts.iter().map(|&(row, _)| row - self.first).filter(|&row| row > 0);
        let starts = continued.into_iter().chain(starts);
        starts.zip(ends.chain([self.count])).map(|((how, from), to)| (how, from..to))
    }

    /// Where the state is before a row at which a stretch begins so.
    #[inline(always)]
    fn before_start(
        &self,
        how: Option<Beginning>,
        state: f64,
        settled: impl Fn() -> f64,
        start: Start,
    ) -> f64 {
        match how {
            None => state,
            Some(Beginning::Settled) => settled(),
            Some(Beginning::Fresh) if start == Start::Given => self.given,
            Some(Beginning::Fresh) => 0.0,
        }
    }

    #[inline(always)]
    fn previous(&self, out: &mut [f64], x: Numbers<'_>, memory: &mut f64) {
        for (how, rows) in self.stretches() {
            let first = rows.start;
            out[first] = if how.is_none() { *memory } else { x.at(first) };
            for row in rows.skip(1) {
                out[row] = x.at(row - 1);
            }
        }
        *memory = x.at(self.count - 1);
    }

    /// One state, or derivatives of one: while one waits for its sum the others go on.
    #[inline(always)]
    fn relax<const K: usize>(
        &self,
        outs: &mut [&mut [f64]; K],
        [share, target, extra, shift, settled]: [[Numbers<'_>; K]; 5],
        start: Start,
        states: &mut [f64; K],
        scratch: &mut Scratch,
    ) {
        let nothing =
            |rows: &[Numbers<'_>; K]| rows.iter().all(|rows| matches!(rows, Numbers::Same(0.0)));
        let (no_target, no_extra) = (nothing(&target), nothing(&extra));
        let no_shift = nothing(&shift);
        let [a, b, c, d] = scratch;
        let share = as_slice(share[0], &mut a[0], self.count);
        let target = slices(target, b, self.count);
        let (extra, shift) = (slices(extra, c, self.count), slices(shift, d, self.count));
        for (how, rows) in self.stretches() {
            let first = rows.start;
            for (state, settled) in states.iter_mut().zip(settled) {
                *state = self.before_start(how, *state, || settled.at(first), start);
            }
            // Cut to one length, so that no index needs to be checked within the loops.
            let length = rows.len();
            let share = &share[rows.clone()][..length];
            let [target, extra, shift] =
                [target, extra, shift].map(|all| all.map(|all| &all[rows.clone()][..length]));
            let outs = outs.each_mut().map(|out| &mut out[rows.clone()][..length]);
            // By value: in registers.
            let mut at = *states;
            macro_rules! step {
                ($row:ident, $k:ident => $state:expr) => {
                    for $row in 0..length {
                        for $k in 0..K {
                            at[$k] = $state;
                            outs[$k][$row] = at[$k];
                        }
                    }
                };
            }
            match (no_target, no_extra, no_shift) {
                // Sum and product do not wait for each other.
                (true, _, true) => {
                    step!(i, k => (at[k] + extra[k][i]) - share[i] * at[k]);
                }
                (_, true, true) => {
                    step!(i, k => at[k] + share[i] * (target[k][i] - at[k]));
                }
                _ => step!(i, k => {
                    (at[k] + extra[k][i]) + share[i] * (target[k][i] - at[k]) + shift[k][i]
                }),
            }
            *states = at;
        }
    }

    /// Derivatives of one state, together.
    #[inline(always)]
    fn relax_alike<'b, const K: usize>(
        &self,
        tasks: &[Task],
        outs: &mut [Vec<Buffer>; MOST_TOGETHER],
        rows: impl Fn(Place) -> Numbers<'b>,
        memories: &mut [f64],
        scratch: &mut Scratch,
    ) {
        let given = from_fn(|part| from_fn(|own| rows(tasks[own].from[part])));
        let mut states: [f64; K] = from_fn(|own| memories[tasks[own].memory]);
        let mut outs = outs.iter_mut();
        let mut outs: [&mut [f64]; K] = from_fn(|_| match outs.next() {
            Some(out) => &mut out[0].0[..self.count],
            None => &mut [],
        });
        self.relax(&mut outs, given, Start::Zero, &mut states, scratch);
        for (task, state) in tasks.iter().zip(states) {
            memories[task.memory] = state;
        }
    }

    #[inline(always)]
    fn before(
        &self,
        out: &mut [f64],
        state: Numbers<'_>,
        settled: Numbers<'_>,
        start: Start,
        memory: &mut f64,
    ) {
        for (how, rows) in self.stretches() {
            let first = rows.start;
            out[first] = self.before_start(how, *memory, || settled.at(first), start);
            for row in rows.skip(1) {
                out[row] = state.at(row - 1);
            }
        }
        *memory = state.at(self.count - 1);
    }
}

/// One number a row, also of what all share.
#[inline(always)]
fn as_slice<'a>(from: Numbers<'a>, scratch: &'a mut Buffer, count: usize) -> &'a [f64] {
    match from {
        Numbers::Each(rows) => rows,
        Numbers::Same(0.0) => &NOTHING.0[..count],
        Numbers::Same(x) => {
            let scratch = &mut scratch.0[..count];
            scratch.fill(x);
            scratch
        }
    }
}

/// The same of several.
#[inline(always)]
fn slices<'a, const K: usize>(
    from: [Numbers<'a>; K],
    scratch: &'a mut [Buffer],
    count: usize,
) -> [&'a [f64]; K] {
    let mut scratch = scratch.iter_mut();
    from.map(|from| match scratch.next() {
        Some(scratch) => as_slice(from, scratch, count),
        None => &[],
    })
}
