//! The operations of a graph.

use std::vec;
use std::vec::Vec;

/// A node of a graph. The operands of a node have smaller ids.
pub type Id = usize;

/// The operation that a node computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A number, by its bits.
    Constant(u64),
    /// A parameter: the same for all samples.
    Parameter(usize),
    /// A column of the recording.
    Column(usize),
    /// An operation on one number.
    Unary(Unary, Id),
    /// An operation on two numbers.
    Binary(Binary, Id, Id),
    /// The second operand where the first is not 0, else the third. A mask is 1 (true) or 0
    /// (false).
    Choose(Id, Id, Id),
    /// The value at the previous sample; at the start of a segment that of the sample itself.
    Previous(Id),
    /// A state `z` at the end of each sample interval.
    Relax(Relaxing),
    /// The value of a state before each sample: of the state, of its settled value, with its start.
    Before(Id, Id, Start),
}

/// `(z + extra) + share (target - z) + shift`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Relaxing {
    /// The share of the distance to the target that is covered in one interval.
    pub share: Id,
    /// The target.
    pub target: Id,
    /// Added to the state before it relaxes, without influence on the distance.
    pub extra: Id,
    /// Added at the end.
    pub shift: Id,
    /// The state at the start of a segment that begins settled.
    pub settled: Id,
    /// The state at the start of any other segment.
    pub start: Start,
}

/// The state at the start of a segment that does not begin settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Start {
    /// The given start.
    Given,
    /// 0: for states of effects, and for derivatives with respect to parameters.
    Zero,
}

/// An operation on one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Unary {
    Negate,
    Abs,
    Sign,
    Exp,
    Expm1,
    Ln,
    Sqrt,
    Cbrt,
    Sin,
    Cos,
    Tanh,
    Atan,
    /// `phi_k`.
    Phi(u8),
    IsFinite,
    Not,
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Below,
    Above,
    Equal,
    And,
    Or,
    /// A slope times a derivative: 0 where either is 0, even if the other is infinite.
    Chain,
}

impl Operation {
    /// The nodes that it reads.
    #[must_use]
    pub fn operands(self) -> Vec<Id> {
        match self {
            Self::Constant(_) | Self::Parameter(_) | Self::Column(_) => vec![],
            Self::Unary(_, x) | Self::Previous(x) => vec![x],
            Self::Binary(_, x, y) | Self::Before(x, y, _) => vec![x, y],
            Self::Choose(x, y, z) => vec![x, y, z],
            Self::Relax(Relaxing { share, target, extra, shift, settled, .. }) => {
                vec![share, target, extra, shift, settled]
            }
        }
    }

    /// The same operation on other nodes and columns.
    #[must_use]
    pub fn moved(self, node: impl Fn(Id) -> Id, column: impl Fn(usize) -> usize) -> Self {
        match self {
            Self::Constant(_) | Self::Parameter(_) => self,
            Self::Column(own) => Self::Column(column(own)),
            Self::Unary(operation, x) => Self::Unary(operation, node(x)),
            Self::Binary(operation, x, y) => Self::Binary(operation, node(x), node(y)),
            Self::Choose(x, y, z) => Self::Choose(node(x), node(y), node(z)),
            Self::Previous(x) => Self::Previous(node(x)),
            Self::Relax(own) => Self::Relax(Relaxing {
                share: node(own.share),
                target: node(own.target),
                extra: node(own.extra),
                shift: node(own.shift),
                settled: node(own.settled),
                ..own
            }),
            Self::Before(x, y, start) => Self::Before(node(x), node(y), start),
        }
    }

    /// Whether its value differs from sample to sample even if its operands do not.
    #[must_use]
    pub const fn is_by_row(self) -> bool {
        matches!(self, Self::Column(_)) || self.has_memory()
    }

    /// Whether its value depends on previous samples even if its operands do not.
    #[must_use]
    pub const fn has_memory(self) -> bool {
        matches!(self, Self::Previous(_) | Self::Relax(_) | Self::Before(..))
    }
}
