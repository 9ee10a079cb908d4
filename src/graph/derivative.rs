//! Symbolic derivatives, along the rules of [`Dual`](crate::scalar::Dual).

use std::vec::Vec;

use super::operation::{Binary, Id, Operation, Relaxing, Start, Unary};
use super::recorded::Recorded;
use super::recorder::Recorder;
use crate::scalar::Real;

/// The derivatives of each output by each of the `wanted` parameters; what does not depend on a
/// parameter is known to be 0.
pub fn derivatives<'r>(
    recorder: &'r Recorder,
    outputs: &[Id],
    wanted: &[usize],
) -> Vec<Vec<Recorded<'r>>> {
    let operations = recorder.operations();
    let last = outputs.iter().max().map_or(0, |&last| last + 1);
    let mut rules = Rules { recorder, slopes: Vec::with_capacity(last) };
    for (id, &operation) in operations[..last].iter().enumerate() {
        let slopes = (0..wanted.len()).map(|k| rules.slope(id, operation, wanted, k)).collect();
        rules.slopes.push(slopes);
    }
    let zero = Recorded::Known(0.0);
    let of = |id: &Id| rules.slopes[*id].iter().map(|slope| slope.unwrap_or(zero)).collect();
    outputs.iter().map(of).collect()
}

/// A derivative, if there is one.
type Slope<'r> = Option<Recorded<'r>>;

struct Rules<'r> {
    recorder: &'r Recorder,
    slopes: Vec<Vec<Slope<'r>>>,
}

impl<'r> Rules<'r> {
    fn slope(&self, id: Id, operation: Operation, wanted: &[usize], k: usize) -> Slope<'r> {
        let number = |id| self.number(id);
        let slope = |id: Id| self.slopes[id][k];
        match operation {
            Operation::Constant(_) | Operation::Column(_) => None,
            Operation::Parameter(own) => (wanted[k] == own).then_some(Recorded::Known(1.0)),
            Operation::Unary(unary, x) => self.unary(unary, number(id), number(x), slope(x)?),
            Operation::Binary(Binary::Power, x, p) => {
                self.power(number(id), [number(x), number(p)], [slope(x), slope(p)])
            }
            Operation::Binary(binary, x, y) => {
                self.binary(binary, number(id), [number(x), number(y)], [slope(x), slope(y)])
            }
            Operation::Choose(mask, x, y) => {
                let (by_x, by_y) = (slope(x), slope(y));
                if by_x.is_none() && by_y.is_none() {
                    return None;
                }
                let node = |by: Slope<'r>| self.recorder.id(by.unwrap_or(Recorded::Known(0.0)));
                let operation = Operation::Choose(mask, node(by_x), node(by_y));
                Some(self.recorder.number(operation))
            }
            Operation::Previous(x) => Some(match slope(x)? {
                Recorded::Known(known) => Recorded::Known(known),
                Recorded::Node(_, node) => self.recorder.number(Operation::Previous(node)),
            }),
            Operation::Relax(relaxing) => self.relax(id, relaxing, k),
            Operation::Before(state, _, _) => Some(self.before(slope(state)?)),
        }
    }

    /// The state's derivative relaxes alike, and is moved by those of share, target and shift.
    fn relax(&self, state: Id, relaxing: Relaxing, k: usize) -> Slope<'r> {
        let Relaxing { share, target, extra, shift, settled, .. } = relaxing;
        let [by_share, by_target, by_extra, by_shift, by_settled] =
            [share, target, extra, shift, settled].map(|id| self.slopes[id][k]);
        let moved = by_share.map(|by| {
            by * (self.number(target) - self.before(Recorded::Node(self.recorder, state)))
        });
        let extra = sum(moved, by_extra);
        if [extra, by_target, by_shift, by_settled].iter().all(Option::is_none) {
            return None;
        }
        let node = |slope: Slope<'r>| self.recorder.id(slope.unwrap_or(Recorded::Known(0.0)));
        let relaxing = Relaxing {
            share,
            target: node(by_target),
            extra: node(extra),
            shift: node(by_shift),
            settled: node(by_settled),
            start: Start::Zero,
        };
        Some(self.recorder.number(Operation::Relax(relaxing)))
    }

    /// The state before the row, or its derivative.
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

    /// A function's slope times a derivative.
    fn chain(&self, slope: Recorded<'r>, by: Recorded<'r>) -> Recorded<'r> {
        if slope.is(1.0) {
            by
        } else if by.is(1.0) {
            slope
        } else {
            let (slope, by) = (self.recorder.id(slope), self.recorder.id(by));
            self.recorder.binary(Binary::Chain, slope, by)
        }
    }

    fn unary(
        &self,
        unary: Unary,
        value: Recorded<'r>,
        x: Recorded<'r>,
        by: Recorded<'r>,
    ) -> Slope<'r> {
        let one = Recorded::Known(1.0);
        let slope = match unary {
            Unary::Negate => return Some(-by),
            Unary::Sign | Unary::IsFinite | Unary::Not => return None,
            Unary::Abs => x.sign(),
            Unary::Exp => value,
            Unary::Expm1 => {
                let near = value.is_above(Recorded::Known(-0.5));
                Recorded::choose(near, value + one, x.exp())
            }
            Unary::Ln => one / x,
            Unary::Sqrt => Recorded::Known(0.5) / value,
            Unary::Cbrt => one / (Recorded::Known(3.0) * value * value),
            Unary::Sin => x.cos(),
            Unary::Cos => -x.sin(),
            Unary::Tanh => {
                let e = (Recorded::Known(-2.0) * x.abs()).exp();
                let whole = one + e;
                let far = Recorded::Known(4.0) * e / (whole * whole);
                let near = value.abs().is_below(Recorded::Known(0.5));
                Recorded::choose(near, one - value * value, far)
            }
            Unary::Atan => one / (one + x * x),
            Unary::Phi(order) => value - Recorded::Known(f64::from(order)) * x.phi(order + 1),
        };
        Some(self.chain(slope, by))
    }

    fn binary(
        &self,
        binary: Binary,
        value: Recorded<'r>,
        [x, y]: [Recorded<'r>; 2],
        [by_x, by_y]: [Slope<'r>; 2],
    ) -> Slope<'r> {
        match binary {
            Binary::Add => sum(by_x, by_y),
            Binary::Subtract => sum(by_x, by_y.map(|by| -by)),
            Binary::Multiply => sum(by_x.map(|by| by * y), by_y.map(|by| x * by)),
            Binary::Divide => {
                let inverse = Recorded::Known(1.0) / y;
                match (by_x, by_y) {
                    (None, None) => None,
                    (Some(by), None) => Some(by * inverse),
                    (None, Some(by)) => Some(by * (-value / y)),
                    (Some(by_x), Some(by_y)) => Some((by_x - value * by_y) * inverse),
                }
            }
            Binary::Power
            | Binary::Below
            | Binary::Above
            | Binary::Equal
            | Binary::And
            | Binary::Or
            | Binary::Chain => None,
        }
    }

    fn power(
        &self,
        value: Recorded<'r>,
        [x, p]: [Recorded<'r>; 2],
        [by_x, by_p]: [Slope<'r>; 2],
    ) -> Slope<'r> {
        let (zero, one) = (Recorded::Known(0.0), Recorded::Known(1.0));
        let at_zero = x.at_zero();
        let by_base = by_x.map(|by| {
            let unit = Recorded::choose(p.equals(one), one, zero);
            self.chain(Recorded::choose(at_zero, unit, p * (value / x)), by)
        });
        let by_exponent =
            by_p.map(|by| self.chain(Recorded::choose(at_zero, zero, value * x.ln()), by));
        sum(by_base, by_exponent)
    }
}

fn sum<'r>(x: Slope<'r>, y: Slope<'r>) -> Slope<'r> {
    match (x, y) {
        (Some(x), Some(y)) => Some(x + y),
        (x, y) => x.or(y),
    }
}
