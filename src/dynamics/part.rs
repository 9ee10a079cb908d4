//! The numbers of a state, by name.

use super::{Flanks, Lagging, State};
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
    /// Whether the lagging Stribeck curve has a value.
    CurveBegun,
    /// The lagging Stribeck curve.
    Curve,
    /// The steady value of the lagging Stribeck curve.
    SteadyCurve,
    /// Whether a previous load torque is known.
    LoadBegun,
    /// The previous load torque.
    Load,
    /// Whether the flanks of the gap have parted.
    GapParted,
    /// The travel since they parted.
    GapWay,
    /// The momentum that the load has not received.
    GapMomentum,
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
            Self::CurveBegun => ("curve_begun", "1", "1 once the Stribeck curve has a value."),
            Self::Curve => ("curve", "1", "Stribeck curve that follows the speed late."),
            Self::SteadyCurve => ("steady_curve", "1", "Stribeck curve at the speed before."),
            Self::LoadBegun => ("load_begun", "1", "1 once there was a load torque."),
            Self::Load => ("load_before", "T", "Load torque before, with the last sign it had."),
            Self::GapParted => ("gap_parted", "1", "1 once the load torque has changed its sign."),
            Self::GapWay => ("gap_way", "X", "Way since the load torque changed its sign."),
            Self::GapMomentum => ("gap_momentum", "T s", "Momentum that the load is lacking."),
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
        let yes_or_no = |part, mask: S::Mask, change: &mut dyn FnMut(Part, S) -> S| {
            change(part, S::select(mask, S::one(), S::zero())).at_zero().not()
        };
        state.curve = Lagging {
            begun: yes_or_no(Part::CurveBegun, self.curve.begun, &mut change),
            value: change(Part::Curve, self.curve.value),
            steady: change(Part::SteadyCurve, self.curve.steady),
        };
        state.flanks = Flanks {
            begun: yes_or_no(Part::LoadBegun, self.flanks.begun, &mut change),
            load: change(Part::Load, self.flanks.load),
            parted: yes_or_no(Part::GapParted, self.flanks.parted, &mut change),
            way: change(Part::GapWay, self.flanks.way),
            momentum: change(Part::GapMomentum, self.flanks.momentum),
        };
        state
    }
}
