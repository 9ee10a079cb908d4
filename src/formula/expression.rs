//! Formulas over the parameters of a model: what a fit must hold.

use super::error::{FormulaError, Reason};
use super::law::{FormulaNames, Law};
use super::parser::{self, Builder};
use super::program::{MAX_DEPTH, MAX_PARAMETERS, Operation, Program};
use super::vocabulary::{self, Function, Word};
use crate::sample::Sample;
use crate::scalar::Dual;

/// A formula over parameters: `1.2*a4`, or a condition such as `static_friction >= a2`.
#[derive(Clone, Copy, Debug)]
pub struct Expression {
    program: Program,
    /// Whether it is a condition; its value is then the larger side minus the smaller one.
    is_condition: bool,
}

impl Expression {
    /// Parses a text in which every name is one of the parameters `known`.
    ///
    /// Returns the names that it uses, in the order of their first use.
    ///
    /// # Errors
    /// The text is not a formula or condition, or uses another name.
    pub fn parse<'a>(
        text: &'a str,
        known: &[&str],
    ) -> Result<(Self, FormulaNames<'a>), FormulaError<'a>> {
        let mut stated = Stated { law: Law::EMPTY, known, is_condition: false };
        parser::parse(text, &mut stated)?;
        let is_condition = stated.is_condition;
        let (program, names) = stated.law.finished(text)?;
        Ok((Self { program, is_condition }, names))
    }

    /// Whether it is a condition: its value must not be negative.
    #[must_use]
    pub fn is_condition(&self) -> bool {
        self.is_condition
    }

    /// Its value, and the derivatives by the parameters that it uses, in the order of the names.
    #[must_use]
    pub fn evaluate(&self, values: &[f64]) -> (f64, [f64; MAX_PARAMETERS]) {
        let mut parameters = [Dual::<f64, MAX_PARAMETERS>::constant(0.0); MAX_PARAMETERS];
        for (index, (own, &value)) in parameters.iter_mut().zip(values).enumerate() {
            *own = Dual::variable(value, index);
        }
        let all = 0..self.program.operations().len();
        let value = self.program.evaluate(&all, None, &parameters, &Sample::at(0.0));
        (value.value, value.derivative)
    }
}

/// An expression while its text is parsed.
struct Stated<'k, 'a> {
    law: Law<'a>,
    known: &'k [&'k str],
    is_condition: bool,
}

impl<'a> Stated<'_, 'a> {
    /// Nothing may follow a condition: it compares two values, and is not one.
    fn check_open(&self, word: &'a str) -> Result<(), Reason<'a>> {
        if self.is_condition { Err(Reason::Relation(word)) } else { Ok(()) }
    }
}

impl<'a> Builder<'a> for Stated<'_, 'a> {
    const DEPTH: usize = MAX_DEPTH;
    const CONDITIONS: bool = true;

    fn number(&mut self, number: f64, _at: usize) -> Result<(), Reason<'a>> {
        self.check_open(">=")?;
        self.law.constant(number)
    }

    fn name(&mut self, name: &'a str, _at: usize) -> Result<(), Reason<'a>> {
        self.check_open(">=")?;
        if self.known.contains(&name) {
            return self.law.known(name);
        }
        match vocabulary::word(name) {
            Word::Function(function) => Err(Reason::NotCalled(function)),
            Word::Pi => self.law.constant(core::f64::consts::PI),
            _ => Err(Reason::UnknownParameter(name)),
        }
    }

    fn operation(&mut self, operation: Operation, at: usize) -> Result<(), Reason<'a>> {
        self.check_open(">=")?;
        self.law.operation(operation, at)
    }

    fn call(&mut self, function: Function, given: usize, at: usize) -> Result<(), Reason<'a>> {
        self.check_open(">=")?;
        self.law.call(function, given, at)
    }

    fn condition(&mut self, word: &'a str, chained: bool, at: usize) -> Result<(), Reason<'a>> {
        if chained || !matches!(word, ">=" | "<=") {
            return Err(Reason::Relation(word));
        }
        self.operation(Operation::Subtract, at)?;
        if word == "<=" {
            self.law.operation(Operation::Negate, at)?;
        }
        self.is_condition = true;
        Ok(())
    }
}
