//! From text to program: recursive descent that emits operations while it parses.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = ("+" | "-") unary | power
//! power   = value [ ("^" | "**") unary ]
//! value   = number | name | function bracket | bracket
//! ```

use super::error::{FormulaError, Reason};
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

/// Parses a text.
pub(super) fn parse(text: &str) -> Result<(Program, FormulaNames<'_>), FormulaError<'_>> {
    let mut parser = Parser {
        text,
        at: 0,
        token: Token { kind: Kind::End, start: 0, end: 0 },
        program: Program::EMPTY,
        names: FormulaNames { names: [""; MAX_PARAMETERS], count: 0 },
    };
    parser.advance()?;
    if parser.token.kind == Kind::End {
        return Err(parser.error_at(0, Reason::Empty));
    }
    parser.sum(0)?;
    match parser.token.kind {
        Kind::End => {}
        Kind::Close | Kind::Comma => {
            return Err(parser.error_here(Reason::Unopened(parser.word())));
        }
        _ => return Err(parser.error_here(Reason::NoOperator(parser.word()))),
    }
    if parser.names.count == 0 {
        return Err(parser.error_at(0, Reason::NoParameter));
    }
    if parser.program.depth() > MAX_DEPTH {
        return Err(parser.error_here(Reason::TooLarge("values at a time", MAX_DEPTH)));
    }
    parser.program.parameter_count = parser.names.count;
    Ok((parser.program, parser.names))
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Number(f64),
    Name,
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Open,
    Close,
    Comma,
    End,
}

#[derive(Clone, Copy)]
struct Token {
    kind: Kind,
    start: usize,
    end: usize,
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    token: Token,
    program: Program,
    names: FormulaNames<'a>,
}

impl<'a> Parser<'a> {
    fn sum(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.product(depth)?;
        while let Kind::Plus | Kind::Minus = self.token.kind {
            let operator = self.token;
            self.advance()?;
            self.product(depth)?;
            let minus = operator.kind == Kind::Minus;
            self.emit(if minus { Operation::Subtract } else { Operation::Add }, operator)?;
        }
        Ok(())
    }

    fn product(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.unary(depth)?;
        while let Kind::Times | Kind::Over = self.token.kind {
            let operator = self.token;
            self.advance()?;
            self.unary(depth)?;
            let over = operator.kind == Kind::Over;
            self.emit(if over { Operation::Divide } else { Operation::Multiply }, operator)?;
        }
        Ok(())
    }

    fn unary(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        let sign = self.token;
        if depth > MAX_DEPTH {
            return Err(self.error_here(Reason::TooLarge("nested brackets", MAX_DEPTH)));
        }
        match sign.kind {
            Kind::Minus => {
                self.advance()?;
                self.unary(depth + 1)?;
                self.emit(Operation::Negate, sign)
            }
            Kind::Plus => {
                self.advance()?;
                self.unary(depth + 1)
            }
            _ => self.power(depth),
        }
    }

    fn power(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.value(depth)?;
        if self.token.kind != Kind::Power {
            return Ok(());
        }
        let operator = self.token;
        self.advance()?;
        self.unary(depth + 1)?;
        self.emit(Operation::Call(Function::Power), operator)
    }

    fn value(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        let token = self.token;
        match token.kind {
            Kind::Number(number) => {
                self.advance()?;
                self.number(number, token)
            }
            Kind::Name => {
                self.advance()?;
                self.name(token, depth)
            }
            Kind::Open => self.bracket(depth).map(|_| ()),
            Kind::End => Err(self.error_here(Reason::Unfinished)),
            _ => Err(self.error_here(Reason::NoValue(self.word()))),
        }
    }

    fn name(&mut self, token: Token, depth: usize) -> Result<(), FormulaError<'a>> {
        let name = self.slice(token);
        let called = self.token.kind == Kind::Open;
        match vocabulary::word(name) {
            Word::Function(function) if called => {
                let given = self.bracket(depth)?;
                if given != function.arity() {
                    return Err(self.error_at(token.start, Reason::Arity(function, given)));
                }
                self.emit(Operation::Call(function), token)
            }
            Word::Function(function) => {
                Err(self.error_at(token.start, Reason::NotCalled(function)))
            }
            Word::Other if called => {
                let near = vocabulary::nearest_function(name);
                Err(self.error_at(token.start, Reason::UnknownFunction(name, near)))
            }
            Word::Channel(_) | Word::Pi if called => {
                Err(self.error_at(token.start, Reason::UnknownFunction(name, None)))
            }
            Word::Channel(channel) => self.emit(Operation::Channel(channel), token),
            Word::Pi => self.number(core::f64::consts::PI, token),
            Word::Other => self.parameter(name, token),
        }
    }

    fn parameter(&mut self, name: &'a str, token: Token) -> Result<(), FormulaError<'a>> {
        let refusal = match name {
            "e" => Some(Reason::Ambiguous(name)),
            "t" | "time" => Some(Reason::Time(name)),
            _ => vocabulary::probably_meant(name).map(|near| Reason::Mistyped(name, near)),
        };
        if let Some(reason) = refusal {
            return Err(self.error_at(token.start, reason));
        }
        match self.names.index(name) {
            Some(index) => self.emit(Operation::Parameter(index), token),
            None => Err(self.error_at(token.start, Reason::TooLarge("parameters", MAX_PARAMETERS))),
        }
    }

    /// Parses a bracket of comma-separated values; returns how many.
    fn bracket(&mut self, depth: usize) -> Result<usize, FormulaError<'a>> {
        let open = self.token;
        let closing = if self.word() == "[" { "]" } else { ")" };
        self.advance()?;
        let mut count = 0;
        loop {
            self.sum(depth + 1)?;
            count += 1;
            match self.token.kind {
                Kind::Comma => self.advance()?,
                Kind::Close if self.word() == closing => break,
                Kind::Close => return Err(self.error_here(Reason::Unopened(self.word()))),
                Kind::End => {
                    return Err(self.error_at(open.start, Reason::Unclosed(self.slice(open))));
                }
                _ => return Err(self.error_here(Reason::NoOperator(self.word()))),
            }
        }
        self.advance()?;
        Ok(count)
    }

    fn number(&mut self, number: f64, token: Token) -> Result<(), FormulaError<'a>> {
        if !number.is_finite() {
            return Err(self.error_at(token.start, Reason::NotFinite));
        }
        if self.program.push_constant(number) {
            return Ok(());
        }
        Err(self.error_at(token.start, Reason::TooLarge("numbers", MAX_CONSTANTS)))
    }

    /// Emits an operation. Constant expressions are computed at once, and integer powers become
    /// multiplications.
    fn emit(&mut self, operation: Operation, token: Token) -> Result<(), FormulaError<'a>> {
        let room = if operation.arity() > 0 && self.all_numbers(operation.arity()) {
            let first = self.program.operations().len() - operation.arity();
            let mut folded = self.program;
            folded.push(operation);
            let part = first..first + operation.arity() + 1;
            let unused = [0.0; MAX_PARAMETERS];
            let number = folded.evaluate(&part, None, &unused, &Sample::at(0.0));
            for _ in 0..operation.arity() {
                self.program.pop_constant();
            }
            return self.number(number, token);
        } else if operation == Operation::Call(Function::Power)
            && let Some(n) = self.integer_exponent()
        {
            self.program.pop_constant();
            self.program.push(Operation::IntegerPower(n))
        } else {
            self.program.push(operation)
        };
        if room {
            return Ok(());
        }
        Err(self.error_at(token.start, Reason::TooLarge("operations", MAX_OPERATIONS)))
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

    fn word(&self) -> &'a str {
        self.slice(self.token)
    }

    fn slice(&self, token: Token) -> &'a str {
        self.text.get(token.start..token.end).unwrap_or_default()
    }

    fn error_here(&self, reason: Reason<'a>) -> FormulaError<'a> {
        self.error_at(self.token.start, reason)
    }

    fn error_at(&self, byte: usize, reason: Reason<'a>) -> FormulaError<'a> {
        let before = self.text.get(..byte).unwrap_or_default();
        FormulaError { position: before.chars().count() + 1, reason }
    }

    /// Reads the next token.
    fn advance(&mut self) -> Result<(), FormulaError<'a>> {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let blank = rest.len() - rest.trim_start().len();
        let rest = rest.trim_start();
        let start = self.at + blank;
        let Some(first) = rest.chars().next() else {
            self.token = Token { kind: Kind::End, start, end: start };
            return Ok(());
        };
        let (kind, length) = match first {
            '+' => (Kind::Plus, 1),
            '-' => (Kind::Minus, 1),
            '*' if rest.starts_with("**") => (Kind::Power, 2),
            '*' => (Kind::Times, 1),
            '/' => (Kind::Over, 1),
            '^' => (Kind::Power, 1),
            '(' | '[' => (Kind::Open, 1),
            ')' | ']' => (Kind::Close, 1),
            ',' => (Kind::Comma, 1),
            '0'..='9' | '.' => {
                let length = number_length(rest);
                let digits = rest.get(..length).unwrap_or_default();
                match digits.parse() {
                    Ok(number) => (Kind::Number(number), length),
                    Err(_) => return Err(self.error_at(start, Reason::Number(digits))),
                }
            }
            'a'..='z' | 'A'..='Z' | '_' => {
                let inside = |c: char| c.is_ascii_alphanumeric() || c == '_';
                (Kind::Name, rest.find(|c| !inside(c)).unwrap_or(rest.len()))
            }
            other => return Err(self.error_at(start, Reason::Character(other))),
        };
        self.token = Token { kind, start, end: start + length };
        self.at = start + length;
        Ok(())
    }
}

/// The length of a number in bytes: digits, a point, an exponent with its sign.
fn number_length(text: &str) -> usize {
    let mut before = ' ';
    for (at, c) in text.char_indices() {
        let exponent = matches!(before, 'e' | 'E') && matches!(c, '+' | '-');
        if !(c.is_ascii_alphanumeric() || c == '.' || exponent) {
            return at;
        }
        before = c;
    }
    text.len()
}
