//! Elements in parallel, each with its own force.

use crate::scalar::Real;

/// Largest number of elements of a law.
pub const MAX_ELEMENTS: usize = 16;

/// State of the elements of a law, separate from their parameters.
#[derive(Clone, Copy, Debug)]
pub struct Elements<S: Real> {
    /// Force of each element (T).
    pub force: [S; MAX_ELEMENTS],
    /// Direction in which each element slides, 1 or -1; 0 while it sticks.
    pub sliding: [S::Plain; MAX_ELEMENTS],
}

impl<S: Real> Default for Elements<S> {
    fn default() -> Self {
        Self { force: [S::zero(); MAX_ELEMENTS], sliding: [S::Plain::zero(); MAX_ELEMENTS] }
    }
}
