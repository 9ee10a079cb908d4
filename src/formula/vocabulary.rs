//! The names that a formula can use: channels, functions, constants.

use crate::table::Channel;

/// A function of one or two arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Function {
    Sign,
    Abs,
    Exp,
    Expm1,
    Log,
    Log10,
    Sqrt,
    Cbrt,
    Sin,
    Cos,
    Tan,
    Atan,
    Tanh,
    Power,
    Minimum,
    Maximum,
}

impl Function {
    /// Number of arguments; the least number where more are allowed.
    #[must_use]
    pub const fn arity(self) -> usize {
        match self {
            Self::Power | Self::Minimum | Self::Maximum => 2,
            _ => 1,
        }
    }

    /// Whether it takes any larger number of arguments too.
    #[must_use]
    pub const fn takes_more(self) -> bool {
        matches!(self, Self::Minimum | Self::Maximum)
    }

    /// The name in programs and messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        FUNCTIONS.iter().find(|(_, function)| *function == self).map_or("", |(name, _)| name)
    }
}

/// Functions by name; the first name of each function is the one in messages.
pub(crate) const FUNCTIONS: [(&str, Function); 20] = [
    ("sgn", Function::Sign),
    ("sign", Function::Sign),
    ("abs", Function::Abs),
    ("exp", Function::Exp),
    ("expm1", Function::Expm1),
    ("log", Function::Log),
    ("ln", Function::Log),
    ("log10", Function::Log10),
    ("sqrt", Function::Sqrt),
    ("cbrt", Function::Cbrt),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("atan", Function::Atan),
    ("arctan", Function::Atan),
    ("tanh", Function::Tanh),
    ("pow", Function::Power),
    ("min", Function::Minimum),
    ("max", Function::Maximum),
    ("power", Function::Power),
];

/// A function of whole columns. A friction law has none: it knows one sample at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ColumnFunction {
    pub(crate) name: &'static str,
    /// Number of arguments; the least number where more are allowed.
    pub(crate) arity: usize,
    pub(crate) takes_more: bool,
}

impl ColumnFunction {
    const fn new(name: &'static str, arity: usize, takes_more: bool) -> Self {
        Self { name, arity, takes_more }
    }

    /// The function of a name.
    pub(super) fn named(name: &str) -> Option<&'static Self> {
        COLUMN_FUNCTIONS.iter().find(|function| function.name == name)
    }
}

/// Derivative by time, mean of all samples, choice by a condition, and interpolation in a table.
pub(crate) static COLUMN_FUNCTIONS: [ColumnFunction; 4] = [
    ColumnFunction::new("diff", 1, false),
    ColumnFunction::new("mean", 1, false),
    ColumnFunction::new("where", 3, false),
    ColumnFunction::new("interp", 5, true),
];

/// Channels by name; `load` is short for `load_torque`.
const CHANNELS: [(&str, Channel); 15] = [
    ("v", Channel::Velocity),
    ("velocity", Channel::Velocity),
    ("q", Channel::Position),
    ("position", Channel::Position),
    ("a", Channel::Acceleration),
    ("acceleration", Channel::Acceleration),
    ("T", Channel::Temperature),
    ("temperature", Channel::Temperature),
    ("tl", Channel::LoadTorque),
    ("load", Channel::LoadTorque),
    ("load_torque", Channel::LoadTorque),
    ("tm", Channel::MotorTorque),
    ("motor_torque", Channel::MotorTorque),
    ("te", Channel::ExternalTorque),
    ("external_torque", Channel::ExternalTorque),
];

/// The meaning of a name.
pub(super) enum Word {
    Channel(Channel),
    Function(Function),
    Pi,
    /// A parameter, or a misspelt name.
    Other,
}

pub(super) fn word(name: &str) -> Word {
    if name == "pi" {
        return Word::Pi;
    }
    let channel = CHANNELS.iter().find(|(word, _)| *word == name);
    let function = FUNCTIONS.iter().find(|(word, _)| *word == name);
    match (channel, function) {
        (Some(&(_, channel)), _) => Word::Channel(channel),
        (_, Some(&(_, function))) => Word::Function(function),
        _ => Word::Other,
    }
}

/// The function with the most similar name.
pub(super) fn nearest_function(name: &str) -> Option<&'static str> {
    nearest(name, FUNCTIONS.iter().map(|(word, _)| *word), name.len() / 2)
}

/// The channel, function or constant that was probably meant: its name differs by case only, or is
/// long and differs by one or two letters. Single letters are never considered misspelt.
pub(super) fn probably_meant(name: &str) -> Option<&'static str> {
    if name.len() < 2 {
        return None;
    }
    let words = || CHANNELS.iter().map(|(word, _)| *word).chain(FUNCTIONS.iter().map(|w| w.0));
    let same = words().chain(["pi"]).find(|word| word.eq_ignore_ascii_case(name));
    if same.is_some() || name.len() < 4 {
        return same;
    }
    let most = if name.len() < 7 { 1 } else { 2 };
    nearest(name, words().filter(|word| word.len() >= 4), most)
}

fn nearest(
    name: &str,
    words: impl Iterator<Item = &'static str>,
    most: usize,
) -> Option<&'static str> {
    let measured = words.filter_map(|word| Some((distance(name, word)?, word)));
    measured.filter(|(d, _)| *d <= most).min_by_key(|(d, _)| *d).map(|(_, word)| word)
}

/// The longest name that is compared.
const LONGEST: usize = 24;

/// Number of letters to insert, delete, replace or exchange with the next (Damerau 1964, each
/// letter edited once); `None` if a name is too long.
fn distance(a: &str, b: &str) -> Option<usize> {
    if a.len() > LONGEST || b.len() > LONGEST {
        return None;
    }
    let mut before = [0; LONGEST + 1];
    let mut last: [usize; LONGEST + 1] = core::array::from_fn(|j| j);
    let mut previous = None;
    for (i, x) in a.bytes().enumerate() {
        let mut row = [i + 1; LONGEST + 1];
        let mut beside = None;
        for (j, y) in b.bytes().enumerate() {
            let replaced = last[j] + usize::from(x != y);
            let mut least = replaced.min(row[j] + 1).min(last[j + 1] + 1);
            if beside == Some(x) && previous == Some(y) && j > 0 {
                least = least.min(before[j - 1] + 1);
            }
            row[j + 1] = least;
            beside = Some(y);
        }
        before = last;
        last = row;
        previous = Some(x);
    }
    last.get(b.len()).copied()
}
