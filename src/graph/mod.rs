//! What a law computes, written down once as a graph and then carried out on many rows.
//!
//! A model that is evaluated in [`Recorded`] numbers leaves its operations in a [`Recorder`]. The
//! graph is differentiated symbolically ([`derivative`]), so that only derivatives that exist are
//! carried, ordered ([`Schedule`]), and run operation by operation over blocks of rows that stay in
//! the first cache ([`run`]): each operation is a loop that the compiler turns into vector
//! instructions. Every number has the bits that it has alone: nothing is fused or reordered.

mod block;
mod derivative;
mod model;
mod numbers;
mod operation;
mod recorded;
mod recorder;
mod run;
mod schedule;

pub use derivative::derivatives;
pub use model::model;
pub use numbers::Numbers;
pub use operation::{Binary, Id, Operation, Unary};
pub use recorded::{Format, Recorded};
pub use recorder::Recorder;
pub use run::{Beginning, Given, run};
pub use schedule::Schedule;
