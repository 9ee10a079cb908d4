//! From a text to the program of a friction law.

use super::error::{FormulaError, Reason};
use super::parser::{self, Builder};
use super::program::{
    MAX_CONSTANTS, MAX_DEPTH, MAX_OPERATIONS, MAX_PARAMETERS, Operation, Program,
};
use super::vocabulary::{self, Function, Word};
use crate::sample::Sample;

/// The names of the parameters, in the order of their first use in the formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FormulaNames<'a> {
    names: [&'a str; MAX_PARAMETERS],
    count: usize,
}

impl<'a> FormulaNames<'a> {
    /// The names as a slice.
    #[must_use]
    pub fn as_slice(&self) -> &[&'a str] {
        self.names.get(..self.count).unwrap_or_default()
    }

    /// The index of a name, which is added if it is new; `None` if there are too many.
    fn index(&mut self, name: &'a str) -> Option<u8> {
        let known = self.as_slice().iter().position(|known| *known == name);
        let index = known.unwrap_or(self.count);
        *self.names.get_mut(index)? = name;
        self.count = self.count.max(index + 1);
        u8::try_from(index).ok()
    }
}

/// Parses a friction law.
pub(super) fn parse(text: &str) -> Result<(Program, FormulaNames<'_>), FormulaError<'_>> {
    let mut law = Law::EMPTY;
    parser::parse(text, &mut law)?;
    if law.names.count == 0 {
        return Err(FormulaError::at(text, 0, Reason::NoParameter));
    }
    law.finished(text)
}

/// A program while its text is parsed.
pub(super) struct Law<'a> {
    pub(super) program: Program,
    pub(super) names: FormulaNames<'a>,
}

impl Law<'_> {
    /// Before the text is parsed.
    pub(super) const EMPTY: Self = Self {
        program: Program::EMPTY,
        names: FormulaNames { names: [""; MAX_PARAMETERS], count: 0 },
    };
}

impl<'a> Builder<'a> for Law<'a> {
    const DEPTH: usize = MAX_DEPTH;
    const CONDITIONS: bool = false;

    fn number(&mut self, number: f64, _at: usize) -> Result<(), Reason<'a>> {
        self.constant(number)
    }

    fn name(&mut self, name: &'a str, at: usize) -> Result<(), Reason<'a>> {
        match vocabulary::word(name) {
            Word::Function(function) => Err(Reason::NotCalled(function)),
            Word::Channel(channel) => self.operation(Operation::Channel(channel), at),
            Word::Pi => self.constant(core::f64::consts::PI),
            Word::Other => self.parameter(name),
        }
    }

    /// Constant expressions are computed at once, and integer powers become multiplications.
    fn operation(&mut self, operation: Operation, _at: usize) -> Result<(), Reason<'a>> {
        if operation.arity() > 0 && self.all_numbers(operation.arity()) {
            return self.fold(operation);
        }
        if operation == Operation::Call(Function::Power)
            && let Some(n) = self.integer_exponent()
        {
            self.program.pop_constant();
            return self.push(Operation::IntegerPower(n));
        }
        self.push(operation)
    }

    fn call(&mut self, function: Function, given: usize, at: usize) -> Result<(), Reason<'a>> {
        // The smallest of three is that of one and the smallest of the other two.
        let times = if function.takes_more() { given.saturating_sub(1) } else { 1 };
        (0..times).try_for_each(|_| self.operation(Operation::Call(function), at))
    }
}

impl<'a> Law<'a> {
    /// The program of the whole text, and the names of its parameters.
    pub(super) fn finished<'t>(
        mut self,
        text: &'t str,
    ) -> Result<(Program, FormulaNames<'a>), FormulaError<'t>> {
        if self.program.depth() > MAX_DEPTH {
            let reason = Reason::TooLarge("values at a time", MAX_DEPTH);
            return Err(FormulaError::at(text, text.len(), reason));
        }
        self.program.parameter_count = self.names.count;
        Ok((self.program, self.names))
    }

    /// A known name of a parameter.
    pub(super) fn known(&mut self, name: &'a str) -> Result<(), Reason<'a>> {
        match self.names.index(name) {
            Some(index) => self.push(Operation::Parameter(index)),
            None => Err(Reason::TooLarge("parameters", MAX_PARAMETERS)),
        }
    }

    fn push(&mut self, operation: Operation) -> Result<(), Reason<'a>> {
        if self.program.push(operation) {
            return Ok(());
        }
        Err(Reason::TooLarge("operations", MAX_OPERATIONS))
    }

    fn parameter(&mut self, name: &'a str) -> Result<(), Reason<'a>> {
        let refusal = match name {
            "e" => Some(Reason::Ambiguous(name)),
            "t" | "time" => Some(Reason::Time(name)),
            _ => vocabulary::probably_meant(name).map(|near| Reason::Mistyped(name, near)),
        };
        match refusal {
            Some(reason) => Err(reason),
            None => self.known(name),
        }
    }

    pub(super) fn constant(&mut self, number: f64) -> Result<(), Reason<'a>> {
        if !number.is_finite() {
            return Err(Reason::NotFinite);
        }
        if self.program.push_constant(number) {
            return Ok(());
        }
        Err(Reason::TooLarge("numbers", MAX_CONSTANTS))
    }

    /// Replaces the constants that an operation works on by its result.
    fn fold(&mut self, operation: Operation) -> Result<(), Reason<'a>> {
        let first = self.program.operations().len() - operation.arity();
        let mut folded = self.program;
        folded.push(operation);
        let part = first..first + operation.arity() + 1;
        let unused = [0.0; MAX_PARAMETERS];
        let number = folded.evaluate(&part, None, &unused, &Sample::at(0.0));
        for _ in 0..operation.arity() {
            self.program.pop_constant();
        }
        self.constant(number)
    }

    fn all_numbers(&self, count: usize) -> bool {
        let last = self.program.operations().iter().rev().take(count);
        last.filter(|operation| matches!(operation, Operation::Constant(_))).count() == count
    }

    /// The constant exponent at the end of the program, if it is an integer of moderate size.
    #[allow(clippy::cast_possible_truncation)]
    fn integer_exponent(&self) -> Option<i8> {
        let mut program = self.program;
        let exponent = program.pop_constant()?;
        let whole = exponent as i8;
        (f64::from(whole) == exponent && whole.unsigned_abs() <= 64).then_some(whole)
    }
}
