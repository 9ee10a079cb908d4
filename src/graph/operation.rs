//! The operations of a graph.

use std::vec;
use std::vec::Vec;

/// A node of a graph: nodes are in an order in which they can be computed.
pub type Id = usize;

/// What a node computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A number, by its bits.
    Constant(u64),
    /// A parameter: the same in all rows.
    Parameter(usize),
    /// A column.
    Column(usize),
    /// Of one number.
    Unary(Unary, Id),
    /// Of two numbers.
    Binary(Binary, Id, Id),
    /// The second where the first holds, else the third. A mask is 1 where it holds, else 0.
    Choose(Id, Id, Id),
    /// The number of the row before; of the row itself where a segment starts.
    Previous(Id),
    /// A state `z` at the end of each row, from where a segment starts on.
    Relax(Relaxing),
    /// The state of a node before its row: a state that starts as that one, and moves as it.
    Before(Id, Id, Start),
}

/// `(z + extra) + share (target - z) + shift`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Relaxing {
    /// Share of the way that is gone.
    pub share: Id,
    /// Where it goes.
    pub target: Id,
    /// What comes to that.
    pub extra: Id,
    /// What comes at the end.
    pub shift: Id,
    /// Where a segment starts that has settled.
    pub settled: Id,
    /// Where other segments start.
    pub start: Start,
}

/// What a state is where a segment starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Start {
    /// What is given.
    Given,
    /// 0: a derivative, of what is given.
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
    /// A slope times a derivative, 0 where the latter is 0 even if the slope is infinite.
    Chain,
}

impl Operation {
    /// The nodes that it takes its numbers from.
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

    /// The same of other nodes and columns.
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

    /// Whether it depends on rows before, whatever it takes.
    #[must_use]
    pub const fn has_memory(self) -> bool {
        matches!(self, Self::Previous(_) | Self::Relax(_) | Self::Before(..))
    }
}
