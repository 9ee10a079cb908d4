//! A law with effects: a selection ([`Spec`]), and a model with parameter values ([`Composed`]).

use core::fmt;

use crate::catalog::{self, EffectId, EffectSet, Effects, Law, LawId};
use crate::constants::Constants;
use crate::dynamics::{Bristle, Deflection, History, Interval, LONG, Memory, State, Step};
use crate::error::ModelError;
use crate::formula::{Formula, FormulaTerms};
use crate::sample::{Sample, Split};
use crate::scalar::{Real, Scalar};
use crate::table::{self, Channel, ParameterInfo, Pole, Presence, Role};

/// A selection of law, formula terms, effects and constants. Displays as `law+effect+...`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spec {
    law: LawId,
    formula: Option<Formula>,
    effects: EffectSet,
    constants: Constants<f64>,
}

impl Spec {
    /// From ids; the order of effects does not matter. The id of a law with several elements
    /// includes their number: `gms:8`.
    ///
    /// # Errors
    /// An unknown id, an effect named twice, or an effect that the law already includes.
    pub fn new<'a>(
        law: &'a str,
        effects: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, ModelError<'a>> {
        let (id, elements) = split_at_byte(law, b':');
        let unknown = ModelError::UnknownLaw(law);
        let law = catalog::law(id).ok_or(unknown)?;
        let mut constants = Constants::default();
        if let Some(count) = elements {
            // Parsed as an integer: parsing a float would link code that can panic.
            let count: u8 = count.parse().map_err(|_| unknown)?;
            if !law.info().constants.contains(&"elements")
                || constants.set("elements", count.into()) != Some(true)
            {
                return Err(unknown);
            }
        }
        let effects = effects_of(law, effects)?;
        Ok(Self { law, formula: None, effects, constants })
    }

    /// Parses the form that it displays as, `law+effect+...`.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn parse(text: &str) -> Result<Self, ModelError<'_>> {
        let (law, mut rest) = split_at_byte(text, b'+');
        let effects = core::iter::from_fn(|| {
            let (effect, after) = split_at_byte(rest?, b'+');
            rest = after;
            Some(effect)
        });
        Self::new(law, effects)
    }

    /// A law given by a formula, with effects by their ids.
    ///
    /// # Errors
    /// An unknown effect, or an effect named twice.
    pub fn by_formula<'a>(
        formula: &Formula,
        effects: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, ModelError<'a>> {
        let law = LawId::ByFormula;
        let effects = effects_of(law, effects)?;
        Ok(Self { law, formula: Some(*formula), effects, constants: Constants::default() })
    }

    /// Adds formula terms to the law, before effects act. Their parameters follow those of the law.
    ///
    /// # Errors
    /// The formula terms together exceed the largest size of a formula.
    pub fn add_terms(&mut self, formula: &Formula) -> Result<(), ModelError<'static>> {
        let joined = match &self.formula {
            Some(present) => present.plus(formula).map_err(ModelError::Formula)?,
            None => *formula,
        };
        self.formula = Some(joined);
        Ok(())
    }

    /// Sets one constant.
    ///
    /// # Errors
    /// An unknown name or an inadmissible value.
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

    /// The formula terms, if there are any.
    #[must_use]
    pub const fn formula(&self) -> Option<&Formula> {
        self.formula.as_ref()
    }

    /// The effects.
    #[must_use]
    pub const fn effects(&self) -> EffectSet {
        self.effects
    }

    /// The constants of the law, then those of the effects in their order.
    pub fn constants(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        let law = self.law.info().constants.iter();
        let effects = self.effects.iter().flat_map(|effect| effect.info().constants);
        law.chain(effects).filter_map(|&name| Some((name, self.constants.get(name)?)))
    }

    /// Whether the law or the effects include the effect with this id.
    #[must_use]
    pub fn has(&self, id: &str) -> bool {
        self.law.info().captures.contains(&id) || self.effects.iter().any(|e| e.info().id == id)
    }

    /// Whether the torque depends on the history.
    #[must_use]
    pub fn has_state(&self) -> bool {
        self.is_presliding() || self.effects.iter().any(EffectId::has_state)
    }

    /// Whether dry friction acts through a state.
    fn is_presliding(&self) -> bool {
        self.has(EffectId::Presliding.info().id)
    }

    /// The kind of the state through which dry friction acts. States of effects are not included.
    #[must_use]
    pub fn memory(&self) -> Memory {
        match self.law.memory() {
            _ if !self.is_presliding() => Memory::None,
            _ if self.effects.contains(EffectId::Presliding) => Memory::Deflection,
            Memory::Elements => Memory::Forces(self.constants.element_count()),
            memory => memory,
        }
    }

    /// The columns that the model reads.
    pub fn channels(&self) -> impl Iterator<Item = Channel> + '_ {
        Channel::ALL.into_iter().filter(|channel| {
            *channel == Channel::Velocity
                || self.law.info().channels.contains(channel)
                || self.formula.is_some_and(|formula| formula.reads(*channel))
                || self.effects.iter().any(|effect| effect.info().channels.contains(channel))
        })
    }

    /// The temperature at which the law is singular, if there is one (degC).
    #[must_use]
    pub fn pole(&self) -> Option<f64> {
        self.law.info().pole.map(|pole| match pole {
            Pole::Zero => 0.0,
            Pole::Base => self.constants.base_temperature,
        })
    }

    /// Its parameters: those of the law, those of the formula terms, then those of the effects in
    /// the order in which they act.
    pub fn parameters(&self) -> impl Iterator<Item = &'static ParameterInfo> + '_ {
        let law = self.law.info().parameters.iter();
        let formula = self.formula.iter().flat_map(Formula::parameters);
        let effects = self.effects.iter().flat_map(|effect| effect.info().parameters);
        law.chain(formula).chain(effects).filter(|parameter| self.includes(parameter.presence))
    }

    /// Number of parameters.
    #[must_use]
    pub fn parameter_count(&self) -> usize {
        self.parameters().count()
    }

    /// Whether the torque is linear in a parameter, with all nonlinear ones fixed. It is not where
    /// friction depends on the motor torque, which itself depends on friction, or where the motor
    /// torque saturates.
    #[must_use]
    pub fn is_linear(&self, parameter: &ParameterInfo) -> bool {
        let balanced = self.channels().any(|channel| channel == Channel::MotorTorque);
        if balanced || self.effects.contains(EffectId::Saturation) {
            return false;
        }
        match parameter.role {
            Role::Rate | Role::Additive => true,
            Role::Dry => !self.is_presliding(),
            Role::Nonlinear | Role::Held => false,
        }
    }

    /// The model with these parameter values, in the order of [`Spec::parameters`].
    ///
    /// # Errors
    /// A wrong number of values, or a value at which the model cannot be evaluated.
    pub fn with<S: Real>(&self, values: &[S]) -> Result<Composed<S>, ModelError<'static>> {
        table::check(|| self.parameters(), values)?;
        let mut values = values.iter().copied();
        let mut next = |presence| {
            let value = if self.includes(presence) { values.next() } else { None };
            value.unwrap_or_else(S::zero)
        };
        let law = self.law.read(&mut next);
        let formula = self
            .formula
            .as_ref()
            .map(|formula| FormulaTerms::read(formula, || next(Presence::InFormula)));
        let effects = Effects::read(self.effects, &mut next);
        let bristle = effects.bristle();
        let (memory, has_state) = (self.memory(), self.has_state());
        let constants = self.constants.cast();
        Ok(Composed { law, formula, effects, bristle, memory, has_state, constants })
    }

    fn includes(&self, presence: Presence) -> bool {
        match presence {
            Presence::Always | Presence::InFormula => true,
            Presence::WithStribeck => self.has(EffectId::Stribeck.info().id),
            Presence::WithLoad => self.effects.contains(EffectId::Load),
            Presence::WithoutOffset => !self.has(EffectId::Offset.info().id),
            Presence::Element(number) => self.constants.elements >= f64::from(number),
        }
    }
}

impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.law.info().id)?;
        if self.formula.is_some() && self.law != LawId::ByFormula {
            write!(f, "+{}", LawId::ByFormula.info().id)?;
        }
        let elements = self.constants.elements;
        if self.law.info().constants.contains(&"elements")
            && elements != Constants::default().elements
        {
            write!(f, ":{elements}")?;
        }
        self.effects.iter().try_for_each(|effect| write!(f, "+{}", effect.info().id))
    }
}

/// The text before a character and the text after it. The searches of `core` contain code that can
/// panic.
fn split_at_byte(text: &str, at: u8) -> (&str, Option<&str>) {
    match text.bytes().position(|byte| byte == at) {
        Some(i) => (text.get(..i).unwrap_or_default(), text.get(i + 1..)),
        None => (text, None),
    }
}

/// The effects with these ids, none of them twice and none that the law includes.
fn effects_of<'a>(
    law: LawId,
    ids: impl IntoIterator<Item = &'a str>,
) -> Result<EffectSet, ModelError<'a>> {
    ids.into_iter().try_fold(EffectSet::NONE, |set, id| {
        let effect = catalog::effect(id).ok_or(ModelError::UnknownEffect(id))?;
        if set.contains(effect) {
            return Err(ModelError::Twice(effect));
        }
        if law.info().captures.contains(&id) {
            return Err(ModelError::Captured(law, effect));
        }
        Ok(set.with(effect))
    })
}

/// A law and its effects with parameter values. Immutable; the state is separate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed<S: Real> {
    law: Law<S>,
    formula: Option<FormulaTerms<S>>,
    effects: Effects<S>,
    bristle: Option<Bristle<S>>,
    memory: Memory,
    has_state: bool,
    constants: Constants<S::Plain>,
}

impl<S: Real> Composed<S> {
    /// The effects with their parameters.
    #[cfg(feature = "std")]
    #[must_use]
    pub(crate) const fn effects(&self) -> &Effects<S> {
        &self.effects
    }

    /// Whether the torque depends on the history.
    #[must_use]
    pub const fn has_state(&self) -> bool {
        self.has_state
    }

    /// The kind of the state through which dry friction acts.
    #[must_use]
    pub const fn memory(&self) -> Memory {
        self.memory
    }

    /// The sample that acts on friction, where the sensors show another one.
    #[inline(always)]
    #[must_use]
    pub(crate) fn acting(&self, sample: &Sample<S::Plain>) -> Sample<S::Plain> {
        self.effects.acting(sample)
    }

    /// The torque at one sample, by its parts.
    #[inline]
    #[must_use]
    pub fn split(&self, sample: &Sample<S::Plain>) -> Split<S> {
        self.split_of_acting(&self.acting(sample))
    }

    /// Like [`split`](Self::split), of the sample that acts.
    #[inline]
    fn split_of_acting(&self, sample: &Sample<S::Plain>) -> Split<S> {
        let split = self.law.split(sample, &self.constants);
        if self.effects.is_empty() && self.formula.is_none() {
            return split;
        }
        // A copy, so that a law without effects stays in registers.
        let mut altered = split;
        if let Some(formula) = &self.formula {
            formula.add_to(&mut altered, sample);
        }
        self.effects.apply(&mut altered, sample, &self.constants);
        altered
    }

    /// The real torque of a model without state, in steady sliding (T), before effects of the
    /// torque channel.
    #[inline]
    pub(crate) fn acting_torque(&self, sample: &Sample<S::Plain>) -> S {
        let direction = sample.velocity.sign();
        if self.effects.is_empty() && self.formula.is_none() {
            return self.law.torque(sample, direction, &self.constants);
        }
        self.split(sample).torque(direction)
    }

    /// The bristle through which dry friction acts at a sample that [acts](Self::acting), if the
    /// state is a bristle.
    #[inline(always)]
    #[must_use]
    pub(crate) fn bristle(&self, sample: &Sample<S::Plain>) -> Option<Bristle<S>> {
        self.bristle.or_else(|| self.law.bristle(sample, &self.constants))
    }

    /// The equation of the deflection through which dry friction acts, if the state is a single
    /// deflection.
    #[inline]
    #[must_use]
    pub fn deflection(&self, sample: &Sample<S::Plain>) -> Option<Deflection<S>>
    where
        S: Scalar,
    {
        match &self.bristle {
            Some(bristle) => Some(bristle.deflection(sample.velocity)),
            None => self.law.deflection(&self.acting(sample), &self.constants),
        }
    }

    /// Like [`split`](Self::split), at the end of an interval; steps the states of effects.
    #[inline]
    pub(crate) fn split_over(
        &self,
        history: &mut impl History<S>,
        interval: &Interval<S::Plain>,
    ) -> Split<S> {
        let mut split = self.law.split(&interval.sample, &self.constants);
        if let Some(formula) = &self.formula {
            formula.add_to(&mut split, &interval.sample);
        }
        self.effects.apply_over(&mut split, history, interval, &self.constants);
        split
    }

    /// Whether several samples can be evaluated in parallel, because the effect of a step does not
    /// depend on the state: unless dry friction acts through elements.
    #[cfg(feature = "std")]
    #[must_use]
    pub(crate) fn runs_side_by_side(&self) -> bool {
        let is_bristle = || self.bristle(&Sample::at(S::Plain::zero())).is_some();
        matches!(self.memory, Memory::None) || is_bristle()
    }

    /// The measured torque in steady sliding, where dry friction acts along `sgn v` (T).
    #[inline]
    #[must_use]
    pub fn static_torque(&self, sample: &Sample<S::Plain>) -> S {
        self.measured(self.split(sample).torque(sample.velocity.sign()), sample)
    }

    /// The measured value of a friction torque (T): effects of the torque channel are applied.
    #[inline]
    #[must_use]
    pub fn measured(&self, friction: S, sample: &Sample<S::Plain>) -> S {
        self.effects.measured(friction, sample, &self.constants)
    }

    /// The state after a long time at this sample; a relaxed one at rest.
    #[must_use]
    pub fn settled(&self, sample: &Sample<S::Plain>) -> State<S> {
        let mut state = State::default();
        let dt = S::Plain::from_f64(LONG);
        self.step_acting(&mut state, &Interval::constant(self.acting(sample), dt));
        state
    }

    /// Steps over `dt` (s) at `sample`; `state` and `dt` have no influence on a model without
    /// memory.
    #[inline]
    pub fn step(&self, state: &mut State<S>, sample: &Sample<S::Plain>, dt: S::Plain) -> Step<S> {
        let interval = Interval::constant(self.acting(sample), dt);
        self.step_acting(state, &Interval { mean: true, ..interval })
    }

    /// Like [`step`](Self::step), over an interval. The torque at its end is the measured one; the
    /// mean is the real one, which does the work.
    #[inline]
    pub fn step_over(&self, state: &mut State<S>, interval: &Interval<S::Plain>) -> Step<S> {
        let sample = self.acting(&interval.sample);
        self.step_acting(state, &Interval { sample, ..*interval })
    }

    /// Like [`step_over`](Self::step_over), with the sample that [acts](Self::acting).
    #[inline]
    pub(crate) fn step_acting(
        &self,
        state: &mut State<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let split = if self.has_state {
            self.split_over(&mut state.effects, interval)
        } else {
            self.split_of_acting(&interval.sample)
        };
        let step = if matches!(self.memory, Memory::None) {
            Step::same(split.torque(interval.sample.velocity.sign()))
        } else {
            let dry = state.dry_over(split.dry(), interval);
            match self.bristle(&interval.sample) {
                Some(bristle) => bristle.step_over(&mut state.bristle, dry, &split, interval),
                None => self.law.step(state, dry, &split, interval, &self.constants),
            }
        };
        let torque = self.effects.measured(step.torque, &interval.sample, &self.constants);
        Step { torque, ..step }
    }
}
