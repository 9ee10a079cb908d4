//! Which operations run, in which order, and where their results stand.

use std::vec;
use std::vec::Vec;

use super::operation::{Id, Operation, Relaxing, Start};

/// Where a number stands while the graph runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The same for all rows.
    Uniform(usize),
    /// A buffer, one number a row of the block.
    Buffer(usize),
}

/// An operation with the places of what it takes and leaves.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// What is done.
    pub operation: Operation,
    /// Where its operands stand, in their order.
    pub from: [Place; 5],
    /// Where the result goes; for one that all rows share, its place among these.
    pub to: usize,
    /// Where what it remembers stands, of an operation with a memory.
    pub memory: usize,
    /// How many operations from this one on run together: derivatives of one state.
    pub together: usize,
}

/// Derivatives of a state that run together.
pub const MOST_TOGETHER: usize = 8;

/// The operations behind some outputs.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// What is done once, for all rows.
    pub once: Vec<Task>,
    /// What is done for each block of rows.
    pub each: Vec<Task>,
    /// Where the outputs stand.
    pub outputs: Vec<Place>,
    /// How many numbers all rows share.
    pub uniforms: usize,
    /// How many buffers are needed at once.
    pub buffers: usize,
    /// How many numbers are remembered from block to block.
    pub memories: usize,
}

impl Schedule {
    /// Of a graph's operations, what the outputs need.
    #[must_use]
    pub fn of(operations: &[Operation], outputs: &[Id]) -> Self {
        let order = order(operations, outputs);
        let mut last_use: Vec<Option<usize>> = vec![None; operations.len()];
        for (place, &id) in order.iter().enumerate() {
            // What runs together with this reads what it reads until all of it is done.
            let together = order[place..].iter().take_while(|&&id| is_slope(operations[id]));
            let done = place + together.count().max(1) - 1;
            for operand in operations[id].operands() {
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
            memories: 0,
        };
        let mut places: Vec<Option<Place>> = vec![None; operations.len()];
        for (now, &id) in order.iter().enumerate() {
            let operation = operations[id];
            let operands = operation.operands();
            let from: Vec<Place> = operands.iter().filter_map(|&own| places[own]).collect();
            let shared = from.iter().all(|place| matches!(place, Place::Uniform(_)));
            let by_row = matches!(operation, Operation::Column(_)) || operation.has_memory();
            let place = if shared && !by_row {
                schedule.uniforms += 1;
                Place::Uniform(schedule.uniforms - 1)
            } else {
                Place::Buffer(layout.take())
            };
            places[id] = Some(place);
            let mut five = [Place::Uniform(0); 5];
            five[..from.len()].copy_from_slice(&from);
            let memory = schedule.memories;
            schedule.memories += usize::from(operation.has_memory());
            let task = |to| Task { operation, from: five, to, memory, together: 1 };
            match place {
                Place::Uniform(to) => schedule.once.push(task(to)),
                Place::Buffer(to) => {
                    schedule.each.push(task(to));
                    for &id in &ended[now] {
                        if let Some(Place::Buffer(free)) = places[id] {
                            layout.give_back(free);
                        }
                    }
                }
            }
        }
        schedule.outputs = outputs.iter().filter_map(|&output| places[output]).collect();
        schedule.buffers = layout.count;
        for first in 0..schedule.each.len() {
            schedule.each[first].together = relaxing_alike(&schedule.each[first..]);
        }
        schedule
    }
}

/// The nodes that the outputs need, in an order in which they can be computed. Derivatives of a
/// state wait for each other as long as nothing reads them: side by side they run faster.
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

/// Buffers that are free again are used again.
#[derive(Default)]
struct Layout {
    free: Vec<usize>,
    count: usize,
}

impl Layout {
    fn take(&mut self) -> usize {
        self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        })
    }

    fn give_back(&mut self, buffer: usize) {
        self.free.push(buffer);
    }
}
