//! Parameters from recordings: separable least squares.
//!
//! [`Problem`] is a model and a measured torque. It reduces its linearisation to a [`Triangle`]
//! block by block, without a Jacobian in memory. [`minimise`] takes damped steps in the nonlinear
//! parameters and solves for the linear ones, for a [`Problem`] or any other [`LeastSquares`].
//!
//! [`divided_differences`] of recorded channels show their noise, [`LowPass`] smooths them; a
//! [`Forest`] learns from them what no model explains.

mod bounded;
mod dense;
mod differences;
mod first_order;
mod forest;
mod low_pass;
mod problem;
mod reduced;
mod resonance;
mod separable;
mod threads;
mod triangle;

pub use bounded::bounded_least_squares;
#[cfg(feature = "python")]
pub(crate) use dense::SingularValues;
pub use differences::divided_differences;
pub use first_order::first_order;
pub use forest::{Forest, ForestError};
pub use low_pass::LowPass;
pub use problem::{NOT_SCORED, Problem};
pub use reduced::{Reduced, reduced};
pub use resonance::Resonance;
pub use separable::{Bounds, LeastSquares, Outcome, Search, Steps, minimise};
#[cfg(feature = "python")]
pub(crate) use threads::side_by_side;
pub use triangle::{Triangle, triangles};
