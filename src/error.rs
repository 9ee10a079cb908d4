//! Errors of models. Each message is one sentence that names the object and the alternatives.

use core::fmt;

use crate::catalog::{EffectId, LawId};
use crate::constants::CONSTANTS;
use crate::formula::FormulaError;

/// Why a model cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ModelError<'a> {
    /// There is no law with this id.
    UnknownLaw(&'a str),
    /// There is no effect with this id.
    UnknownEffect(&'a str),
    /// The effect is named twice.
    Twice(EffectId),
    /// The law already includes this effect.
    Captured(LawId, EffectId),
    /// There is no constant with this name.
    UnknownConstant(&'a str),
    /// The value of the constant is inadmissible.
    Constant(&'a str, f64),
    /// The number of parameter values is wrong.
    Count {
        /// Number of parameters of the model.
        expected: usize,
        /// Number of values given.
        given: usize,
    },
    /// A formula term cannot be used.
    Formula(FormulaError<'a>),
    /// The model cannot be evaluated at this value.
    Value {
        /// The parameter.
        parameter: &'static str,
        /// The value.
        value: f64,
    },
}

fn list(f: &mut fmt::Formatter<'_>, names: impl Iterator<Item = &'static str>) -> fmt::Result {
    for (i, name) in names.enumerate() {
        f.write_str(if i == 0 { "" } else { ", " })?;
        f.write_str(name)?;
    }
    Ok(())
}

impl fmt::Display for ModelError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::UnknownLaw(id) => {
                write!(f, "law '{id}' is unknown; laws are ")?;
                list(f, LawId::ALL.iter().map(|law| law.info().id))
            }
            Self::UnknownEffect(id) => {
                write!(f, "effect '{id}' is unknown; effects are ")?;
                list(f, EffectId::ALL.iter().map(|effect| effect.info().id))
            }
            Self::Twice(effect) => write!(f, "effect '{}' is named twice", effect.info().id),
            Self::Captured(law, effect) => {
                write!(f, "law '{}' already has the effect '{}'", law.info().id, effect.info().id)
            }
            Self::UnknownConstant(name) => {
                write!(f, "constant '{name}' is unknown; constants are ")?;
                list(f, CONSTANTS.iter().map(|constant| constant.name))
            }
            Self::Constant(name, value) => write!(f, "constant '{name}' cannot be {value}"),
            Self::Count { expected, given } => {
                write!(f, "the model has {expected} parameters but {given} values were given")
            }
            Self::Formula(error) => error.fmt(f),
            Self::Value { parameter, value } => {
                let admissible =
                    if value.is_finite() { "a number above 0" } else { "a finite number" };
                write!(f, "parameter '{parameter}' cannot be {value}; give {admissible}")
            }
        }
    }
}

impl core::error::Error for ModelError<'_> {}

impl<'a> From<FormulaError<'a>> for ModelError<'a> {
    fn from(error: FormulaError<'a>) -> Self {
        Self::Formula(error)
    }
}
