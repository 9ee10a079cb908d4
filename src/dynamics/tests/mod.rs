//! What the exact steps promise.

mod bristle;
mod energy;
