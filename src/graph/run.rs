//! Carries out a graph on rows.

use core::array::from_fn;
use core::mem::take;
use std::vec;
use std::vec::Vec;

use pulp::{Arch, Simd, WithSimd};

use super::block::{Rows, binary, binary_once, choose, unary, unary_once};
use super::operation::{Operation, Relaxing, Start};
use super::schedule::{Place, Schedule, Task};

/// Rows of a block: what all operations leave stays in the first cache.
pub const BLOCK: usize = 256;

/// Derivatives of a state that run together.
const MOST_TOGETHER: usize = 4;

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
            macro_rules! reader {
                ($buffers:expr) => {
                    |place| match place {
                        Place::Uniform(i) => Rows::Same(uniforms[i]),
                        Place::Column(i) => {
                            Rows::Each(&self.given.columns[i][first..first + count])
                        }
                        Place::Buffer(i) => Rows::Each(&$buffers[i][..count]),
                    }
                };
            }
            let moment = Moment { beginnings: &beginnings[..count], start: self.given.start };
            let mut tasks = &schedule.each[..];
            while let Some(task) = tasks.first() {
                let together = relaxing_alike(tasks);
                let (now, later) = tasks.split_at(together);
                tasks = later;
                let mut out = take(&mut buffers[task.to]);
                if now.len() == 1 {
                    let rows = reader!(buffers);
                    let memory = memories.get_mut(task.memory);
                    moment.carry_out(task, &mut out[..count], rows, memory);
                    buffers[task.to] = out;
                    continue;
                }
                let mut outs = [out, vec![], vec![], vec![]];
                for (out, task) in outs.iter_mut().zip(now).skip(1) {
                    *out = take(&mut buffers[task.to]);
                }
                let rows = reader!(buffers);
                match now.len() {
                    2 => moment.relax_alike::<2>(now, &mut outs, rows, &mut memories),
                    3 => moment.relax_alike::<3>(now, &mut outs, rows, &mut memories),
                    _ => moment.relax_alike::<4>(now, &mut outs, rows, &mut memories),
                }
                for (out, task) in outs.into_iter().zip(now) {
                    buffers[task.to] = out;
                }
            }
            let outputs: Vec<Rows<'_>> =
                schedule.outputs.iter().map(|&place| reader!(buffers)(place)).collect();
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
    beginnings: &'a [Beginning],
    start: f64,
}

impl Moment<'_> {
    #[inline(always)]
    fn carry_out<'b>(
        &self,
        task: &Task,
        out: &mut [f64],
        rows: impl Fn(Place) -> Rows<'b>,
        memory: Option<&mut f64>,
    ) {
        let [a, b, c, d, e] = task.from;
        match (task.operation, memory) {
            (Operation::Unary(operation, _), _) => unary(out, operation, rows(a)),
            (Operation::Binary(operation, _, _), _) => binary(out, operation, rows(a), rows(b)),
            (Operation::Choose(..), _) => choose(out, rows(a), rows(b), rows(c)),
            (Operation::Previous(_), Some(memory)) => self.previous(out, rows(a), memory),
            (Operation::Relax(Relaxing { start, .. }), Some(memory)) => {
                self.relax(out, [rows(a), rows(b), rows(c), rows(d), rows(e)], start, memory);
            }
            (Operation::Before(_, _, start), Some(memory)) => {
                self.before(out, rows(a), rows(b), start, memory);
            }
            _ => {}
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
    fn previous(&self, out: &mut [f64], x: Rows<'_>, memory: &mut f64) {
        for (i, out) in out.iter_mut().enumerate() {
            let own = x.at(i);
            *out = if self.beginnings[i] == Beginning::Continued { *memory } else { own };
            *memory = own;
        }
    }

    #[inline(always)]
    fn relax(
        &self,
        out: &mut [f64],
        [share, target, extra, shift, settled]: [Rows<'_>; 5],
        start: Start,
        memory: &mut f64,
    ) {
        let mut spread = [[0.0; BLOCK]; 4];
        let [a, b, c, d] = &mut spread;
        let (share, target) = (as_slice(share, a, out.len()), as_slice(target, b, out.len()));
        let (extra, shift) = (as_slice(extra, c, out.len()), as_slice(shift, d, out.len()));
        let mut state = *memory;
        let rows = share.iter().zip(target).zip(extra).zip(shift).zip(out).enumerate();
        for (i, ((((share, target), extra), shift), out)) in rows {
            let before = self.from(i, state, settled.at(i), start);
            state = (before + extra) + share * (target - before) + shift;
            *out = state;
        }
        *memory = state;
    }

    /// Derivatives of one state: while one waits for its sum the others go on.
    #[inline(always)]
    fn relax_alike<'b, const K: usize>(
        &self,
        tasks: &[Task],
        outs: &mut [Vec<f64>; MOST_TOGETHER],
        rows: impl Fn(Place) -> Rows<'b>,
        memories: &mut [f64],
    ) {
        let count = self.beginnings.len();
        let mut scratch = [[[0.0; BLOCK]; K]; 5];
        let [a, b, c, d, e] = &mut scratch;
        let read = |k: usize| -> [Rows<'b>; K] { from_fn(|own| rows(tasks[own].from[k])) };
        let share = slices(read(0), a, count)[0];
        let (target, extra) = (slices(read(1), b, count), slices(read(2), c, count));
        let (shift, settled) = (slices(read(3), d, count), slices(read(4), e, count));
        let mut states: [f64; K] = from_fn(|own| memories[tasks[own].memory]);
        for i in 0..count {
            for k in 0..K {
                let before = self.from(i, states[k], settled[k][i], Start::Zero);
                states[k] =
                    (before + extra[k][i]) + share[i] * (target[k][i] - before) + shift[k][i];
            }
            for k in 0..K {
                outs[k][i] = states[k];
            }
        }
        for (task, state) in tasks.iter().zip(states) {
            memories[task.memory] = state;
        }
    }

    #[inline(always)]
    fn before(
        &self,
        out: &mut [f64],
        state: Rows<'_>,
        settled: Rows<'_>,
        start: Start,
        memory: &mut f64,
    ) {
        for (i, out) in out.iter_mut().enumerate() {
            let state_before = if i == 0 { *memory } else { state.at(i - 1) };
            *out = self.from(i, state_before, settled.at(i), start);
        }
        *memory = state.at(out.len() - 1);
    }
}

/// One number a row, also of what all share.
#[inline(always)]
fn as_slice<'a>(from: Rows<'a>, scratch: &'a mut [f64; BLOCK], count: usize) -> &'a [f64] {
    match from {
        Rows::Each(rows) => rows,
        Rows::Same(x) => {
            let scratch = &mut scratch[..count];
            scratch.fill(x);
            scratch
        }
    }
}

/// The same of several.
#[inline(always)]
fn slices<'a, const K: usize>(
    from: [Rows<'a>; K],
    scratch: &'a mut [[f64; BLOCK]; K],
    count: usize,
) -> [&'a [f64]; K] {
    let mut scratch = scratch.iter_mut();
    from.map(|from| match scratch.next() {
        Some(scratch) => as_slice(from, scratch, count),
        None => &[],
    })
}
