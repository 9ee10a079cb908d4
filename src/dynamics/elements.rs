//! Elements in parallel, each with a force of its own.

use crate::scalar::Real;

/// Most elements of a law.
pub const MOST_ELEMENTS: usize = 16;

/// State of the elements of a law, kept apart from their parameters.
#[derive(Clone, Copy, Debug)]
pub struct Elements<S: Real> {
    /// Force of each element (T).
    pub force: [S; MOST_ELEMENTS],
    /// Direction in which each element slides, 1 or -1; 0 while it sticks.
    pub sliding: [S::Plain; MOST_ELEMENTS],
}

impl<S: Real> Default for Elements<S> {
    fn default() -> Self {
        Self { force: [S::zero(); MOST_ELEMENTS], sliding: [S::Plain::zero(); MOST_ELEMENTS] }
    }
}
