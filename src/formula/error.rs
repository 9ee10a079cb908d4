use core::fmt;

use super::vocabulary::Function;

/// Why a text is not a formula, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormulaError<'a> {
    /// Character of the text, counted from 1.
    pub position: usize,
    /// What is wrong there.
    pub reason: Reason<'a>,
}

/// What can be wrong with a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason<'a> {
    /// Nothing but blanks.
    Empty,
    /// Every name is a channel: nothing to identify.
    NoParameter,
    /// A character that no formula holds.
    Character(char),
    /// Digits that are no number.
    Number(&'a str),
    /// An operator, bracket or comma stands where a value is needed.
    NoValue(&'a str),
    /// The text ends where a value is needed.
    Unfinished,
    /// Two values follow each other.
    NoOperator(&'a str),
    /// A bracket is opened and never closed.
    Unclosed(&'a str),
    /// A bracket is closed that was not opened, or not by this kind.
    Unopened(&'a str),
    /// A name with a bracket behind it is no function.
    UnknownFunction(&'a str, Option<&'static str>),
    /// A name that looks like a mistyped channel or function.
    Mistyped(&'a str, &'static str),
    /// `e`: Euler's number, or a parameter?
    Ambiguous(&'a str),
    /// A quantity that a law of friction cannot depend on.
    Time(&'a str),
    /// A function without brackets.
    NotCalled(Function),
    /// A function with too few or too many values.
    Arity(Function, usize),
    /// Numbers alone that make infinity or nothing at all.
    NotFinite,
    /// The program would be larger than a formula can be.
    TooLarge(&'static str, usize),
}

impl fmt::Display for FormulaError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.reason {
            Reason::Empty => return f.write_str("the formula is empty"),
            Reason::NoParameter => {
                return f.write_str(
                    "the formula has no parameter to identify: every name in it is a channel",
                );
            }
            Reason::Character(c) => write!(f, "'{c}' means nothing in a formula,"),
            Reason::Number(text) => write!(f, "'{text}' is not a number,"),
            Reason::NoValue(text) => write!(f, "a value is missing before '{text}'"),
            Reason::Unfinished => f.write_str("a value is missing at the end,"),
            Reason::NoOperator(text) => write!(f, "an operator is missing before '{text}'"),
            Reason::Unclosed(text) => write!(f, "the bracket '{text}' is never closed,"),
            Reason::Unopened(text) => write!(f, "'{text}' closes no bracket,"),
            Reason::UnknownFunction(name, None) => write!(f, "'{name}' is not a function,"),
            Reason::UnknownFunction(name, Some(near)) => {
                write!(f, "'{name}' is not a function (did you mean '{near}'?),")
            }
            Reason::Mistyped(name, near) => write!(
                f,
                "'{name}' is unknown (did you mean '{near}'? a parameter needs a name that is \
                 less like it),"
            ),
            Reason::Ambiguous(name) => write!(
                f,
                "'{name}' could be Euler's number or a parameter (write exp(1), or give the \
                 parameter another name),"
            ),
            Reason::Time(name) => write!(
                f,
                "'{name}' is not a channel: friction depends on v, q, a, T, tl, tm or te, not on \
                 time,"
            ),
            Reason::NotCalled(function) => {
                let name = function.name();
                write!(f, "'{name}' is a function (write {name}(...)),")
            }
            Reason::Arity(function, given) => {
                let (name, needed) = (function.name(), function.arity());
                let values = if needed == 1 { "value" } else { "values" };
                write!(f, "{name} takes {needed} {values}, not {given},")
            }
            Reason::NotFinite => f.write_str("this makes no finite number,"),
            Reason::TooLarge(what, most) => {
                write!(f, "the formula is too long (at most {most} {what}),")
            }
        }?;
        write!(f, " at position {}", self.position)
    }
}

impl core::error::Error for FormulaError<'_> {}
