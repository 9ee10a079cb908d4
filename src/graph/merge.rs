//! Which operations run in one loop, so that the numbers between them stay in registers.
//!
//! Every operation is rounded as in a loop of its own: nothing is fused or reordered.

use std::vec;
use std::vec::Vec;

use super::operation::{Binary, Id, Operation, Unary};

/// Largest number of sums and products of one loop.
pub const MAX_STEPS: usize = 3;

/// What one loop computes.
#[derive(Clone, Copy, Debug)]
pub enum Work {
    /// One operation.
    Single(Operation),
    /// The first operand, then a step with each of the others.
    Steps(Steps),
    /// `|x / y|`.
    AbsoluteQuotient,
    /// `e^-x`.
    NegativeExponential,
    /// `-x`, with another `x` where two numbers are equal. Operands: the two numbers, `x` where they
    /// are equal, `x` elsewhere.
    NegativeUnless,
}

/// Sums and products one after another.
#[derive(Clone, Copy, Debug)]
pub struct Steps {
    each: [Step; MAX_STEPS],
    count: usize,
}

/// An operation on the number in a register and another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// A sum.
    Add,
    /// Minus the other number.
    Subtract,
    /// A product.
    Multiply,
    /// [`Binary::Chain`].
    Chain,
}

impl Steps {
    /// No step.
    pub const NONE: Self = Self { each: [Step::Add; MAX_STEPS], count: 0 };

    /// With one step more; there must be room.
    #[must_use]
    pub fn then(mut self, step: Step) -> Self {
        self.each[self.count] = step;
        self.count += 1;
        self
    }

    /// The steps, in their order.
    #[inline(always)]
    #[must_use]
    pub fn as_slice(&self) -> &[Step] {
        &self.each[..self.count]
    }
}

/// What a loop computes, and the nodes that it reads.
#[derive(Clone, Debug)]
pub struct Job {
    /// What it computes.
    pub work: Work,
    /// The nodes that it reads.
    pub operands: Vec<Id>,
}

impl Job {
    fn of(operation: Operation) -> Self {
        Self { work: Work::Single(operation), operands: operation.operands() }
    }
}

/// A loop for each node.
pub fn each_alone(operations: &[Operation]) -> Vec<Option<Job>> {
    operations.iter().map(|&operation| Some(Job::of(operation))).collect()
}

/// The loop of each node in `order`, if it has one: others are computed in the loop of the only node
/// that reads them. The last operation must be the constant -1.
pub fn jobs(operations: &[Operation], order: &[Id], outputs: &[Id]) -> Vec<Option<Job>> {
    let mut uses = vec![0_usize; operations.len()];
    let mut by_row = vec![false; operations.len()];
    for &id in order {
        let operands = operations[id].operands();
        by_row[id] = operations[id].is_by_row() || operands.iter().any(|&own| by_row[own]);
        operands.iter().for_each(|&own| uses[own] += 1);
    }
    outputs.iter().for_each(|&id| uses[id] += 1);
    let jobs = vec![None; operations.len()];
    let mut merger = Merger { operations, uses, by_row, jobs };
    for &id in order {
        merger.jobs[id] = Some(merger.job(id));
    }
    let single = |(job, &operation): (Option<Job>, &Operation)| match job {
        Some(Job { work: Work::Steps(Steps { count: 1, .. }), .. }) => Some(Job::of(operation)),
        job => job,
    };
    merger.jobs.into_iter().zip(operations).map(single).collect()
}

struct Merger<'a> {
    operations: &'a [Operation],
    /// How often each node is read.
    uses: Vec<usize>,
    /// Whether a node has one number per sample.
    by_row: Vec<bool>,
    jobs: Vec<Option<Job>>,
}

impl Merger<'_> {
    fn job(&mut self, id: Id) -> Job {
        let operation = self.operations[id];
        let minus_one = self.operations.len() - 1;
        let merged = match operation {
            _ if !self.by_row[id] => None,
            Operation::Unary(Unary::Negate, x) => self
                .negative_unless(x)
                .or_else(|| self.longest(&[(x, &[(Step::Multiply, minus_one)])])),
            Operation::Binary(Binary::Subtract, x, y) => self.longest(&[
                (x, &[(Step::Subtract, y)]),
                (y, &[(Step::Multiply, minus_one), (Step::Add, x)]),
            ]),
            Operation::Binary(binary, x, y) => {
                step(binary).and_then(|step| self.longest(&[(x, &[(step, y)]), (y, &[(step, x)])]))
            }
            Operation::Unary(Unary::Abs, x) => self.absolute_quotient(x),
            Operation::Unary(Unary::Exp, x) => self.negative_exponential(x),
            _ => None,
        };
        merged.unwrap_or_else(|| Job::of(operation))
    }

    /// The longest of some alternatives, a node and the steps that follow it: they continue the loop
    /// of that node if nothing else reads it. Otherwise the first.
    fn longest(&mut self, alternatives: &[(Id, &[(Step, Id)])]) -> Option<Job> {
        let before = |&&(first, then): &&(Id, &[(Step, Id)])| match &self.jobs[first] {
            Some(Job { work: Work::Steps(steps), .. })
                if self.uses[first] == 1
                    && self.by_row[first]
                    && steps.count + then.len() <= MAX_STEPS =>
            {
                steps.count
            }
            _ => 0,
        };
        // The last of equal ones is found, so the order is reversed.
        let (first, then) = *alternatives.iter().rev().max_by_key(before)?;
        let (mut steps, mut operands) = match before(&&(first, then)) {
            0 => (Steps::NONE, vec![first]),
            _ => match self.jobs[first].take()? {
                Job { work: Work::Steps(steps), operands } => (steps, operands),
                _ => return None,
            },
        };
        for &(step, other) in then {
            steps = steps.then(step);
            operands.push(other);
        }
        Some(Job { work: Work::Steps(steps), operands })
    }

    /// Whether a node has a loop of its own whose numbers only one other node reads.
    fn serves_one(&self, id: Id) -> bool {
        let own = matches!(
            self.jobs[id],
            Some(Job { work: Work::Single(_) | Work::Steps(Steps { count: 1, .. }), .. })
        );
        own && self.uses[id] == 1 && self.by_row[id]
    }

    fn absolute_quotient(&mut self, x: Id) -> Option<Job> {
        let Operation::Binary(Binary::Divide, above, below) = self.operations[x] else {
            return None;
        };
        if !self.serves_one(x) {
            return None;
        }
        self.jobs[x] = None;
        Some(Job { work: Work::AbsoluteQuotient, operands: vec![above, below] })
    }

    fn negative_unless(&mut self, x: Id) -> Option<Job> {
        let Operation::Choose(mask, yes, no) = self.operations[x] else { return None };
        let Operation::Binary(Binary::Equal, one, other) = self.operations[mask] else {
            return None;
        };
        let by_row = [one, other, yes, no].map(|id| self.by_row[id]);
        if !self.serves_one(x) || !self.serves_one(mask) || by_row != [true, false, false, true] {
            return None;
        }
        (self.jobs[x], self.jobs[mask]) = (None, None);
        Some(Job { work: Work::NegativeUnless, operands: vec![one, other, yes, no] })
    }

    fn negative_exponential(&mut self, x: Id) -> Option<Job> {
        let Operation::Unary(Unary::Negate, inner) = self.operations[x] else { return None };
        if !self.serves_one(x) {
            return None;
        }
        self.jobs[x] = None;
        Some(Job { work: Work::NegativeExponential, operands: vec![inner] })
    }
}

fn step(binary: Binary) -> Option<Step> {
    match binary {
        Binary::Add => Some(Step::Add),
        Binary::Multiply => Some(Step::Multiply),
        Binary::Chain => Some(Step::Chain),
        _ => None,
    }
}

/// Operations and outputs without sums with 0 that change no bits: those of a number that cannot be
/// -0.
pub fn without_zeros(operations: &[Operation], outputs: &[Id]) -> (Vec<Operation>, Vec<Id>) {
    let mut instead: Vec<Id> = Vec::with_capacity(operations.len());
    let mut changed: Vec<Operation> = Vec::with_capacity(operations.len());
    let mut never_negative_zero: Vec<bool> = Vec::with_capacity(operations.len());
    for (id, operation) in operations.iter().enumerate() {
        let operation = operation.moved(|own| instead[own], |column| column);
        let is_zero = |own: Id| changed[own] == Operation::Constant(0.0_f64.to_bits());
        let never = |own: Id| never_negative_zero[own];
        instead.push(match operation {
            Operation::Binary(Binary::Add, x, y) if is_zero(y) && never(x) => x,
            Operation::Binary(Binary::Add, x, y) if is_zero(x) && never(y) => y,
            _ => id,
        });
        never_negative_zero.push(match operation {
            Operation::Constant(bits) => bits != (-0.0_f64).to_bits(),
            Operation::Unary(Unary::Abs | Unary::Exp | Unary::Sign, _) => true,
            Operation::Binary(Binary::Add, x, y) => never(x) || never(y),
            Operation::Binary(Binary::Subtract, x, _) => never(x),
            Operation::Choose(_, x, y) => never(x) && never(y),
            _ => false,
        });
        changed.push(operation);
    }
    (changed, outputs.iter().map(|&own| instead[own]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEGATIVE: Operation = Operation::Constant((-1.0_f64).to_bits());
    const ZERO: Operation = Operation::Constant(0.0_f64.to_bits());
    const COLUMN: Operation = Operation::Column(0);

    fn loops(operations: &[Operation]) -> Vec<Id> {
        let order: Vec<Id> = (0..operations.len()).collect();
        let jobs = jobs(operations, &order, &[operations.len() - 2]);
        order.into_iter().filter(|&id| jobs[id].is_some()).collect()
    }

    #[test]
    fn sums_and_products_in_a_row_are_one_loop() {
        let chain = [
            COLUMN,
            Operation::Parameter(0),
            Operation::Binary(Binary::Multiply, 0, 1),
            Operation::Binary(Binary::Add, 1, 2),
            Operation::Unary(Unary::Negate, 3),
            Operation::Binary(Binary::Subtract, 4, 0),
            NEGATIVE,
        ];
        // The first three steps, then the last.
        assert_eq!(loops(&chain), [0, 1, 4, 5, 6]);
    }

    #[test]
    fn what_two_loops_read_is_kept() {
        let shared = [
            COLUMN,
            Operation::Binary(Binary::Multiply, 0, 0),
            Operation::Binary(Binary::Add, 1, 0),
            Operation::Binary(Binary::Multiply, 1, 2),
            NEGATIVE,
        ];
        assert_eq!(loops(&shared), [0, 1, 3, 4]);
    }

    #[test]
    fn zero_is_added_where_it_changes_a_sign() {
        let sums = [
            COLUMN,
            ZERO,
            Operation::Binary(Binary::Add, 0, 1),
            Operation::Binary(Binary::Add, 2, 1),
            Operation::Unary(Unary::Abs, 0),
            Operation::Binary(Binary::Add, 1, 4),
            Operation::Binary(Binary::Subtract, 3, 5),
        ];
        let (changed, outputs) = without_zeros(&sums, &[3, 5, 6]);
        assert_eq!(outputs, [2, 4, 6]);
        assert_eq!(changed[6], Operation::Binary(Binary::Subtract, 2, 4));
    }
}
