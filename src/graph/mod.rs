//! The operations of a law, recorded once as a graph and then executed on many samples.
//!
//! A model evaluated with [`Recorded`] numbers leaves its operations in a [`Recorder`]. The graph
//! is differentiated symbolically ([`derivative`]), so that derivatives that are always 0 cost
//! nothing, scheduled ([`Schedule`]), and run loop by loop over blocks of samples that fit into the
//! first-level cache ([`run`]): an operation, or a few simple ones whose results stay in registers
//! (`merge`). The compiler vectorises the loops.
//! Every number has the bits of a scalar evaluation: nothing is fused or reordered.

mod block;
mod derivative;
mod merge;
mod merged;
mod model;
mod numbers;
mod operation;
mod recorded;
mod recorder;
mod run;
mod schedule;
mod two_valued;

pub use derivative::derivatives;
pub use model::model;
pub use numbers::{Numbers, all_finite};
#[cfg(feature = "python")]
pub use operation::{Binary, Id, Unary};
pub use operation::{Operation, Start};
#[cfg(feature = "python")]
pub use recorded::Format;
pub use recorded::Recorded;
pub use recorder::Recorder;
pub use run::{Beginning, Inputs, run};
pub use schedule::Schedule;
