//! Symbolic derivatives of a graph.
//!
//! From an output back to parameters and states the mode is reverse: one factor per node, whatever
//! the number of parameters (Griewank and Walther 2008, section 3.2). States are differentiated
//! forwards, along the samples. The rules are those of [`Dual`](crate::scalar::Dual).

use std::collections::HashMap;
use std::vec;
use std::vec::Vec;

use super::operation::{Binary, Id, Operation, Relaxing, Start, Unary};
use super::recorded::Recorded;
use super::recorder::Recorder;
use crate::scalar::Real;

/// The derivatives of each output with respect to each of the `wanted` parameters; known to be 0
/// where it does not depend on one. Nodes in `bottlenecks` lie between many parameters and several
/// outputs or states: they are differentiated first, once.
pub fn derivatives<'r>(
    recorder: &'r Recorder,
    outputs: &[Id],
    bottlenecks: &[Id],
    wanted: &[usize],
) -> Vec<Vec<Recorded<'r>>> {
    let operations = recorder.operations();
    let mut depends: Vec<bool> = Vec::with_capacity(operations.len());
    for operation in &operations {
        depends.push(match *operation {
            Operation::Parameter(own) => wanted.contains(&own),
            operation => operation.operands().iter().any(|&operand| depends[operand]),
        });
    }
    let mut rules = Rules { recorder, wanted, operations, depends, known: HashMap::new() };
    let zero = Recorded::Known(0.0);
    let numbers =
        |slopes: Vec<Slope<'r>>| slopes.into_iter().map(|by| by.unwrap_or(zero)).collect();
    for &bottleneck in bottlenecks {
        rules.of(bottleneck);
    }
    outputs.iter().map(|&output| numbers(rules.of(output))).collect()
}

/// A derivative, or `None` if it is identically 0.
type Slope<'r> = Option<Recorded<'r>>;

struct Rules<'r, 'w> {
    recorder: &'r Recorder,
    wanted: &'w [usize],
    operations: Vec<Operation>,
    /// Whether each node depends on a wanted parameter.
    depends: Vec<bool>,
    /// Derivatives computed so far.
    known: HashMap<Id, Vec<Slope<'r>>>,
}

impl<'r> Rules<'r, '_> {
    /// The derivatives of a node with respect to each wanted parameter.
    fn of(&mut self, id: Id) -> Vec<Slope<'r>> {
        if let Some(known) = self.known.get(&id) {
            return known.clone();
        }
        let slopes = match self.operations[id] {
            _ if !self.depends[id] => vec![None; self.wanted.len()],
            Operation::Parameter(own) => {
                let is_own = |&wanted: &usize| (wanted == own).then_some(Recorded::Known(1.0));
                self.wanted.iter().map(is_own).collect()
            }
            Operation::Previous(x) => {
                self.of(x).into_iter().map(|by| Some(self.previous(by?))).collect()
            }
            Operation::Relax(relaxing) => self.relax(id, relaxing),
            Operation::Before(state, _, _) => {
                self.of(state).into_iter().map(|by| Some(self.before(by?))).collect()
            }
            _ => self.backwards(&[(id, Recorded::Known(1.0))]),
        };
        self.known.insert(id, slopes.clone());
        slopes
    }

    /// The derivatives of a weighted sum of nodes. Goes backwards from them to parameters, states
    /// and nodes of known derivatives, and multiplies by these.
    fn backwards(&mut self, sum: &[(Id, Recorded<'r>)]) -> Vec<Slope<'r>> {
        let last = sum.iter().map(|&(id, _)| id).max().unwrap_or(0);
        let mut factors: Vec<Slope<'r>> = vec![None; last + 1];
        for &(id, factor) in sum.iter().filter(|&&(id, _)| self.depends[id]) {
            factors[id] = self.plus(factors[id], Some(factor));
        }
        let mut slopes = vec![None; self.wanted.len()];
        for id in (0..=last).rev() {
            let Some(factor) = factors[id] else { continue };
            let operation = self.operations[id];
            let ends = matches!(operation, Operation::Parameter(_)) || operation.has_memory();
            if ends || self.known.contains_key(&id) {
                for (sum, by) in slopes.iter_mut().zip(self.of(id)) {
                    *sum = self.plus(*sum, by.map(|by| self.times(factor, by)));
                }
                continue;
            }
            for (operand, own) in self.shares(id, operation, factor) {
                factors[operand] = self.plus(factors[operand], Some(own));
            }
        }
        slopes
    }

    /// The factors that a node's factor passes on to its operands.
    fn shares(
        &self,
        id: Id,
        operation: Operation,
        factor: Recorded<'r>,
    ) -> Vec<(Id, Recorded<'r>)> {
        let mut shares = Vec::new();
        let mut share = |operand: Id, own: &dyn Fn() -> Option<Recorded<'r>>| {
            if self.depends[operand]
                && let Some(own) = own()
            {
                shares.push((operand, own));
            }
        };
        let value = self.number(id);
        match operation {
            Operation::Unary(Unary::Negate, x) => share(x, &|| Some(-factor)),
            Operation::Unary(unary, x) => share(x, &|| {
                let slope = slope(unary, value, self.number(x))?;
                Some(self.times(slope, factor))
            }),
            Operation::Binary(binary, x, y) => {
                let numbers = [self.number(x), self.number(y)];
                share(x, &|| self.first(binary, value, numbers, factor));
                share(y, &|| self.second(binary, value, numbers, factor));
            }
            Operation::Choose(mask, x, y) => {
                let zero = Recorded::Known(0.0);
                let (negative, factor) = self.split_sign(factor);
                share(x, &|| Some(signed(negative, self.choose(mask, factor, zero))));
                share(y, &|| Some(signed(negative, self.choose(mask, zero, factor))));
            }
            Operation::Constant(_)
            | Operation::Parameter(_)
            | Operation::Column(_)
            | Operation::Previous(_)
            | Operation::Relax(_)
            | Operation::Before(..) => {}
        }
        shares
    }

    /// The factor of the first operand.
    fn first(
        &self,
        binary: Binary,
        value: Recorded<'r>,
        [x, y]: [Recorded<'r>; 2],
        factor: Recorded<'r>,
    ) -> Slope<'r> {
        let (zero, one) = (Recorded::Known(0.0), Recorded::Known(1.0));
        match binary {
            Binary::Add | Binary::Subtract => Some(factor),
            Binary::Multiply => Some(self.times(y, factor)),
            Binary::Divide => Some(self.times(one / y, factor)),
            Binary::Power => {
                let unit = Recorded::choose(y.equals(one), one, zero);
                let slope = Recorded::choose(x.at_zero(), unit, y * (value / x));
                Some(self.times(slope, factor))
            }
            _ => None,
        }
    }

    /// The factor of the second operand.
    fn second(
        &self,
        binary: Binary,
        value: Recorded<'r>,
        [x, y]: [Recorded<'r>; 2],
        factor: Recorded<'r>,
    ) -> Slope<'r> {
        match binary {
            Binary::Add => Some(factor),
            Binary::Subtract => Some(-factor),
            Binary::Multiply => Some(self.times(x, factor)),
            // Uses 1 / y, which the factor of the first operand needs too.
            Binary::Divide => Some(-self.times(value * (Recorded::Known(1.0) / y), factor)),
            Binary::Power => {
                let slope = Recorded::choose(x.at_zero(), Recorded::Known(0.0), value * x.ln());
                Some(self.times(slope, factor))
            }
            _ => None,
        }
    }

    /// A number without its leading minus, and whether it had one. Signs are propagated to where a
    /// sum turns them into a subtraction.
    fn split_sign(&self, x: Recorded<'r>) -> (bool, Recorded<'r>) {
        if let Recorded::Node(recorder, id) = x
            && let Operation::Unary(Unary::Negate, inner) = recorder.operation(id)
        {
            (true, self.number(inner))
        } else {
            (false, x)
        }
    }

    fn plus(&self, x: Slope<'r>, y: Slope<'r>) -> Slope<'r> {
        let (Some(x), Some(y)) = (x, y) else { return x.or(y) };
        Some(match (self.split_sign(x), self.split_sign(y)) {
            ((_, _), (true, y)) => x - y,
            ((true, x), (false, y)) => y - x,
            ((false, x), (false, y)) => x + y,
        })
    }

    fn choose(&self, mask: Id, yes: Recorded<'r>, no: Recorded<'r>) -> Recorded<'r> {
        let (yes, no) = (self.recorder.id(yes), self.recorder.id(no));
        self.recorder.number(Operation::Choose(mask, yes, no))
    }

    /// A product that is 0 where one factor is 0, even if the other is infinite.
    fn times(&self, slope: Recorded<'r>, by: Recorded<'r>) -> Recorded<'r> {
        let ((one, slope), (other, by)) = (self.split_sign(slope), self.split_sign(by));
        let product = if slope.is(1.0) {
            by
        } else if by.is(1.0) {
            slope
        } else {
            self.recorder.binary(Binary::Chain, self.recorder.id(slope), self.recorder.id(by))
        };
        signed(one != other, product)
    }

    fn previous(&self, by: Recorded<'r>) -> Recorded<'r> {
        match by {
            Recorded::Known(known) => Recorded::Known(known),
            Recorded::Node(_, node) => self.recorder.number(Operation::Previous(node)),
        }
    }

    /// The derivative of a state relaxes to 0 with the same share, driven by the derivatives of
    /// share, target, extra and shift.
    fn relax(&mut self, state: Id, relaxing: Relaxing) -> Vec<Slope<'r>> {
        let Relaxing { share, target, extra, shift, settled, .. } = relaxing;
        let one = Recorded::Known(1.0);
        let way = self.number(target) - self.before(Recorded::Node(self.recorder, state));
        // Differentiated first, so that the reverse sweep ends there.
        let by_settled = self.of(settled);
        let moved = self.backwards(&[
            (share, way),
            (target, self.number(share)),
            (extra, one),
            (shift, one),
        ]);
        let node = |slope: Slope<'r>| self.recorder.id(slope.unwrap_or(Recorded::Known(0.0)));
        let slope = |k: usize| {
            if moved[k].is_none() && by_settled[k].is_none() {
                return None;
            }
            let relaxing = Relaxing {
                share,
                target: node(None),
                extra: node(moved[k]),
                shift: node(None),
                settled: node(by_settled[k]),
                start: Start::Zero,
            };
            Some(self.recorder.number(Operation::Relax(relaxing)))
        };
        (0..self.wanted.len()).map(slope).collect()
    }

    /// The state before the sample, or the derivative of that.
    fn before(&self, state: Recorded<'r>) -> Recorded<'r> {
        let id = self.recorder.id(state);
        match self.recorder.operation(id) {
            Operation::Relax(Relaxing { settled, start, .. }) => {
                self.recorder.number(Operation::Before(id, settled, start))
            }
            _ => state,
        }
    }

    fn number(&self, id: Id) -> Recorded<'r> {
        match self.recorder.operation(id) {
            Operation::Constant(bits) => Recorded::Known(f64::from_bits(bits)),
            _ => Recorded::Node(self.recorder, id),
        }
    }
}

fn signed(negative: bool, x: Recorded<'_>) -> Recorded<'_> {
    if negative { -x } else { x }
}

/// The slope of a function at `x`, if it is differentiable.
fn slope<'r>(unary: Unary, value: Recorded<'r>, x: Recorded<'r>) -> Slope<'r> {
    let one = Recorded::Known(1.0);
    Some(match unary {
        Unary::Negate => -one,
        Unary::Sign | Unary::IsFinite | Unary::Not => return None,
        Unary::Abs => x.sign(),
        Unary::Exp => value,
        // Far below zero `value + 1` loses its digits by cancellation.
        Unary::Expm1 => {
            let near = value.is_above(Recorded::Known(-0.5));
            Recorded::choose(near, value + one, x.exp())
        }
        Unary::Ln => one / x,
        Unary::Sqrt => Recorded::Known(0.5) / value,
        Unary::Cbrt => one / (Recorded::Known(3.0) * value * value),
        Unary::Sin => x.cos(),
        Unary::Cos => -x.sin(),
        // Far from zero 1 - tanh^2 cancels: use 4 e / (1 + e)^2 with e = exp(-2 |x|) there.
        Unary::Tanh => {
            let e = (Recorded::Known(-2.0) * x.abs()).exp();
            let whole = one + e;
            let far = Recorded::Known(4.0) * e / (whole * whole);
            let near = value.abs().is_below(Recorded::Known(0.5));
            Recorded::choose(near, one - value * value, far)
        }
        Unary::Atan => one / (one + x * x),
        // phi_k' = phi_k - k phi_(k+1)
        Unary::Phi(order) => value - Recorded::Known(f64::from(order)) * x.phi(order + 1),
    })
}
