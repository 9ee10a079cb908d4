//! The list of operations that recorded numbers write to.

use core::cell::RefCell;
use std::collections::HashMap;
use std::vec::Vec;

use super::operation::{Binary, Id, Operation, Relaxing, Start, Unary};
use super::recorded::{Format, Recorded, RecordedMask};
use crate::dynamics::{History, Kept};
use crate::scalar::{Mask, Real};

/// The operations recorded so far, without duplicates.
#[derive(Debug, Default)]
pub struct Recorder {
    nodes: RefCell<Nodes>,
}

#[derive(Debug, Default)]
struct Nodes {
    operations: Vec<Operation>,
    known: HashMap<Operation, Id>,
}

impl Recorder {
    /// The node of an operation: the existing one, or a new one.
    pub fn node(&self, operation: Operation) -> Id {
        let nodes = &mut *self.nodes.borrow_mut();
        *nodes.known.entry(operation).or_insert_with(|| {
            nodes.operations.push(operation);
            nodes.operations.len() - 1
        })
    }

    /// The node of an operation, as a number.
    pub fn number<F>(&self, operation: Operation) -> Recorded<'_, F> {
        Recorded::Node(self, self.node(operation))
    }

    /// All operations; operands come before the nodes that read them.
    #[must_use]
    pub fn operations(&self) -> Vec<Operation> {
        self.nodes.borrow().operations.clone()
    }

    /// The operation of a node.
    #[must_use]
    pub fn operation(&self, id: Id) -> Operation {
        self.nodes.borrow().operations[id]
    }

    /// The node of a number.
    pub fn id<F: Format>(&self, number: Recorded<'_, F>) -> Id {
        match number {
            Recorded::Known(x) => self.constant(x.value()),
            Recorded::Node(_, id) => id,
        }
    }

    /// The node of a constant.
    pub fn constant(&self, x: f64) -> Id {
        self.node(Operation::Constant(x.to_bits()))
    }

    /// A state that relaxes from sample to sample: its value before and after each sample.
    pub fn relax<'r>(
        &'r self,
        share: Recorded<'r>,
        target: Recorded<'r>,
        shift: Recorded<'r>,
        settled: Recorded<'r>,
        start: Start,
    ) -> [Recorded<'r>; 2] {
        let settled = self.id(settled);
        let relaxing = Relaxing {
            share: self.id(share),
            target: self.id(target),
            extra: self.constant(0.0),
            shift: self.id(shift),
            settled,
            start,
        };
        let after = self.node(Operation::Relax(relaxing));
        let before = self.number(Operation::Before(after, settled, start));
        [before, Recorded::Node(self, after)]
    }

    /// A state that starts at 0 and relaxes to 0, shifted in each step: before and after a sample.
    fn relax_to_zero<'r>(&'r self, share: Recorded<'r>, shift: Recorded<'r>) -> [Recorded<'r>; 2] {
        let zero = Recorded::zero();
        self.relax(share, zero, shift, zero, Start::Zero)
    }

    /// A unary operation.
    pub fn unary<'r, F>(&'r self, operation: Unary, x: Id) -> Recorded<'r, F> {
        self.number(Operation::Unary(operation, x))
    }

    /// A binary operation.
    pub fn binary<'r, F>(&'r self, operation: Binary, x: Id, y: Id) -> Recorded<'r, F> {
        self.number(Operation::Binary(operation, x, y))
    }
}

/// What effects remember, as nodes. A number that restarts loses all of itself, exactly.
impl<'r> History<Recorded<'r>> for &'r Recorder {
    fn relax(&mut self, _: Kept, share: Recorded<'r>, shift: Recorded<'r>) -> [Recorded<'r>; 2] {
        self.relax_to_zero(share, shift)
    }

    fn count(
        &mut self,
        _: Kept,
        restarts: RecordedMask<'r>,
        from: impl FnOnce() -> Recorded<'r>,
        by: Recorded<'r>,
    ) -> [Recorded<'r>; 2] {
        let share = Recorded::choose(restarts, Recorded::one(), Recorded::zero());
        self.relax_to_zero(share, restarts.either(from, || by))
    }

    fn hold(&mut self, kept: Kept, sets: RecordedMask<'r>, x: Recorded<'r>) -> [Recorded<'r>; 2] {
        self.count(kept, sets, || x, Recorded::zero())
    }

    fn follow(&mut self, _: Kept, x: Recorded<'r>) -> [Recorded<'r>; 2] {
        let before = match x {
            Recorded::Known(_) => x,
            Recorded::Node(_, id) => self.number(Operation::Previous(id)),
        };
        [before, x]
    }
}
