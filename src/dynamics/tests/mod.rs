//! Properties of the exact steps.

mod bristle;
mod energy;
