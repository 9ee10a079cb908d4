//! Numbers of which a recording has two, one on either side of a mask, such as a factor of each
//! direction.
//!
//! A function of them has two values as well: it is computed once for each, instead of for every
//! sample.

use std::vec::Vec;

use super::operation::{Binary, Id, Operation, Unary};

/// A mask, and the numbers where it is true and where it is false, which are the same for all
/// samples.
#[derive(Clone, Copy)]
struct Pair {
    mask: Id,
    yes: Id,
    no: Id,
}

/// Operations and outputs in which a function of numbers with two values is a choice between two
/// results.
pub fn with_two_values(operations: &[Operation], outputs: &[Id]) -> (Vec<Operation>, Vec<Id>) {
    let mut lifting = Lifting::default();
    let mut instead: Vec<Id> = Vec::with_capacity(operations.len());
    for operation in operations {
        let moved = operation.moved(|own| instead[own], |column| column);
        instead.push(lifting.enter(moved));
    }
    let outputs = outputs.iter().map(|&own| instead[own]).collect();
    (lifting.operations, outputs)
}

#[derive(Default)]
struct Lifting {
    operations: Vec<Operation>,
    /// Whether a node has one number per sample.
    by_row: Vec<bool>,
    pairs: Vec<Option<Pair>>,
}

impl Lifting {
    /// The node of an operation, or of the choice that equals it.
    fn enter(&mut self, operation: Operation) -> Id {
        let Some(pair) = self.pair(operation) else { return self.push(operation, None) };
        let operation = if is_cheap(operation) {
            operation
        } else {
            Operation::Choose(pair.mask, pair.yes, pair.no)
        };
        self.push(operation, Some(pair))
    }

    fn push(&mut self, operation: Operation, pair: Option<Pair>) -> Id {
        let by_row = operation.is_by_row()
            || operation.operands().iter().any(|&operand| self.by_row[operand]);
        self.operations.push(operation);
        self.by_row.push(by_row);
        self.pairs.push(pair);
        self.operations.len() - 1
    }

    /// The two values of an operation, if it has two.
    fn pair(&mut self, operation: Operation) -> Option<Pair> {
        let operands = operation.operands();
        if let Operation::Choose(mask, yes, no) = operation
            && self.by_row[mask]
            && !self.by_row[yes]
            && !self.by_row[no]
        {
            return Some(Pair { mask, yes, no });
        }
        if !matches!(
            operation,
            Operation::Unary(..) | Operation::Binary(..) | Operation::Choose(..)
        ) {
            return None;
        }
        let mask = operands.iter().find_map(|&operand| self.pairs[operand])?.mask;
        let fits = |&operand: &Id| match self.pairs[operand] {
            Some(pair) => pair.mask == mask,
            None => !self.by_row[operand],
        };
        if !operands.iter().all(fits) {
            return None;
        }
        let [yes, no] = [|pair: Pair| pair.yes, |pair: Pair| pair.no].map(|side| {
            let of = |operand: Id| self.pairs[operand].map_or(operand, side);
            operation.moved(of, |column| column)
        });
        Some(Pair { mask, yes: self.push(yes, None), no: self.push(no, None) })
    }
}

/// Whether an operation takes no longer than a choice, and runs in the loop of its neighbours.
fn is_cheap(operation: Operation) -> bool {
    matches!(
        operation,
        Operation::Unary(Unary::Negate, _)
            | Operation::Binary(
                Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Chain,
                ..
            )
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_of_two_values_is_computed_twice() {
        let all = [
            Operation::Column(0),
            Operation::Parameter(0),
            Operation::Parameter(1),
            Operation::Choose(0, 1, 2),
            Operation::Unary(Unary::Negate, 3),
            Operation::Unary(Unary::Exp, 4),
            Operation::Binary(Binary::Multiply, 5, 0),
        ];
        let (lifted, outputs) = with_two_values(&all, &[5, 6]);
        let Operation::Choose(mask, yes, no) = lifted[outputs[0]] else {
            panic!("{:?}", lifted[outputs[0]]);
        };
        let argument = |id: Id| match lifted[id] {
            Operation::Unary(Unary::Exp, x) => lifted[x],
            other => other,
        };
        assert_eq!(lifted[mask], Operation::Column(0));
        assert_eq!(argument(yes), Operation::Unary(Unary::Negate, 1));
        assert_eq!(argument(no), Operation::Unary(Unary::Negate, 2));
        assert_eq!(lifted[outputs[1]], Operation::Binary(Binary::Multiply, outputs[0], 0));
    }

    #[test]
    fn different_masks_are_not_joined() {
        let all = [
            Operation::Column(0),
            Operation::Column(1),
            Operation::Parameter(0),
            Operation::Parameter(1),
            Operation::Choose(0, 2, 3),
            Operation::Choose(1, 2, 3),
            Operation::Binary(Binary::Divide, 4, 5),
        ];
        let (lifted, outputs) = with_two_values(&all, &[6]);
        assert_eq!((&lifted[..], &outputs[..]), (&all[..], &[6][..]));
    }
}
