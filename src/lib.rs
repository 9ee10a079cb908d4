#![doc = include_str!("../docs/rust.md")]
//!
//! # Architecture
//!
//! Dependencies point one way, down this list. Modules that are not public are listed for those who
//! read the source.
//!
//! | module | content |
//! |---|---|
//! | [`math`] | elementary functions with the same bits on every target |
//! | `scalar` | [`Real`]: `f32`, `f64`, [`Dual`] for gradients |
//! | `sample` | [`Sample`], the input of a law; [`Split`](law::Split), its torque by parts |
//! | `table`, `constants` | names, symbols, units and bounds of parameters; [`Constants`] |
//! | `formula` | [`Formula`]: friction terms that a user writes as text |
//! | `dynamics` | laws with a state: [`State`], each kind of state stepped exactly |
//! | [`law`], `effect` | one file each: parameters, table and formula |
//! | [`catalog`] | the list of laws and effects |
//! | `composed`, `error` | [`Spec`] and [`Composed`]: a law with effects; [`ModelError`] |
//! | `fixed`, `feedforward` | [`FixedLaw`], a law chosen at compile time; [`Feedforward`] |
//! | [`joint`] | friction coupled to an inertia: joints in motion |
//! | [`robot`] | rigid bodies of a whole robot: torques, mass matrix, regressor |
//! | `graph` (`std`) | the operations of a law, recorded, differentiated and vectorised |
//! | `batch` (`std`) | whole recordings: torque, gradient, delay |
//! | `identify` (`identify`) | parameters from recordings: separable least squares |
//! | `passivity` (`std`) | proofs over a box of operating points, and counterexamples |
//! | `export`, `units`, `python` (`python`) | the extension module `stribeck._core` |
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
#[cfg(feature = "identify")]
pub mod identify;
pub mod joint;
pub mod law;
pub mod math;
#[cfg(feature = "std")]
pub mod passivity;
pub mod prelude;
#[cfg(feature = "python")]
mod python;
pub mod robot;
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
pub use formula::{Expression, Formula, FormulaError, FormulaNames};
pub use sample::Sample;
pub use scalar::{Choice, Dual, Mask, Real, Scalar};
pub use table::Channel;
