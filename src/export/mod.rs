//! A step of a model as a list of operations: what a controller's program is printed from.
//!
//! The model is stepped once, in numbers that write down what is done to them. So every law, every
//! composition of effects and every formula of a user is exported by its own code, and nothing is
//! stated twice.

mod program;

pub use crate::graph::{Binary, Operation, Unary};
pub use program::{Input, Program, StateNumber};
