//! Parameters from recordings: separable least squares over columns in memory.
//!
//! [`Problem`] binds a model to a measured torque and brings its linearisation down to a
//! [`Triangle`] block by block, without a Jacobian in memory. [`minimise`] takes damped steps in the
//! nonlinear parameters and solves for the linear ones in between, on that or on anything else that
//! is [`LeastSquares`].

mod bounded;
mod problem;
mod separable;
mod threads;
mod triangle;

pub use bounded::bounded_least_squares;
pub use problem::{NOT_SUMMED, Problem};
pub use separable::{Bounds, LeastSquares, Outcome, Search, Steps, minimise};
pub use threads::side_by_side;
pub use triangle::{Triangle, triangles};
