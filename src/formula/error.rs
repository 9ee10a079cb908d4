//! What is wrong with a formula, and where.

use core::fmt;

use super::vocabulary::Function;

/// Why a text is not a formula, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FormulaError<'a> {
    /// Position of the character, counted from 1.
    pub position: usize,
    /// The reason.
    pub(super) reason: Reason<'a>,
}

/// The reasons why a text is not a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reason<'a> {
    /// The text is empty or blank.
    Empty,
    /// Every name is a channel, so there is nothing to identify.
    NoParameter,
    /// A character that is not allowed in a formula.
    Character(char),
    /// Digits that do not form a number.
    Number(&'a str),
    /// An operator, bracket or comma where a value is needed.
    NoValue(&'a str),
    /// The text ends where a value is needed.
    Unfinished,
    /// Two values without an operator between them.
    NoOperator(&'a str),
    /// An opening bracket without a closing one.
    Unclosed(&'a str),
    /// An opening quote without a closing one.
    Unquoted(char),
    /// A closing bracket without an opening one of its kind.
    Unopened(&'a str),
    /// A name before a bracket that is not a function, and the function with the most similar name.
    UnknownFunction(&'a str, Option<&'static str>),
    /// A name that looks like a misspelt channel or function.
    Mistyped(&'a str, &'static str),
    /// `e` could be Euler's number or a parameter.
    Ambiguous(&'a str),
    /// Time, which a friction law cannot depend on.
    Time(&'a str),
    /// A function without its arguments.
    NotCalled(Function),
    /// A name that is none of the known parameters.
    UnknownParameter(&'a str),
    /// A comparison where none can stand, or of another kind.
    Relation(&'a str),
    /// A function of columns in a formula that has none.
    OfColumns(&'a str),
    /// A function with too few or too many arguments: its name, the number that it needs, whether
    /// it takes more, and the number that was given.
    Arity(&'static str, usize, bool, usize),
    /// A constant expression that is infinite or NaN.
    NotFinite,
    /// An operator that is spelt otherwise, and how.
    Spelling(&'static str, &'static str),
    /// The formula is too long.
    TooLarge(&'static str, usize),
}

impl<'a> FormulaError<'a> {
    /// What is wrong at a byte of a text.
    pub(super) fn at(text: &str, byte: usize, reason: Reason<'a>) -> Self {
        let before = text.get(..byte).unwrap_or_default();
        Self { position: before.chars().count() + 1, reason }
    }
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
            Reason::Character(c) => write!(f, "'{c}' is not allowed in a formula,"),
            Reason::Number(text) => write!(f, "'{text}' is not a number,"),
            Reason::NoValue(text) => write!(f, "a value is missing before '{text}'"),
            Reason::Unfinished => f.write_str("a value is missing at the end,"),
            Reason::NoOperator(text) => write!(f, "an operator is missing before '{text}'"),
            Reason::Unclosed(text) => write!(f, "the bracket '{text}' is never closed,"),
            Reason::Unquoted(quote) => write!(f, "the quote {quote} is never closed,"),
            Reason::Unopened(text) => write!(f, "'{text}' has no opening bracket,"),
            Reason::UnknownFunction(name, None) => write!(f, "'{name}' is not a function,"),
            Reason::UnknownFunction(name, Some(near)) => {
                write!(f, "'{name}' is not a function (did you mean '{near}'?),")
            }
            Reason::Mistyped(name, near) => write!(
                f,
                "'{name}' is unknown (did you mean '{near}'? if it is a parameter, give it \
                 a more distinct name),"
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
            Reason::UnknownParameter(name) => write!(f, "'{name}' is not a parameter,"),
            Reason::Relation(text) => {
                write!(f, "'{text}' cannot stand here (write one LEFT >= RIGHT or LEFT <= RIGHT),")
            }
            Reason::OfColumns(name) => {
                write!(f, "'{name}' is a function of columns alone (of a derived channel),")
            }
            Reason::Arity(name, needed, takes_more, given) => {
                let values = match needed {
                    1 => "argument",
                    _ if takes_more => "or more arguments",
                    _ => "arguments",
                };
                write!(f, "{name} takes {needed} {values}, not {given},")
            }
            Reason::NotFinite => f.write_str("the result is not a finite number,"),
            Reason::Spelling(text, right) => {
                write!(f, "'{text}' is not an operator (write '{right}'),")
            }
            Reason::TooLarge(what, most) => {
                write!(f, "the formula is too long (at most {most} {what}),")
            }
        }?;
        write!(f, " at position {}", self.position)
    }
}

impl core::error::Error for FormulaError<'_> {}
