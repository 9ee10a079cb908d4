//! Friction laws, the effects that can be missing from them, and exact bristle steps.
//!
//! Dependencies point one way, down this list:
//!
//! | module | what lives there |
//! |---|---|
//! | [`math`] | the one door to `exp`, `pow`, `tanh` ...: same bits everywhere |
//! | [`scalar`] | [`Real`](scalar::Real): `f32`, `f64`, [`Dual`](scalar::Dual) for gradients |
//! | [`sample`] | what a law sees at one instant; the torque it gives, taken apart |
//! | [`table`], [`constants`] | names, symbols, units, bounds |
//! | [`formula`] | friction terms that a user writes as text |
//! | [`dynamics`] | laws with a memory: states, each stepped exactly |
//! | [`law`], [`effect`] | one file each: table and formula |
//! | [`catalog`] | the list of laws and effects |
//! | [`composed`], [`error`] | a law with its effects |
//! | [`fixed`], [`feedforward`] | a law chosen when the program is built; friction in a controller |
//! | [`joint`] | friction coupled to an inertia: joints in motion |
//! | `graph` (feature `std`) | what a law computes, written down, differentiated and vectorised |
//! | `batch` (feature `std`) | whole recordings: torque, gradient, delay |
//! | `identify` (feature `std`) | parameters from recordings: separable least squares |
//! | `export` (feature `std`) | a step of a model as a list of operations, for controllers |
//! | `passivity` (feature `std`) | proofs over a box of operating points, and counterexamples |
//! | `python` (feature `python`) | the extension module `stribeck._core` |
//!
//! The core has no allocation and no `std`; features only add modules.
//!
//! ```
//! use stribeck::dynamics::State;
//! use stribeck::composed::Spec;
//! use stribeck::sample::Sample;
//!
//! let model = Spec::new("coulomb", ["presliding"])?.with(&[0.5, 2.0, 1e4, 10.0])?;
//! let mut state = State::default();
//! let step = model.step(&mut state, &Sample::at(0.1), 0.01);
//! // s0 z + s1 dz/dt + a1 v, the bristle almost at its steady deflection
//! assert_eq!((step.torque * 1e3_f64).round(), 2043.0);
//! # Ok::<(), stribeck::error::ModelError>(())
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
extern crate std;

#[cfg(feature = "std")]
pub mod batch;
pub mod catalog;
pub mod composed;
pub mod constants;
pub mod dynamics;
pub mod effect;
pub mod error;
#[cfg(feature = "std")]
pub mod export;
pub mod feedforward;
pub mod fixed;
pub mod formula;
#[cfg(feature = "std")]
mod graph;
#[cfg(feature = "std")]
pub mod identify;
pub mod joint;
pub mod law;
pub mod math;
#[cfg(feature = "std")]
pub mod passivity;
#[cfg(feature = "python")]
mod python;
pub mod sample;
pub mod scalar;
pub mod table;
#[cfg(feature = "python")]
mod units;
