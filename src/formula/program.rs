//! Operations in postfix order, and their evaluation.

use core::ops::Range;

use super::vocabulary::Function;
use crate::sample::Sample;
use crate::scalar::{Mask, Real};
use crate::table::Channel;

/// Largest number of operations of a formula.
pub const MAX_OPERATIONS: usize = 160;
/// Largest number of constants of a formula.
pub const MAX_CONSTANTS: usize = 40;
/// Largest number of parameters of a formula.
pub const MAX_PARAMETERS: usize = 16;
/// Largest number of values on the stack, and deepest nesting of brackets.
pub const MAX_DEPTH: usize = 24;

/// One operation: it pops its operands from a stack and pushes its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A number, by its index in [`Program::constants`].
    Constant(u8),
    /// A parameter, by its index.
    Parameter(u8),
    /// A channel of the sample.
    Channel(Channel),
    /// `-x`.
    Negate,
    /// `x + y`.
    Add,
    /// `x - y`.
    Subtract,
    /// `x y`.
    Multiply,
    /// `x / y`.
    Divide,
    /// `x^n` by multiplication: exact for `n = 2`, and defined for negative `x`.
    IntegerPower(i8),
    /// A function; `x^y` is one of them.
    Call(Function),
}

impl Operation {
    /// Number of operands.
    #[must_use]
    pub const fn arity(self) -> usize {
        match self {
            Self::Constant(_) | Self::Parameter(_) | Self::Channel(_) => 0,
            Self::Negate | Self::IntegerPower(_) => 1,
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide => 2,
            Self::Call(function) => function.arity(),
        }
    }
}

/// A parsed formula: its operations, without the names of its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Program {
    operations: [Operation; MAX_OPERATIONS],
    length: usize,
    constants: [f64; MAX_CONSTANTS],
    constant_count: usize,
    pub(super) parameter_count: usize,
}

/// A part of a program that is replaced by a known value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Replacement<'a, P> {
    pub(super) part: &'a Range<usize>,
    pub(super) by: P,
}

impl Program {
    pub(super) const EMPTY: Self = Self {
        operations: [Operation::Negate; MAX_OPERATIONS],
        length: 0,
        constants: [0.0; MAX_CONSTANTS],
        constant_count: 0,
        parameter_count: 0,
    };

    /// The operations in the order of evaluation.
    #[must_use]
    pub fn operations(&self) -> &[Operation] {
        self.operations.get(..self.length).unwrap_or_default()
    }

    /// The constants, in the order in which operations refer to them.
    #[must_use]
    pub fn constants(&self) -> &[f64] {
        self.constants.get(..self.constant_count).unwrap_or_default()
    }

    /// Appends an operation; `false` if the program is full.
    pub(super) fn push(&mut self, operation: Operation) -> bool {
        let Some(slot) = self.operations.get_mut(self.length) else { return false };
        *slot = operation;
        self.length += 1;
        true
    }

    /// Appends a constant; `false` if the program is full.
    pub(super) fn push_constant(&mut self, value: f64) -> bool {
        let index = self.constant_count;
        let Some(slot) = self.constants.get_mut(index) else { return false };
        *slot = value;
        self.constant_count += 1;
        u8::try_from(index).is_ok_and(|index| self.push(Operation::Constant(index)))
    }

    /// Removes the last operation if it is a constant.
    pub(super) fn pop_constant(&mut self) -> Option<f64> {
        let Some(Operation::Constant(_)) = self.operations().last() else { return None };
        let value = self.constants().last().copied()?;
        self.length -= 1;
        self.constant_count -= 1;
        Some(value)
    }

    /// The sum of two programs, the second with separate parameters; `None` if it is too large.
    pub(super) fn plus(&self, other: &Self) -> Option<Self> {
        let mut sum = *self;
        sum.parameter_count += other.parameter_count;
        let shift = u8::try_from(self.parameter_count).ok()?;
        for &operation in other.operations() {
            let room = match operation {
                Operation::Constant(index) => {
                    sum.push_constant(*other.constants().get(usize::from(index))?)
                }
                Operation::Parameter(index) => sum.push(Operation::Parameter(index + shift)),
                operation => sum.push(operation),
            };
            room.then_some(())?;
        }
        let fits = sum.push(Operation::Add)
            && sum.parameter_count <= MAX_PARAMETERS
            && sum.depth() <= MAX_DEPTH;
        fits.then_some(sum)
    }

    /// The operations that compute the value of the one at `last`, including that one.
    pub(super) fn part(&self, last: usize) -> Range<usize> {
        let mut open = 1;
        let mut first = last + 1;
        for operation in self.operations().get(..=last).unwrap_or_default().iter().rev() {
            first -= 1;
            open += operation.arity();
            open -= 1;
            if open == 0 {
                break;
            }
        }
        first..last + 1
    }

    /// The largest number of values on the stack.
    pub(super) fn depth(&self) -> usize {
        let mut depth: usize = 0;
        let deepest = self.operations().iter().map(|operation| {
            depth = (depth + 1).saturating_sub(operation.arity());
            depth
        });
        deepest.max().unwrap_or_default()
    }

    /// The value of a part of the program.
    #[inline]
    pub(super) fn evaluate<S: Real>(
        &self,
        part: &Range<usize>,
        replacement: Option<Replacement<'_, S::Plain>>,
        parameters: &[S; MAX_PARAMETERS],
        sample: &Sample<S::Plain>,
    ) -> S {
        let mut stack = Stack::new();
        let mut next = part.start;
        while next < part.end {
            if let Some(replacement) = &replacement
                && next == replacement.part.start
            {
                stack.push(Value::Known(replacement.by));
                next = replacement.part.end;
                continue;
            }
            let Some(&operation) = self.operations.get(next) else { break };
            self.run(operation, &mut stack, parameters, sample);
            next += 1;
        }
        stack.pop().full()
    }

    #[inline]
    fn run<S: Real>(
        &self,
        operation: Operation,
        stack: &mut Stack<S>,
        parameters: &[S; MAX_PARAMETERS],
        sample: &Sample<S::Plain>,
    ) {
        let value = match operation {
            Operation::Constant(index) => {
                let constant = self.constants.get(usize::from(index)).copied();
                Value::Known(S::Plain::from_f64(constant.unwrap_or_default()))
            }
            Operation::Parameter(index) => match parameters.get(usize::from(index)) {
                Some(&parameter) => Value::Full(parameter),
                None => Value::zero(),
            },
            Operation::Channel(channel) => Value::Known(sample.channel(channel)),
            Operation::Negate => match stack.pop() {
                Value::Known(x) => Value::Known(-x),
                Value::Full(x) => Value::Full(-x),
            },
            Operation::IntegerPower(n) => match stack.pop() {
                Value::Known(x) => Value::Known(integer_power(x, n)),
                Value::Full(x) => Value::Full(integer_power(x, n)),
            },
            Operation::Call(function) if function.arity() == 1 => match stack.pop() {
                Value::Known(x) => Value::Known(call(function, x)),
                Value::Full(x) => Value::Full(call(function, x)),
            },
            binary => {
                let y = stack.pop();
                combine(binary, stack.pop(), y)
            }
        };
        stack.push(value);
    }
}

/// A value that depends on parameters, or one that does not: the latter carries no derivatives.
#[derive(Clone, Copy)]
enum Value<S: Real> {
    Known(S::Plain),
    Full(S),
}

impl<S: Real> Value<S> {
    #[inline(always)]
    fn zero() -> Self {
        Self::Known(S::Plain::zero())
    }

    #[inline(always)]
    fn full(self) -> S {
        match self {
            Self::Known(x) => S::from_plain(x),
            Self::Full(x) => x,
        }
    }
}

/// The stack of values. The parser has checked that it is large enough.
struct Stack<S: Real> {
    values: [Value<S>; MAX_DEPTH],
    height: usize,
}

impl<S: Real> Stack<S> {
    #[inline(always)]
    fn new() -> Self {
        Self { values: [Value::zero(); MAX_DEPTH], height: 0 }
    }

    #[inline(always)]
    fn push(&mut self, value: Value<S>) {
        if let Some(slot) = self.values.get_mut(self.height) {
            *slot = value;
            self.height += 1;
        }
    }

    #[inline(always)]
    fn pop(&mut self) -> Value<S> {
        self.height = self.height.saturating_sub(1);
        self.values.get(self.height).copied().unwrap_or_else(Value::zero)
    }
}

/// A binary operation; the bits of the result do not depend on which operands are known.
#[inline]
fn combine<S: Real>(operation: Operation, x: Value<S>, y: Value<S>) -> Value<S> {
    use Value::{Full, Known};
    match (operation, x, y) {
        (Operation::Add, Known(x), Known(y)) => Known(x + y),
        (Operation::Add, Full(x), Full(y)) => Full(x + y),
        (Operation::Add, Full(x), Known(y)) | (Operation::Add, Known(y), Full(x)) => {
            Full(x.shift(y))
        }
        (Operation::Subtract, Known(x), Known(y)) => Known(x - y),
        (Operation::Subtract, Full(x), Full(y)) => Full(x - y),
        (Operation::Subtract, Full(x), Known(y)) => Full(x.shift(-y)),
        (Operation::Subtract, Known(x), Full(y)) => Full((-y).shift(x)),
        (Operation::Multiply, Known(x), Known(y)) => Known(x * y),
        (Operation::Multiply, Full(x), Full(y)) => Full(x * y),
        (Operation::Multiply, Full(x), Known(y)) | (Operation::Multiply, Known(y), Full(x)) => {
            Full(x.scale(y))
        }
        (Operation::Divide, Known(x), Known(y)) => Known(x / y),
        (Operation::Divide, Known(x), Full(y)) => Full(y.reciprocal_times(x)),
        (Operation::Divide, x, y) => Full(x.full() / y.full()),
        (Operation::Call(Function::Power), Known(x), Known(y)) => Known(x.powf(y)),
        (Operation::Call(Function::Power), Known(x), Full(y)) => Full(y.exp_with_base(x)),
        (Operation::Call(Function::Power), x, y) => Full(x.full().powf(y.full())),
        (Operation::Call(Function::Minimum), Known(x), Known(y)) => Known(minimum(x, y)),
        (Operation::Call(Function::Minimum), x, y) => Full(minimum(x.full(), y.full())),
        (Operation::Call(Function::Maximum), Known(x), Known(y)) => Known(-minimum(-x, -y)),
        (Operation::Call(Function::Maximum), x, y) => Full(-minimum(-x.full(), -y.full())),
        (_, x, _) => x,
    }
}

/// The smaller value, the first if they are equal; NaN on either side stays NaN.
#[inline]
fn minimum<R: Real>(x: R, y: R) -> R {
    let is_number = |x: R| x.equals(x.plain());
    let second = is_number(x).and(x.is_above(y.plain()).or(is_number(y).not()));
    R::choose(second, y, x)
}

#[inline]
fn call<R: Real>(function: Function, x: R) -> R {
    match function {
        Function::Sign => x.sign(),
        Function::Abs => x.abs(),
        Function::Exp => x.exp(),
        Function::Expm1 => x.expm1(),
        Function::Log => x.ln(),
        Function::Log10 => x.ln() * R::from_f64(core::f64::consts::LOG10_E),
        Function::Sqrt => x.sqrt(),
        Function::Cbrt => x.cbrt(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => {
            let (sin, cos) = x.sin_cos();
            sin / cos
        }
        Function::Atan => x.atan(),
        Function::Tanh => x.tanh(),
        Function::Power | Function::Minimum | Function::Maximum => x,
    }
}

/// `x^n` by squaring.
#[inline]
fn integer_power<R: Real>(x: R, n: i8) -> R {
    let mut left = n.unsigned_abs();
    let mut square = x;
    let mut power: Option<R> = None;
    while left > 0 {
        if left % 2 == 1 {
            power = Some(power.map_or(square, |power| power * square));
        }
        left /= 2;
        if left > 0 {
            square = square * square;
        }
    }
    let power = power.unwrap_or_else(R::one);
    if n < 0 { R::one() / power } else { power }
}
