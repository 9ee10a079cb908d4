//! The order of operations and the buffers for their results.

use std::vec;
use std::vec::Vec;

use super::merge::{Job, Work, each_alone, jobs, without_zeros};
use super::operation::{Id, Operation, Relaxing, Start};
use super::two_valued::with_two_values;

/// The location of a number during a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Index of a number that is the same for all samples.
    Uniform(usize),
    /// Index of a buffer, with one number per sample of the block.
    Buffer(usize),
}

/// One or more operations with the locations of their operands and their result.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// What it computes.
    pub work: Work,
    /// Locations of its operands, in their order.
    pub from: [Place; 5],
    /// Index of the result: a buffer, or a uniform number.
    pub to: usize,
    /// Index of the value kept from block to block, for an operation with memory.
    pub memory: usize,
    /// Number of tasks, from this one on, that run as a group: derivatives of one state.
    pub group: usize,
}

/// Largest number of derivatives of a state that run as a group.
pub const MAX_GROUP: usize = 8;

/// Number of buffers that fit into a first-level cache of 32 KB.
const CACHED: usize = 16;

/// The operations that some outputs need.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// Computed once, for all samples.
    pub once: Vec<Task>,
    /// Computed for each block of samples.
    pub each: Vec<Task>,
    /// Locations of the outputs.
    pub outputs: Vec<Place>,
    /// Number of uniform numbers.
    pub uniforms: usize,
    /// Number of buffers.
    pub buffers: usize,
    /// Buffers that hold one number throughout: the index of the number, and that of the buffer.
    pub spread: Vec<(usize, usize)>,
    /// Number of values kept from block to block.
    pub memories: usize,
}

impl Schedule {
    /// The schedule of the operations that the outputs need.
    #[must_use]
    pub fn of(operations: &[Operation], outputs: &[Id]) -> Self {
        let merged = Self::from_jobs(operations, outputs, jobs);
        if merged.buffers <= CACHED {
            return merged;
        }
        // Merged loops need more buffers, and loads from the next cache cost more than they save.
        Self::from_jobs(operations, outputs, |operations, _, _| each_alone(operations))
    }

    fn from_jobs(
        operations: &[Operation],
        outputs: &[Id],
        jobs: impl Fn(&[Operation], &[Id], &[Id]) -> Vec<Option<Job>>,
    ) -> Self {
        let (operations, outputs) = with_two_values(operations, outputs);
        let (mut operations, outputs) = without_zeros(&operations, &outputs);
        let mut order = order(&operations, &outputs);
        operations.push(Operation::Constant((-1.0_f64).to_bits()));
        order.insert(0, operations.len() - 1);
        let jobs = jobs(&operations, &order, &outputs);
        let mut last_use: Vec<Option<usize>> = vec![None; operations.len()];
        for (place, &id) in order.iter().enumerate() {
            // The operands of a group stay in use until all of the group is computed.
            let group = order[place..].iter().take_while(|&&id| is_slope(operations[id]));
            let done = place + group.count().max(1) - 1;
            for &operand in jobs[id].iter().flat_map(|job| &job.operands) {
                last_use[operand] = last_use[operand].max(Some(done));
            }
        }
        let mut ended: Vec<Vec<Id>> = vec![vec![]; order.len()];
        for (id, place) in last_use.iter().enumerate().filter(|(id, _)| !outputs.contains(id)) {
            if let Some(place) = place {
                ended[*place].push(id);
            }
        }
        let mut layout = Layout::default();
        let mut schedule = Self {
            once: vec![],
            each: vec![],
            outputs: vec![],
            uniforms: 0,
            buffers: 0,
            spread: vec![],
            memories: 0,
        };
        let mut places: Vec<Option<Place>> = vec![None; operations.len()];
        for (now, &id) in order.iter().enumerate() {
            let Some(Job { work, operands }) = &jobs[id] else { continue };
            let operation = operations[id];
            let mut from: Vec<Place> = operands.iter().filter_map(|&own| places[own]).collect();
            let shared = from.iter().all(|place| matches!(place, Place::Uniform(_)));
            let place = if shared && !operation.is_by_row() {
                schedule.uniforms += 1;
                Place::Uniform(schedule.uniforms - 1)
            } else {
                if matches!(work, Work::Steps(_)) {
                    from.iter_mut().for_each(|place| schedule.spread_out(place, &mut layout));
                }
                Place::Buffer(layout.take())
            };
            places[id] = Some(place);
            let mut five = [Place::Uniform(0); 5];
            five[..from.len()].copy_from_slice(&from);
            let memory = schedule.memories;
            schedule.memories += usize::from(operation.has_memory());
            let task = |to| Task { work: *work, from: five, to, memory, group: 1 };
            match place {
                Place::Uniform(to) => schedule.once.push(task(to)),
                Place::Buffer(to) => {
                    schedule.each.push(task(to));
                    for &id in &ended[now] {
                        if let Some(Place::Buffer(free)) = places[id] {
                            layout.release(free);
                        }
                    }
                }
            }
        }
        schedule.outputs = outputs.iter().filter_map(|&output| places[output]).collect();
        schedule.buffers = layout.count;
        for first in 0..schedule.each.len() {
            schedule.each[first].group = group_size(&schedule.each[first..]);
        }
        schedule
    }

    /// Replaces a number that is the same for all samples by a buffer that holds nothing else.
    fn spread_out(&mut self, place: &mut Place, layout: &mut Layout) {
        let Place::Uniform(number) = *place else { return };
        let known = self.spread.iter().find(|&&(own, _)| own == number);
        let buffer = known.map(|&(_, buffer)| buffer).unwrap_or_else(|| layout.fresh());
        if known.is_none() {
            self.spread.push((number, buffer));
        }
        *place = Place::Buffer(buffer);
    }
}

/// The nodes that the outputs need, operands first. Derivatives of a state are deferred until one
/// of them is read, so that they form groups.
fn order(operations: &[Operation], outputs: &[Id]) -> Vec<Id> {
    let mut needed = vec![false; operations.len()];
    for &output in outputs {
        needed[output] = true;
    }
    for id in (0..operations.len()).rev() {
        if needed[id] {
            for operand in operations[id].operands() {
                needed[operand] = true;
            }
        }
    }
    let mut order = Vec::new();
    let mut waiting: Vec<Id> = Vec::new();
    for id in (0..operations.len()).filter(|&id| needed[id]) {
        if operations[id].operands().iter().any(|operand| waiting.contains(operand)) {
            order.append(&mut waiting);
        }
        if is_slope(operations[id]) { waiting.push(id) } else { order.push(id) }
    }
    order.append(&mut waiting);
    order
}

/// Whether an operation is the derivative of a state.
fn is_slope(operation: Operation) -> bool {
    matches!(operation, Operation::Relax(Relaxing { start: Start::Zero, .. }))
}

/// How many tasks from the first on are derivatives of one state and run as a group.
fn group_size(tasks: &[Task]) -> usize {
    let alike = |task: &&Task| match (tasks[0].work, task.work) {
        (Work::Single(Operation::Relax(first)), Work::Single(Operation::Relax(own))) => {
            first.start == Start::Zero && own.start == Start::Zero && first.share == own.share
        }
        _ => false,
    };
    tasks.iter().take(MAX_GROUP).take_while(alike).count().max(1)
}

/// Allocates buffers and reuses those that are free again.
#[derive(Default)]
struct Layout {
    free: Vec<usize>,
    count: usize,
}

impl Layout {
    fn take(&mut self) -> usize {
        self.free.pop().unwrap_or_else(|| self.fresh())
    }

    /// A buffer that has not been used.
    fn fresh(&mut self) -> usize {
        self.count += 1;
        self.count - 1
    }

    fn release(&mut self, buffer: usize) {
        self.free.push(buffer);
    }
}
