//! A law and its effects: first which ones ([`Spec`]), then with numbers ([`Composed`]).

use core::fmt;

use crate::bristle::{Bristle, BristleState, Step};
use crate::catalog::{self, EffectId, EffectSet, Effects, Law, LawId};
use crate::constants::Constants;
use crate::error::ModelError;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, ParameterInfo, Presence, Role};

/// Which law, which effects, which constants. Displays as `law+effect+...`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spec {
    law: LawId,
    effects: EffectSet,
    constants: Constants<f64>,
}

impl Spec {
    /// From ids; the order of effects does not matter.
    ///
    /// # Errors
    /// An id that is unknown, an effect named twice or one that the law already has.
    pub fn new<'a>(
        law: &'a str,
        effects: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, ModelError<'a>> {
        let law = catalog::law(law).ok_or(ModelError::UnknownLaw(law))?;
        let mut set = EffectSet::NONE;
        for id in effects {
            let effect = catalog::effect(id).ok_or(ModelError::UnknownEffect(id))?;
            if set.contains(effect) {
                return Err(ModelError::Twice(effect));
            }
            if law.info().captures.contains(&id) {
                return Err(ModelError::Captured(law, effect));
            }
            set = set.with(effect);
        }
        Ok(Self { law, effects: set, constants: Constants::default() })
    }

    /// Sets one constant.
    ///
    /// # Errors
    /// A name that is unknown or a value that cannot be used.
    pub fn set_constant<'a>(&mut self, name: &'a str, value: f64) -> Result<(), ModelError<'a>> {
        match self.constants.set(name, value) {
            Some(true) => Ok(()),
            Some(false) => Err(ModelError::Constant(name, value)),
            None => Err(ModelError::UnknownConstant(name)),
        }
    }

    /// The law.
    #[must_use]
    pub const fn law(&self) -> LawId {
        self.law
    }

    /// The effects.
    #[must_use]
    pub const fn effects(&self) -> EffectSet {
        self.effects
    }

    /// The constants of its effects, in the order of the effects.
    pub fn constants(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.effects
            .iter()
            .flat_map(|effect| effect.info().constants)
            .filter_map(|&name| Some((name, self.constants.get(name)?)))
    }

    /// Whether law or effects have the effect of this id.
    #[must_use]
    pub fn has(&self, id: &str) -> bool {
        self.law.info().captures.contains(&id) || self.effects.iter().any(|e| e.info().id == id)
    }

    /// Whether the model has a bristle, and with it a state.
    #[must_use]
    pub fn has_bristle(&self) -> bool {
        self.has(EffectId::Presliding.info().id)
    }

    /// Columns it reads.
    pub fn channels(&self) -> impl Iterator<Item = Channel> + '_ {
        Channel::ALL.into_iter().filter(|channel| {
            *channel == Channel::Velocity
                || self.effects.iter().any(|effect| effect.info().channels.contains(channel))
        })
    }

    /// Its parameters: those of the law, then those of the effects in the order they act.
    pub fn parameters(&self) -> impl Iterator<Item = &'static ParameterInfo> + '_ {
        let law = self.law.info().parameters.iter();
        let effects = self.effects.iter().flat_map(|effect| effect.info().parameters);
        law.chain(effects).filter(|parameter| self.includes(parameter.presence))
    }

    /// How many parameters it has.
    #[must_use]
    pub fn parameter_count(&self) -> usize {
        self.parameters().count()
    }

    /// Whether the torque is linear in a parameter, all nonlinear ones held.
    #[must_use]
    pub fn is_linear(&self, parameter: &ParameterInfo) -> bool {
        match parameter.role {
            Role::Rate | Role::Additive => true,
            Role::Dry => !self.has_bristle(),
            Role::Nonlinear => false,
        }
    }

    /// The model with these numbers, in the order of [`Spec::parameters`].
    ///
    /// # Errors
    /// A wrong number of values, or a value at which a formula cannot be evaluated.
    pub fn with<S: Real>(&self, values: &[S]) -> Result<Composed<S>, ModelError<'static>> {
        let expected = self.parameter_count();
        if values.len() != expected {
            return Err(ModelError::Count { expected, given: values.len() });
        }
        for (parameter, value) in self.parameters().zip(values) {
            if !parameter.admits(value.value()) {
                let value = value.value();
                return Err(ModelError::Value { parameter: parameter.name, value });
            }
        }
        let mut values = values.iter().copied();
        let mut next = |presence| {
            let value = if self.includes(presence) { values.next() } else { None };
            value.unwrap_or_else(S::zero)
        };
        let law = self.law.read(&mut next);
        let effects = Effects::read(self.effects, &mut next);
        let bristle = law.bristle().or_else(|| effects.bristle());
        Ok(Composed { law, effects, bristle, constants: self.constants.cast() })
    }

    fn includes(&self, presence: Presence) -> bool {
        match presence {
            Presence::Always => true,
            Presence::WithStribeck => self.has(EffectId::Stribeck.info().id),
            Presence::WithoutOffset => !self.effects.contains(EffectId::Offset),
        }
    }
}

impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.law.info().id)?;
        self.effects.iter().try_for_each(|effect| write!(f, "+{}", effect.info().id))
    }
}

/// A law and its effects with numbers: immutable, its state is kept apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed<S: Real> {
    law: Law<S>,
    effects: Effects<S>,
    bristle: Option<Bristle<S>>,
    constants: Constants<S::Plain>,
}

impl<S: Real> Composed<S> {
    /// The effects with their parameters.
    #[must_use]
    pub const fn effects(&self) -> &Effects<S> {
        &self.effects
    }

    /// The bristle, if the model has one.
    #[must_use]
    pub const fn bristle(&self) -> Option<&Bristle<S>> {
        self.bristle.as_ref()
    }

    /// The torque at one instant, taken apart.
    #[inline]
    #[must_use]
    pub fn split(&self, sample: &Sample<S::Plain>) -> Split<S> {
        let split = self.law.split(sample);
        if self.effects.is_empty() {
            return split;
        }
        // A copy, so that a law alone need not pass through memory.
        let mut altered = split;
        self.effects.apply(&mut altered, sample, &self.constants);
        altered
    }

    /// The torque in steady sliding, where dry friction acts along `sgn v` (T).
    #[inline]
    #[must_use]
    pub fn static_torque(&self, sample: &Sample<S::Plain>) -> S {
        self.split(sample).torque(sample.velocity.sign())
    }

    /// Holds `sample` for `dt` (s); a model without a bristle has no use for `state` and `dt`.
    #[inline]
    pub fn step(
        &self,
        state: &mut BristleState<S>,
        sample: &Sample<S::Plain>,
        dt: S::Plain,
    ) -> Step<S> {
        self.step_over(state, sample, sample.velocity, dt)
    }

    /// As [`step`](Self::step), with the velocity that carries the bristle given apart: the mean
    /// over the step, where positions tell it, makes the step second order.
    #[inline]
    pub fn step_over(
        &self,
        state: &mut BristleState<S>,
        sample: &Sample<S::Plain>,
        mean_velocity: S::Plain,
        dt: S::Plain,
    ) -> Step<S> {
        let split = self.split(sample);
        match &self.bristle {
            Some(bristle) => bristle.step(state, &split, mean_velocity, dt),
            None => {
                let torque = split.torque(sample.velocity.sign());
                Step { torque, mean_torque: torque }
            }
        }
    }
}
