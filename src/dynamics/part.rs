//! The numbers of a state, by name.

use super::{Kept, State};
use crate::scalar::{Choice, Mask, Real};

/// One number of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Deflection of a bristle.
    Deflection,
    /// Force of an element, counted from 0.
    Force(usize),
    /// Direction in which an element slides.
    Sliding(usize),
    /// Whether a number that follows has a value.
    Begun,
    /// A number that effects keep.
    Kept(Kept),
}

impl Part {
    /// Its name without the number of an element, its unit and its meaning.
    #[must_use]
    pub const fn describe(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Deflection => ("deflection", "X", "Mean deflection of the bristles."),
            Self::Force(_) => ("force", "T", "Force of an element."),
            Self::Sliding(_) => {
                ("sliding", "1", "Direction in which an element slides; 0 while it sticks.")
            }
            Self::Begun => ("begun", "1", "1 once there was a step."),
            Self::Kept(kept) => match kept {
                Kept::CurveDeviation => {
                    ("curve_deviation", "1", "Lagging Stribeck curve minus its steady value.")
                }
                Kept::SteadyCurve => ("steady_curve", "1", "Stribeck curve at the speed before."),
                Kept::Load => {
                    ("load_before", "T", "Load torque before, with the last sign it had.")
                }
                Kept::GapParted => {
                    ("gap_parted", "1", "1 once the load torque has changed its sign.")
                }
                Kept::GapWay => ("gap_way", "X", "Travel since the load torque changed its sign."),
                Kept::GapMomentum => ("gap_momentum", "T s", "Momentum that the load is lacking."),
            },
        }
    }

    /// The number of the element, if it belongs to one.
    #[must_use]
    pub const fn element(self) -> Option<usize> {
        match self {
            Self::Force(k) | Self::Sliding(k) => Some(k),
            _ => None,
        }
    }
}

impl<S: Real> State<S> {
    /// The state with each of its numbers changed, always in the same order. Booleans count as 1 or
    /// 0.
    #[must_use]
    pub fn map(&self, mut change: impl FnMut(Part, S) -> S) -> Self {
        let mut state = *self;
        state.bristle.z = change(Part::Deflection, self.bristle.z);
        for (k, force) in state.elements.force.iter_mut().enumerate() {
            *force = change(Part::Force(k), *force);
        }
        for (k, sliding) in state.elements.sliding.iter_mut().enumerate() {
            *sliding = change(Part::Sliding(k), S::from_plain(*sliding)).plain();
        }
        let begun = S::select(self.effects.begun, S::one(), S::zero());
        state.effects.begun = change(Part::Begun, begun).at_zero().not();
        for kept in Kept::ALL {
            let number = state.effects.number(kept);
            *number = change(Part::Kept(kept), *number);
        }
        state
    }
}
