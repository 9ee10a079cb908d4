use core::fmt;

use crate::dynamics::Memory;
use crate::error::ModelError;
use crate::table::Channel;

/// Why a model cannot be run over columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BatchError {
    /// The model itself.
    Model(ModelError<'static>),
    /// There is no row.
    NoRows,
    /// A column the model reads is missing.
    Missing(Channel),
    /// The model has a state or a delay but no time step was given.
    NoTimeStep,
    /// A column has another length than the velocity.
    Length {
        /// Which column.
        column: &'static str,
        /// Its length.
        length: usize,
        /// The velocity's length.
        rows: usize,
    },
    /// Rows to be summed do not fit together.
    Unequal {
        /// Which array.
        column: &'static str,
        /// Its rows.
        length: usize,
        /// The residual's rows.
        rows: usize,
    },
    /// A row's group does not exist.
    Group {
        /// Row, counted from 0.
        row: usize,
        /// Its group.
        group: u32,
        /// How many groups there are.
        groups: usize,
    },
    /// A run begins at a row that does not exist.
    Begin {
        /// Row, counted from 0.
        begin: usize,
        /// How many rows there are.
        rows: usize,
    },
    /// The sums of so many groups do not fit into memory.
    TooManyGroups(usize),
    /// A value is NaN or infinite.
    NotFinite {
        /// Which column.
        column: &'static str,
        /// Row, counted from 0.
        row: usize,
    },
    /// The state at the start is NaN or infinite.
    State,
    /// The state at the start has another size than the model's.
    StateLength {
        /// What the model's state consists of.
        memory: Memory,
        /// How many values were given.
        given: usize,
    },
    /// Temperatures on both sides of one at which the law has no limit.
    Pole {
        /// Id of the law.
        law: &'static str,
        /// That temperature (degC).
        pole: f64,
    },
    /// No motor torque balances a row.
    SelfLocking {
        /// Row, counted from 0.
        row: usize,
    },
    /// A wanted parameter does not exist.
    Wanted {
        /// Its index.
        index: usize,
        /// How many parameters there are.
        parameters: usize,
    },
    /// A parameter is wanted twice.
    WantedTwice(usize),
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
            Self::NoRows => f.write_str("the columns have no rows"),
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
                write!(f, "column '{column}' is not finite at row {row}")
            }
            Self::State => f.write_str("the state at the start is not finite"),
            Self::StateLength { memory: Memory::None, .. } => {
                f.write_str("the model has no memory: leave its state out")
            }
            Self::StateLength { memory, given } => {
                let (size, what) = match memory {
                    Memory::Deflection => (1, "the deflection of its bristle"),
                    _ => (memory.size(), "one force an element"),
                };
                write!(f, "values of the state: {given}, but the model takes {size}, {what}")
            }
            Self::Pole { law, pole } => write!(
                f,
                "law '{law}' has no limit at {pole} degC, which the temperatures touch or cross: \
                 use data on one side of it"
            ),
            Self::SelfLocking { row } => write!(
                f,
                "no motor torque moves the joint at row {row}: its friction grows as fast as the \
                 motor torque (self-locking); give the column 'motor_torque' or less friction per \
                 load"
            ),
            Self::Wanted { index, parameters } => {
                write!(f, "parameter {index} is wanted but the model has {parameters}, from 0")
            }
            Self::WantedTwice(index) => write!(f, "parameter {index} is wanted twice"),
        }
    }
}

impl core::error::Error for BatchError {}
