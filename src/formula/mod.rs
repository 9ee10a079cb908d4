//! Friction terms given as text: `c1*v + c2*tanh(v/c3)*abs(load)`.
//!
//! The text is parsed into a [`Formula`], a program of fixed size that only computes; no text is
//! executed as code. Every name that is not a channel, a function or `pi` is a parameter. The same
//! program runs on `f32`, `f64` and dual numbers.
//!
//! | module | content |
//! |---|---|
//! | [`vocabulary`](Function) | names of channels, functions and constants |
//! | `tokens`, `parser` | the grammar, of laws and of formulas over the columns of a recording |
//! | `law` | from text to program |
//! | `expression` | formulas over parameters, and conditions on them |
//! | [`program`](Operation) | operations in postfix order, and their evaluation |
//! | [`terms`](TermKind) | terms: dry, rate-dependent or additive |
//! | `linear` | the parameters in which the torque is linear |
//!
//! ```
//! use stribeck::{Formula, FormulaError, Sample, Spec};
//!
//! let (formula, names) = Formula::parse("c1*v + c2*tanh(v/c3)*abs(load)")?;
//! assert_eq!(names.as_slice(), ["c1", "c2", "c3"]);
//! let model = Spec::by_formula(&formula, [])?.with(&[2.0, 0.5, 1e-3])?;
//! let sample = Sample { load_torque: -4.0, ..Sample::at(0.25) };
//! assert_eq!(model.static_torque(&sample), 2.5);
//! # Ok::<(), stribeck::ModelError>(())
//! ```

mod error;
mod expression;
mod law;
mod linear;
mod parser;
mod program;
mod terms;
mod tokens;
mod vocabulary;

#[cfg(test)]
mod tests;

pub use error::FormulaError;
#[cfg(feature = "python")]
pub(crate) use error::Reason;
pub use expression::Expression;
pub use law::FormulaNames;
#[cfg(feature = "python")]
pub(crate) use parser::{Builder, parse};
#[cfg(feature = "python")]
pub(crate) use program::Operation;
pub use terms::Formula;
pub(crate) use terms::FormulaTerms;
#[cfg(feature = "python")]
pub(crate) use terms::Term;
#[cfg(feature = "std")]
pub(crate) use terms::TermKind;
#[cfg(feature = "python")]
pub(crate) use vocabulary::{COLUMN_FUNCTIONS, ColumnFunction, FUNCTIONS, Function};
