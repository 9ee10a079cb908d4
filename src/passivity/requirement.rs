//! Conditions of passivity on the parameters of a model, at single operating points.
//!
//! Each is necessary: a model that violates one generates energy. Together over a whole box they
//! are sufficient, so a fit constrained by the worst of them may end in a proof.

use std::vec::Vec;

use super::friction::{Bristled, Leg, sliding};
use super::region::Point;
use crate::composed::{Composed, Spec};
use crate::error::ModelError;
use crate::scalar::{Dual, Real, Scalar};

/// Number of derivatives per evaluation.
const DERIVATIVES_PER_PASS: usize = 8;

/// A condition that holds where its margin is not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Requirement {
    /// Dry friction is positive: margin in T.
    Strength(Point),
    /// Friction in steady sliding opposes the motion: margin in T.
    Sliding(Point),
    /// A cycle around this force in which the deflection grows at one point and falls at the other
    /// dissipates; the margin is the work per travel (T). On a leg where the deflection would move
    /// the other way it is constant, and the condition is that of sliding.
    Cycle {
        /// The bristle force (T).
        force: f64,
        /// The deflection grows here.
        up: Point,
        /// The deflection falls here.
        down: Point,
    },
}

impl Requirement {
    /// The name shown to users.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Strength(_) => "strength",
            Self::Sliding(_) => "sliding",
            Self::Cycle { .. } => "cycle",
        }
    }

    /// The operating points of the condition.
    #[must_use]
    pub fn points(&self) -> Vec<Point> {
        match *self {
            Self::Strength(point) | Self::Sliding(point) => [point].into(),
            Self::Cycle { up, down, .. } => [up, down].into(),
        }
    }

    /// The margin (T).
    pub fn margin<S: Scalar<Plain = f64>>(&self, model: &Composed<S>) -> S {
        match self {
            Self::Strength(point) => model.split(point).dry(),
            Self::Sliding(point) => sliding(model, point),
            Self::Cycle { force, up, down } => {
                let legs = (leg(model, up, *force, true), leg(model, down, *force, false));
                let (Some(up), Some(down)) = legs else { return S::zero() };
                let pace = up.pace + down.pace;
                if pace.value() <= 0.0 {
                    return (up.load + down.load).scale(0.5);
                }
                // Work per deflection up and down, over the travels per deflection 1/pace.
                let work = up.load * down.pace
                    + down.load * up.pace
                    + (up.drag + down.drag) * up.pace * down.pace;
                work / pace
            }
        }
    }

    /// The margin, and its derivatives with respect to all parameters.
    ///
    /// # Errors
    /// Parameter values at which the model cannot be evaluated.
    pub fn gradient(
        &self,
        spec: &Spec,
        values: &[f64],
    ) -> Result<(f64, Vec<f64>), ModelError<'static>> {
        let mut variables: Vec<_> =
            values.iter().map(|&x| Dual::<f64, DERIVATIVES_PER_PASS>::constant(x)).collect();
        let mut margin = 0.0;
        let mut slopes = Vec::with_capacity(values.len());
        for first in (0..values.len()).step_by(DERIVATIVES_PER_PASS) {
            let some = first..values.len().min(first + DERIVATIVES_PER_PASS);
            for (direction, k) in some.clone().enumerate() {
                variables[k] = Dual::variable(values[k], direction);
            }
            let with_slopes = self.margin(&spec.with(&variables)?);
            margin = with_slopes.value;
            slopes.extend_from_slice(&with_slopes.derivative[..some.len()]);
            for k in some {
                variables[k] = Dual::constant(values[k]);
            }
        }
        Ok((margin, slopes))
    }
}

/// The leg of a cycle at a point; the bristle slides where its deflection would move the other way.
fn leg<S: Scalar<Plain = f64>>(
    model: &Composed<S>,
    point: &Point,
    force: f64,
    rising: bool,
) -> Option<Leg<S>> {
    let direction = point.velocity.sign();
    let bristled = Bristled::of(model, point)?;
    let leg = bristled.leg(force * direction, (direction > 0.0) == rising);
    if leg.pace.value() > 0.0 {
        return Some(leg);
    }
    // The bristle slides with its full strength, whatever the force of the cycle.
    Some(Leg { load: bristled.strength() + bristled.resistance, pace: S::zero(), ..leg })
}
