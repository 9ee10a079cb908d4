//! One step of a model as a list of operations, from which controller code is generated.
//!
//! The model is stepped once with numbers that record their operations. Every law, every
//! combination of effects and every formula is therefore exported from its own code, without a
//! second implementation.

mod program;

pub use crate::graph::{Binary, Operation, Unary};
pub use program::{Input, Program};
