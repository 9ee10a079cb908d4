//! Least squares on columns: sums in a fixed order, so that results do not depend on threads.

mod normal;

pub use normal::{NormalError, NormalSums, normal_equations};
