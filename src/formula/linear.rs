//! The parameters in which a formula is linear, with all others fixed.

use super::program::{MAX_DEPTH, MAX_PARAMETERS, Operation, Program};

/// A set of parameters, one bit each.
pub(super) type ParameterSet = u16;

/// The largest set of parameters found in which the formula is jointly linear.
///
/// A set is grown from each parameter in turn, in the order of the formula; for `c1*(c2 + c3*v)`
/// this finds `c2, c3` rather than `c1`.
pub(super) fn linear_parameters(program: &Program) -> ParameterSet {
    let grown = (0..program.parameter_count).map(|first| {
        (0..program.parameter_count).fold(0, |set, step| {
            let candidate = set | 1 << ((first + step) % program.parameter_count);
            if is_linear(program, candidate) { candidate } else { set }
        })
    });
    // The first of the largest sets: `max_by_key` would return the last.
    grown.fold(
        0,
        |best: ParameterSet, set| if set.count_ones() > best.count_ones() { set } else { best },
    )
}

/// How a value depends on a set of parameters.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Degree {
    None,
    Linear,
    Nonlinear,
}

fn is_linear(program: &Program, set: ParameterSet) -> bool {
    let mut stack = [Degree::None; MAX_DEPTH + 1];
    let mut height: usize = 0;
    for &operation in program.operations() {
        let below = height.saturating_sub(operation.arity());
        let x = stack.get(below).copied().unwrap_or(Degree::Nonlinear);
        let y = stack.get(below + 1).copied().unwrap_or(Degree::Nonlinear);
        if let Some(slot) = stack.get_mut(below) {
            *slot = degree(operation, x, y, set);
        }
        height = below + 1;
    }
    stack[0] <= Degree::Linear
}

fn degree(operation: Operation, x: Degree, y: Degree, set: ParameterSet) -> Degree {
    match operation {
        Operation::Constant(_) | Operation::Channel(_) => Degree::None,
        Operation::Parameter(index) if usize::from(index) < MAX_PARAMETERS => {
            if set >> index & 1 == 1 { Degree::Linear } else { Degree::None }
        }
        Operation::Negate | Operation::IntegerPower(1) => x,
        Operation::Add | Operation::Subtract => x.max(y),
        Operation::Multiply if x == Degree::None || y == Degree::None => x.max(y),
        Operation::Divide if y == Degree::None => x,
        Operation::Call(function) if function.arity() == 1 && x == Degree::None => Degree::None,
        Operation::IntegerPower(_) if x == Degree::None => Degree::None,
        _ if operation.arity() == 2 && x == Degree::None && y == Degree::None => Degree::None,
        _ => Degree::Nonlinear,
    }
}
