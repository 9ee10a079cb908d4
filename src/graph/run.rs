//! Executes a schedule on the samples of a recording, block by block.

use core::array::from_fn;
use core::mem::swap;
use core::ops::Range;
use std::vec;
use std::vec::Vec;

use pulp::{Arch, Simd, WithSimd};

use super::block::{
    BLOCK, Buffer, Halves, Operand, binary, binary_once, choose, unary, unary_once,
};
use super::merge::Work;
use super::merged;
use super::numbers::Numbers;
use super::operation::{Operation, Relaxing, Start};
use super::schedule::{MAX_GROUP, Place, Schedule, Task};

/// Memory of operations that need some.
struct Scratch {
    /// For functions in two loops.
    halves: Halves,
    /// For operands of grouped states that are one number for all samples; empty without states.
    groups: Vec<[Buffer; MAX_GROUP]>,
}

impl Scratch {
    fn of(schedule: &Schedule) -> Self {
        let groups = if schedule.memories > 0 { 4 } else { 0 };
        Self { halves: [Buffer::ZERO; 2], groups: vec![[Buffer::ZERO; MAX_GROUP]; groups] }
    }
}

/// Operand that is 0 for all samples, the most frequent case.
const ZEROS: &Buffer = &Buffer::ZERO;

/// Inputs of a run.
pub struct Inputs<'a> {
    /// The parameters.
    pub parameters: &'a [f64],
    /// Columns by number; one that no operation reads may be empty.
    pub columns: &'a [&'a [f64]],
    /// Number of samples.
    pub rows: usize,
    /// The state at the start of segments that do not begin settled.
    pub start: f64,
    /// The first sample of each segment, in increasing order and starting at 0, and how it begins.
    pub starts: &'a [(usize, Beginning)],
}

/// How a segment begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beginning {
    /// From the given state.
    Fresh,
    /// From the settled state.
    Settled,
}

/// Runs the schedule; `sink` receives the outputs of each block of samples.
pub fn run(
    schedule: &Schedule,
    inputs: &Inputs<'_>,
    sink: impl FnMut(Range<usize>, &[Numbers<'_>]),
) {
    Arch::new().dispatch(Runner { schedule, inputs, sink });
}

struct Runner<'a, F> {
    schedule: &'a Schedule,
    inputs: &'a Inputs<'a>,
    sink: F,
}

impl<F: FnMut(Range<usize>, &[Numbers<'_>])> WithSimd for Runner<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        simd.vectorize(
            #[inline(always)]
            || self.all(),
        );
    }
}

impl<F: FnMut(Range<usize>, &[Numbers<'_>])> Runner<'_, F> {
    #[inline(always)]
    fn all(mut self) {
        let schedule = self.schedule;
        let uniforms = once(schedule, self.inputs.parameters);
        let mut room = vec![Buffer::ZERO; schedule.buffers + MAX_GROUP];
        let mut buffers: Vec<&mut Buffer> = room.iter_mut().collect();
        // An operation writes into a spare buffer, which is then swapped with the destination.
        let mut spare = buffers.split_off(schedule.buffers);
        let mut memories = vec![0.0; schedule.memories];
        let mut starts = self.inputs.starts;
        for &(number, buffer) in &schedule.spread {
            buffers[buffer].0.fill(uniforms[number]);
        }
        let mut scratch = Scratch::of(schedule);
        for first in (0..self.inputs.rows).step_by(BLOCK) {
            let count = BLOCK.min(self.inputs.rows - first);
            let (own, later) = starts.split_at(starts.partition_point(|s| s.0 < first + count));
            starts = later;
            let block = Block { inputs: self.inputs, first, count, starts: own };
            let mut tasks = &schedule.each[..];
            while let Some(task) = tasks.first() {
                let (now, later) = tasks.split_at(task.group);
                tasks = later;
                let operand = |place| match place {
                    Place::Uniform(i) => Operand::Same(uniforms[i]),
                    Place::Buffer(i) => Operand::Each(&buffers[i].0),
                };
                macro_rules! run_group {
                    ($count:expr) => {
                        block.relax_group::<{ $count }>(
                            now,
                            &mut spare,
                            operand,
                            &mut memories,
                            &mut scratch,
                        )
                    };
                }
                match now.len() {
                    1 => {
                        let memory = memories.get_mut(task.memory);
                        let out = &mut spare[0].0;
                        block.execute(task, out, operand, memory, &mut scratch);
                    }
                    2 => run_group!(2),
                    3 => run_group!(3),
                    4 => run_group!(4),
                    5 => run_group!(5),
                    6 => run_group!(6),
                    7 => run_group!(7),
                    _ => run_group!(MAX_GROUP),
                }
                for (spare, task) in spare.iter_mut().zip(now) {
                    swap(spare, &mut buffers[task.to]);
                }
            }
            let numbers = |&place: &Place| match place {
                Place::Uniform(i) => Numbers::Same(uniforms[i]),
                Place::Buffer(i) => Numbers::Each(&buffers[i].0[..count]),
            };
            let outputs: Vec<Numbers<'_>> = schedule.outputs.iter().map(numbers).collect();
            (self.sink)(first..first + count, &outputs);
        }
    }
}

/// The values that are the same for all samples.
fn once(schedule: &Schedule, parameters: &[f64]) -> Vec<f64> {
    let mut shared = vec![0.0; schedule.uniforms];
    for task in &schedule.once {
        let at = |k: usize| match task.from[k] {
            Place::Uniform(i) => shared[i],
            Place::Buffer(_) => f64::NAN,
        };
        let Work::Single(operation) = task.work else { continue };
        shared[task.to] = match operation {
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

/// The block that is being computed.
struct Block<'a> {
    inputs: &'a Inputs<'a>,
    /// Index of its first sample.
    first: usize,
    /// Number of its samples; results beyond them are not read.
    count: usize,
    /// The segments that start in this block.
    starts: &'a [(usize, Beginning)],
}

impl Block<'_> {
    #[inline(always)]
    fn execute<'b>(
        &self,
        task: &Task,
        out: &mut [f64; BLOCK],
        rows: impl Fn(Place) -> Operand<'b>,
        memory: Option<&mut f64>,
        scratch: &mut Scratch,
    ) {
        let [a, b, c, d, e] = task.from;
        let operation = match task.work {
            Work::Single(operation) => operation,
            work => {
                return merged::run(out, work, [a, b, c, d].map(rows), &mut scratch.halves);
            }
        };
        match (operation, memory) {
            (Operation::Unary(operation, _), _) => {
                unary(out, operation, rows(a), &mut scratch.halves)
            }
            (Operation::Binary(operation, _, _), _) => {
                binary(out, operation, rows(a), rows(b), &mut scratch.halves);
            }
            (Operation::Column(column), _) => self.column(out, column),
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

    /// A column. Beyond the last sample its value is repeated: usual magnitudes, no slow special
    /// cases.
    #[inline(always)]
    fn column(&self, out: &mut [f64; BLOCK], column: usize) {
        let rows = &self.inputs.columns[column][self.first..][..self.count];
        let (own, rest) = out.split_at_mut(self.count);
        own.copy_from_slice(rows);
        rest.fill(rows[self.count - 1]);
    }

    /// Ranges of the block that contain no segment start, and how each begins; `None` continues.
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

    /// The state before the first sample of a range that begins in this way.
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
            Some(Beginning::Fresh) if start == Start::Given => self.inputs.start,
            Some(Beginning::Fresh) => 0.0,
        }
    }

    #[inline(always)]
    fn previous(&self, out: &mut [f64; BLOCK], x: Operand<'_>, memory: &mut f64) {
        for (how, rows) in self.stretches() {
            let first = rows.start;
            out[first] = if how.is_none() { *memory } else { x.at(first) };
            for row in rows.skip(1) {
                out[row] = x.at(row - 1);
            }
        }
        *memory = x.at(self.count - 1);
    }

    /// Steps one state, or a group of derivatives of one state, whose chains of dependent sums
    /// overlap.
    #[inline(always)]
    fn relax<const K: usize>(
        &self,
        outs: &mut [&mut [f64; BLOCK]; K],
        [share, target, extra, shift, settled]: [[Operand<'_>; K]; 5],
        start: Start,
        states: &mut [f64; K],
        scratch: &mut Scratch,
    ) {
        let nothing =
            |rows: &[Operand<'_>; K]| rows.iter().all(|rows| matches!(rows, Operand::Same(0.0)));
        let (no_target, no_extra) = (nothing(&target), nothing(&extra));
        let no_shift = nothing(&shift);
        let [a, b, c, d] = &mut scratch.groups[..] else { return };
        let share = each(share[0], &mut a[0]);
        let target = each_of(target, b);
        let (extra, shift) = (each_of(extra, c), each_of(shift, d));
        for (how, rows) in self.stretches() {
            let first = rows.start;
            for (state, settled) in states.iter_mut().zip(settled) {
                *state = self.before_start(how, *state, || settled.at(first), start);
            }
            // Slices of one length remove the bounds checks from the loops.
            let length = rows.len();
            let share = &share[rows.clone()][..length];
            let [target, extra, shift] =
                [target, extra, shift].map(|all| all.map(|all| &all[rows.clone()][..length]));
            let outs = outs.each_mut().map(|out| &mut out[rows.clone()][..length]);
            // A local copy, which stays in registers.
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
                // Sum and product are independent and overlap.
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

    /// Steps a group of derivatives of one state.
    #[inline(always)]
    fn relax_group<'b, const K: usize>(
        &self,
        tasks: &[Task],
        spare: &mut [&mut Buffer],
        rows: impl Fn(Place) -> Operand<'b>,
        memories: &mut [f64],
        scratch: &mut Scratch,
    ) {
        let given = from_fn(|part| from_fn(|own| rows(tasks[own].from[part])));
        let mut states: [f64; K] = from_fn(|own| memories[tasks[own].memory]);
        let Some((outs, _)) = spare.split_first_chunk_mut::<K>() else { return };
        let mut outs = outs.each_mut().map(|out| &mut out.0);
        self.relax(&mut outs, given, Start::Zero, &mut states, scratch);
        for (task, state) in tasks.iter().zip(states) {
            memories[task.memory] = state;
        }
    }

    #[inline(always)]
    fn before(
        &self,
        out: &mut [f64; BLOCK],
        state: Operand<'_>,
        settled: Operand<'_>,
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

/// An operand as one number per sample.
#[inline(always)]
fn each<'a>(from: Operand<'a>, scratch: &'a mut Buffer) -> &'a [f64; BLOCK] {
    match from {
        Operand::Each(rows) => rows,
        Operand::Same(0.0) => &ZEROS.0,
        Operand::Same(x) => {
            scratch.0.fill(x);
            &scratch.0
        }
    }
}

/// Several operands as one number per sample each.
#[inline(always)]
fn each_of<'a, const K: usize>(
    from: [Operand<'a>; K],
    scratch: &'a mut [Buffer; MAX_GROUP],
) -> [&'a [f64; BLOCK]; K] {
    let mut scratch = scratch.iter_mut();
    from.map(|from| scratch.next().map_or(&ZEROS.0, |scratch| each(from, scratch)))
}
