//! Friction laws, the effects that can be missing from them, and exact bristle steps.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

// Unit tests share models and motions with those in `tests/`.
#[cfg(test)]
extern crate self as stribeck;
#[cfg(test)]
#[path = "../tests/common/mod.rs"]
mod common;

#[cfg(feature = "std")]
pub mod batch;
pub mod catalog;
mod composed;
mod constants;
mod dynamics;
mod effect;
mod error;
#[cfg(feature = "python")]
mod export;
mod feedforward;
mod fixed;
mod formula;
#[cfg(feature = "std")]
mod graph;
#[cfg(feature = "std")]
pub mod identify;
pub mod joint;
pub mod law;
pub mod math;
#[cfg(feature = "std")]
pub mod passivity;
pub mod prelude;
#[cfg(feature = "python")]
mod python;
mod sample;
mod scalar;
mod table;
#[cfg(feature = "python")]
mod units;

pub use composed::{Composed, Spec};
pub use constants::Constants;
pub use dynamics::{Interval, Memory, State, Step};
pub use error::ModelError;
pub use feedforward::{Feed, Feedforward, Friction, Limits, Source};
pub use fixed::FixedLaw;
pub use formula::{Formula, FormulaError, FormulaNames};
pub use sample::Sample;
pub use scalar::{Choice, Dual, Mask, Real, Scalar};
pub use table::Channel;
