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
pub const BLOCK: usize = 128;

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
            let moment = Moment { beginnings: &beginnings[..count], start: self.given.start };
            let mut tasks = &schedule.each[..];
            while let Some(task) = tasks.first() {
                let together = relaxing_alike(tasks);
                let (now, later) = tasks.split_at(together);
                tasks = later;
                let mut outs: [Vec<f64>; MOST_TOGETHER] = Default::default();
                for (out, task) in outs.iter_mut().zip(now) {
                    *out = take(&mut buffers[task.to]);
                }
                let rows = |place| match place {
                    Place::Uniform(i) => Rows::Same(uniforms[i]),
                    Place::Column(i) => Rows::Each(&self.given.columns[i][first..first + count]),
                    Place::Buffer(i) => Rows::Each(&buffers[i][..count]),
                };
                match now.len() {
                    2 => moment.relax_alike::<2>(now, &mut outs, rows, &mut memories),
                    3 => moment.relax_alike::<3>(now, &mut outs, rows, &mut memories),
                    4 => moment.relax_alike::<4>(now, &mut outs, rows, &mut memories),
                    _ => {
                        let memory = memories.get_mut(task.memory);
                        moment.carry_out(task, &mut outs[0][..count], rows, memory);
                    }
                }
                for (out, task) in outs.into_iter().zip(now) {
                    buffers[task.to] = out;
                }
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
        let [share, target, extra, shift] =
            [share, target, extra, shift].map(|from| spread(from, out.len()));
        for (i, out) in out.iter_mut().enumerate() {
            let before = self.from(i, *memory, settled.at(i), start);
            *memory = (before + extra[i]) + share[i] * (target[i] - before) + shift[i];
            *out = *memory;
        }
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
        let share = spread(rows(tasks[0].from[0]), count);
        let each = |k: usize| -> [[f64; BLOCK]; K] {
            from_fn(|own| spread(rows(tasks[own].from[k]), count))
        };
        let [target, extra, shift, settled] = [each(1), each(2), each(3), each(4)];
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
fn spread(from: Rows<'_>, count: usize) -> [f64; BLOCK] {
    let mut rows = [0.0; BLOCK];
    match from {
        Rows::Same(x) => rows[..count].fill(x),
        Rows::Each(x) => rows[..count].copy_from_slice(x),
    }
    rows
}
