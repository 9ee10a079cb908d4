//! Elements in parallel, each with a force of its own.

use crate::scalar::Scalar;

/// Most elements of a law.
pub const MOST_ELEMENTS: usize = 16;

/// State of the elements of a law, kept apart from their parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elements<S> {
    /// Force of each element (T).
    pub force: [S; MOST_ELEMENTS],
    /// Direction in which each element slides, 1 or -1; 0 while it sticks.
    pub sliding: [i8; MOST_ELEMENTS],
}

impl<S: Scalar> Default for Elements<S> {
    fn default() -> Self {
        Self { force: [S::zero(); MOST_ELEMENTS], sliding: [0; MOST_ELEMENTS] }
    }
}
