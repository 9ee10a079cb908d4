//! Errors of evaluating a model over columns.

use core::fmt;

use crate::dynamics::Memory;
use crate::error::ModelError;
use crate::table::Channel;

/// Why a model cannot be evaluated over columns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BatchError {
    /// The model itself cannot be used.
    Model(ModelError<'static>),
    /// There are no samples.
    NoRows,
    /// A column the model reads is missing.
    Missing(Channel),
    /// The model has a state or a delay but no time step was given.
    NoTimeStep,
    /// A column and the velocity have different lengths.
    Length {
        /// The column.
        column: &'static str,
        /// Its length.
        length: usize,
        /// The velocity's length.
        rows: usize,
    },
    /// Arrays of a least-squares problem have different numbers of rows.
    Unequal {
        /// The array.
        column: &'static str,
        /// Its number of rows.
        length: usize,
        /// The number of rows of the residual.
        rows: usize,
    },
    /// The group of a sample does not exist.
    Group {
        /// Sample, counted from 0.
        row: usize,
        /// Its group.
        group: u32,
        /// Number of groups.
        groups: usize,
    },
    /// A run begins at a sample that does not exist.
    Begin {
        /// Sample, counted from 0.
        begin: usize,
        /// Number of samples.
        rows: usize,
    },
    /// The sums of this many groups do not fit into memory.
    TooManyGroups(usize),
    /// A value is NaN or infinite.
    NotFinite {
        /// The column.
        column: &'static str,
        /// Sample, counted from 0.
        row: usize,
    },
    /// The initial state is NaN or infinite.
    State,
    /// The initial state has the wrong size.
    StateLength {
        /// The kind of the model's state.
        memory: Memory,
        /// Number of values given.
        given: usize,
    },
    /// There are temperatures on both sides of the one at which the law is singular.
    Pole {
        /// Id of the law.
        law: &'static str,
        /// That temperature (degC).
        pole: f64,
    },
    /// No motor torque balances a sample.
    SelfLocking {
        /// Sample, counted from 0.
        row: usize,
    },
    /// A requested derivative has an index that does not exist.
    Wanted {
        /// Its index.
        index: usize,
        /// Number of parameters.
        parameters: usize,
    },
    /// A derivative is requested twice.
    WantedTwice(usize),
    /// Memory for results has the wrong size.
    Output {
        /// Its length.
        length: usize,
        /// The length that it must have.
        expected: usize,
    },
}

impl From<ModelError<'static>> for BatchError {
    fn from(error: ModelError<'static>) -> Self {
        Self::Model(error)
    }
}

impl fmt::Display for BatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Model(error) => error.fmt(f),
            Self::NoRows => f.write_str("the columns have no samples"),
            Self::Missing(channel) => write!(f, "the model needs the column '{channel}'"),
            Self::NoTimeStep => f.write_str("the model needs the time step 'dt'"),
            Self::Length { column, length, rows } => {
                write!(f, "column '{column}' has {length} rows but 'velocity' has {rows}")
            }
            Self::Unequal { column, length, rows } => {
                write!(f, "'{column}' has {length} rows but 'residual' has {rows}")
            }
            Self::Group { row, group, groups } => {
                write!(f, "row {row} is in group {group} but there are {groups} groups")
            }
            Self::Begin { begin, rows } => {
                write!(f, "a run begins at row {begin} but there are {rows} rows, from 0")
            }
            Self::TooManyGroups(groups) => {
                write!(f, "the sums of {groups} groups do not fit into memory")
            }
            Self::NotFinite { column, row } => {
                write!(f, "column '{column}' is not finite at sample {row}")
            }
            Self::State => f.write_str("the initial state is not finite"),
            Self::StateLength { memory: Memory::None, .. } => {
                f.write_str("the model has no memory: leave its state out")
            }
            Self::StateLength { memory, given } => {
                let (size, what) = match memory {
                    Memory::Deflection => (1, "the deflection of its bristle"),
                    _ => (memory.size(), "one force per element"),
                };
                write!(f, "the initial state has {given} values but the model needs {size}, {what}")
            }
            Self::Pole { law, pole } => write!(
                f,
                "law '{law}' is singular at {pole} degC, which the temperatures touch or cross: \
                 use data on one side of it"
            ),
            Self::SelfLocking { row } => write!(
                f,
                "no motor torque moves the joint at sample {row}: its friction grows as fast as the \
                 motor torque (self-locking); give the column 'motor_torque' or less friction per \
                 load"
            ),
            Self::Wanted { index, parameters } => {
                write!(
                    f,
                    "the derivative with respect to parameter {index} is requested but the model has {parameters}, from 0"
                )
            }
            Self::WantedTwice(index) => {
                write!(f, "the derivative with respect to parameter {index} is requested twice")
            }
            Self::Output { length, expected } => {
                write!(f, "the results are {expected} numbers, but there is room for {length}")
            }
        }
    }
}

impl core::error::Error for BatchError {}
