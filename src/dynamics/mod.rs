//! The states of laws with memory, each stepped exactly for a velocity that is constant over the
//! step.
//!
//! One file per kind of state. A law of [`crate::law`] selects its kind in
//! [`FrictionLaw::step`](crate::law::FrictionLaw::step); the effect `presliding` adds a bristle to
//! any static law, and `frictional_lag` and `backlash` have numbers of their own (`history`).

mod bristle;
mod dahl;
mod deflection;
mod elastoplastic;
mod elements;
mod gap;
mod history;
mod lag;
mod leuven;
mod maxwell_slip;
#[cfg(feature = "python")]
mod part;
mod relaxation;
#[cfg(test)]
mod tests;

pub use bristle::{Bristle, BristleState};
pub use dahl::DahlBristle;
pub use deflection::{Approach, Deflection};
pub use elastoplastic::ElastoplasticBristle;
pub use elements::{Elements, MAX_ELEMENTS};
pub use gap::Gap;
#[cfg(feature = "std")]
pub use history::Kept;
pub use history::{EffectState, History};
pub use lag::Lag;
pub use leuven::LeuvenBristle;
pub use maxwell_slip::MaxwellSlip;
#[cfg(feature = "python")]
pub use part::Part;
pub use relaxation::Relaxation;

use crate::sample::Sample;
use crate::scalar::{Mask, Real};

/// Above this exponent of relaxation the initial state has no influence: `e^-700 < 1e-304`.
const SATURATED: f64 = 700.0;

/// After this time (s) every state has settled.
pub const LONG: f64 = 1e9;

/// A time step over which a sample is constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<P> {
    /// The sample, at the end of the step.
    pub sample: Sample<P>,
    /// Mean velocity over the step (X/s), if known, for example from positions. The state is
    /// stepped with it instead of the sample's velocity, which makes the step second order.
    pub mean_velocity: Option<P>,
    /// Length (s); with `dt <= 0` the state is unchanged.
    pub dt: P,
    /// Whether the mean torque is requested too: exact work where the sample's velocity is
    /// constant.
    pub mean: bool,
}

impl<P: Real> Interval<P> {
    /// `sample` constant for `dt` (s), without the mean torque.
    #[inline(always)]
    #[must_use]
    pub const fn constant(sample: Sample<P>, dt: P) -> Self {
        Self { sample, mean_velocity: None, dt, mean: false }
    }

    /// The velocity that the state is stepped with (X/s).
    #[inline]
    #[must_use]
    pub fn velocity(&self) -> P {
        self.mean_velocity.unwrap_or(self.sample.velocity)
    }

    /// The travel `|v| dt` (X); 0 for `dt <= 0`.
    #[inline]
    #[must_use]
    pub fn travel(&self) -> P {
        P::choose(self.dt.is_positive(), self.velocity().abs() * self.dt, P::zero())
    }
}

/// The result of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S> {
    /// Torque at the end of the step (T).
    pub torque: S,
    /// Torque averaged over the step (T): times `v dt` it is the exact work. Equal to `torque` if
    /// not requested.
    pub mean_torque: S,
}

impl<S: Real> Step<S> {
    /// A torque that is constant over the step.
    #[inline]
    #[must_use]
    pub fn same(torque: S) -> Self {
        Self { torque, mean_torque: torque }
    }
}

/// The kind of state of a model, whose numbers are in the order of a start value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// No state.
    None,
    /// The deflection of one bristle (X).
    Deflection,
    /// The forces of this many elements in parallel (T).
    Forces(usize),
    /// The force of each element of the law (T).
    Elements,
}

impl Memory {
    /// Number of values of the state.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::None => 0,
            Self::Deflection => 1,
            Self::Forces(count) => count,
            Self::Elements => MAX_ELEMENTS,
        }
    }
}

/// State of any model, separate from its parameters: each kind of law uses its own part.
#[derive(Clone, Copy, Debug)]
pub struct State<S: Real> {
    /// Deflection of a bristle.
    pub(crate) bristle: BristleState<S>,
    /// Forces of elements in parallel.
    pub(crate) elements: Elements<S>,
    /// What effects remember.
    pub(crate) effects: EffectState<S>,
    /// Dry magnitude at the end of the step before (T).
    dry: Option<S>,
}

impl<S: Real> State<S> {
    /// The state for an initial deflection `z` (X); 0 for a relaxed bristle.
    #[inline]
    #[must_use]
    pub fn with_deflection(z: S) -> Self {
        Self {
            bristle: BristleState { z },
            elements: Elements::default(),
            effects: EffectState::default(),
            dry: None,
        }
    }

    /// The dry magnitude that acts over a step at whose end it is `end` (T): the mean over the step
    /// if the interval has a mean velocity, else `end`.
    #[inline]
    pub(crate) fn dry_over(&mut self, end: S, interval: &Interval<S::Plain>) -> S {
        let before = self.dry.replace(end).filter(|_| interval.mean_velocity.is_some());
        before.map_or(end, |before| (before + end).scale(S::Plain::from_f64(0.5)))
    }

    /// The state of sticking elements with these forces (T).
    #[must_use]
    pub fn with_forces(forces: impl IntoIterator<Item = S>) -> Self {
        let mut state = Self::default();
        for (own, force) in state.elements.force.iter_mut().zip(forces) {
            *own = force;
        }
        state
    }
}

impl<S: Real> State<S> {
    /// Deflection of a bristle (X).
    #[inline]
    #[must_use]
    pub const fn deflection(&self) -> S {
        self.bristle.z
    }

    /// Forces of the elements in parallel (T): as many as the model has, then zeros.
    #[inline]
    #[must_use]
    pub const fn forces(&self) -> &[S] {
        &self.elements.force
    }
}

impl<S: Real> Default for State<S> {
    fn default() -> Self {
        Self::with_deflection(S::zero())
    }
}

/// The share of a change of its target that a state has followed at the end of a step.
///
/// The target moves linearly: it has the constant value at the middle of the step. With `y` minus
/// the exponent of relaxation over the step and `phi = phi_1(y)`, the state follows the second half
/// of that motion by this share: `y^2/6` where relaxation is slow, 1 where it is stiff. With a mean
/// velocity the step is therefore second order for any stiffness.
#[inline]
pub(crate) fn following<S: Real>(y: S, phi: S) -> S {
    let two = S::Plain::from_f64(2.0);
    (y.shift(-two) * phi).shift(two)
}

/// `ln(1 + c)/c`, by the series of the inverse hyperbolic tangent where `c` is small.
#[inline]
fn logarithm_ratio<S: Real>(c: S) -> S {
    let one = S::Plain::one();
    let series = || {
        // ln(1 + c) = 2 artanh(s), s = c/(2 + c), s^2 < 0.0124.
        let inverse = S::one() / c.shift(one + one);
        let square = c * inverse * c * inverse;
        let mut sum = S::zero();
        for k in (0..9_u8).rev() {
            sum = (sum * square).shift(one / S::Plain::from_f64(f64::from(2 * k + 1)));
        }
        (sum * inverse).scale(one + one)
    };
    c.abs().is_above(S::Plain::from_f64(0.2)).either(|| c.shift(one).ln() / c, series)
}
