//! A law selected at compile time, for controllers.

use crate::constants::Constants;
use crate::dynamics::{Interval, State};
use crate::error::ModelError;
use crate::law::FrictionLaw;
use crate::sample::Sample;
use crate::scalar::Scalar;
use crate::table::{self, Presence};

/// One law with its parameters: no other part of the catalog is linked.
///
/// The torque has the bits of [`Composed`](crate::composed::Composed) for a law without effects.
///
/// ```
/// use stribeck::law::Coulomb;
/// use stribeck::{FixedLaw, Sample, State};
///
/// let law = FixedLaw::new(Coulomb { viscous_friction: 0.5_f32, coulomb_friction: 2.0 });
/// assert_eq!(law.torque(&mut State::default(), &Sample::at(-1.0), 1e-3), -2.5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedLaw<L, S> {
    law: L,
    constants: Constants<S>,
}

impl<S: Scalar<Plain = S>, L: FrictionLaw<S>> FixedLaw<L, S> {
    /// A law with the default constants.
    #[must_use]
    pub fn new(law: L) -> Self {
        Self::with_constants(law, &Constants::default())
    }

    /// A law with these constants.
    #[must_use]
    pub fn with_constants(law: L, constants: &Constants<f64>) -> Self {
        Self { law, constants: constants.cast() }
    }

    /// The law with these parameter values, in the order of its table.
    ///
    /// # Errors
    /// A wrong number of values, or a value at which the law cannot be evaluated.
    pub fn from_values(
        values: &[S],
        constants: &Constants<f64>,
    ) -> Result<Self, ModelError<'static>> {
        let includes = |presence| match presence {
            Presence::Element(number) => constants.elements >= f64::from(number),
            _ => true,
        };
        let rows = L::INFO.parameters.iter();
        let rows = || rows.clone().filter(|parameter| includes(parameter.presence));
        table::check(rows, values)?;
        let mut values = values.iter().copied();
        let mut next = |presence| if includes(presence) { values.next() } else { None };
        let law = L::read(|presence| next(presence).unwrap_or_else(S::zero));
        Ok(Self::with_constants(law, constants))
    }

    /// The torque (T) at the end of a step of `dt` (s) at `sample`; `state` and `dt` have no
    /// influence on a static law.
    #[inline(always)]
    pub fn torque(&self, state: &mut State<S>, sample: &Sample<S>, dt: S) -> S {
        let interval = Interval::constant(*sample, dt);
        let split = self.law.split(sample, &self.constants);
        let dry = split.dry();
        let step = match self.law.bristle(sample, &self.constants) {
            Some(bristle) => bristle.step_over(&mut state.bristle, dry, &split, &interval),
            None => self.law.step(state, dry, &split, &interval, &self.constants),
        };
        step.torque
    }
}
