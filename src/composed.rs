//! A law and its effects: first which ones ([`Spec`]), then with numbers ([`Composed`]).

use core::fmt;

use crate::catalog::{self, EffectId, EffectSet, Effects, Law, LawId};
use crate::constants::Constants;
use crate::dynamics::{Bristle, Deflection, Interval, LONG, Memory, State, Step};
use crate::error::ModelError;
use crate::formula::{Formula, OwnTerms};
use crate::sample::{Sample, Split};
use crate::scalar::{Real, Scalar};
use crate::table::{self, Channel, ParameterInfo, Pole, Presence, Role};

/// Which law, which terms by formula, which effects, which constants. Displays as
/// `law+effect+...`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spec {
    law: LawId,
    own: Option<Formula>,
    effects: EffectSet,
    constants: Constants<f64>,
}

impl Spec {
    /// From ids; the order of effects does not matter. A law of several elements takes their
    /// number with it: `gms:8`.
    ///
    /// # Errors
    /// An id that is unknown, an effect named twice or one that the law already has.
    pub fn new<'a>(
        law: &'a str,
        effects: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, ModelError<'a>> {
        let (id, elements) = cut(law, b':');
        let unknown = ModelError::UnknownLaw(law);
        let law = catalog::law(id).ok_or(unknown)?;
        let mut constants = Constants::default();
        if let Some(count) = elements {
            // A whole number: reading a float would link code that can panic.
            let count: u8 = count.parse().map_err(|_| unknown)?;
            if !law.info().constants.contains(&"elements")
                || constants.set("elements", count.into()) != Some(true)
            {
                return Err(unknown);
            }
        }
        let effects = effects_of(law, effects)?;
        Ok(Self { law, own: None, effects, constants })
    }

    /// From what it displays as, `law+effect+...`.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn parse(text: &str) -> Result<Self, ModelError<'_>> {
        let (law, mut rest) = cut(text, b'+');
        let effects = core::iter::from_fn(|| {
            let (effect, after) = cut(rest?, b'+');
            rest = after;
            Some(effect)
        });
        Self::new(law, effects)
    }

    /// A law by formula, with effects by their ids.
    ///
    /// # Errors
    /// An effect that is unknown or named twice.
    pub fn by_formula<'a>(
        formula: &Formula,
        effects: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, ModelError<'a>> {
        let law = LawId::ByFormula;
        let effects = effects_of(law, effects)?;
        Ok(Self { law, own: Some(*formula), effects, constants: Constants::default() })
    }

    /// Adds terms by formula to the law, before any effect acts. Their parameters come after those
    /// of the law.
    ///
    /// # Errors
    /// All terms by formula together are larger than a formula can be.
    pub fn add_terms(&mut self, formula: &Formula) -> Result<(), ModelError<'static>> {
        let joined = match &self.own {
            Some(own) => own.plus(formula).map_err(ModelError::Formula)?,
            None => *formula,
        };
        self.own = Some(joined);
        Ok(())
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

    /// The terms by formula, if there are any.
    #[must_use]
    pub const fn own(&self) -> Option<&Formula> {
        self.own.as_ref()
    }

    /// The effects.
    #[must_use]
    pub const fn effects(&self) -> EffectSet {
        self.effects
    }

    /// The constants of its law, then those of the effects in their order.
    pub fn constants(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        let law = self.law.info().constants.iter();
        let effects = self.effects.iter().flat_map(|effect| effect.info().constants);
        law.chain(effects).filter_map(|&name| Some((name, self.constants.get(name)?)))
    }

    /// Whether law or effects have the effect of this id.
    #[must_use]
    pub fn has(&self, id: &str) -> bool {
        self.law.info().captures.contains(&id) || self.effects.iter().any(|e| e.info().id == id)
    }

    /// Whether the torque depends on what went before.
    #[must_use]
    pub fn has_state(&self) -> bool {
        self.is_presliding() || self.effects.iter().any(EffectId::has_state)
    }

    /// Whether a state stands between dry friction and the torque.
    fn is_presliding(&self) -> bool {
        self.has(EffectId::Presliding.info().id)
    }

    /// What the state between dry friction and the torque consists of; those of effects start by
    /// themselves.
    #[must_use]
    pub fn memory(&self) -> Memory {
        match self.law.memory() {
            _ if !self.is_presliding() => Memory::None,
            _ if self.effects.contains(EffectId::Presliding) => Memory::Deflection,
            Memory::Elements => Memory::Forces(self.constants.element_count()),
            memory => memory,
        }
    }

    /// Columns it reads.
    pub fn channels(&self) -> impl Iterator<Item = Channel> + '_ {
        Channel::ALL.into_iter().filter(|channel| {
            *channel == Channel::Velocity
                || self.law.info().channels.contains(channel)
                || self.own.is_some_and(|own| own.reads(*channel))
                || self.effects.iter().any(|effect| effect.info().channels.contains(channel))
        })
    }

    /// The temperature at which the law has no limit, if there is one (degC).
    #[must_use]
    pub fn pole(&self) -> Option<f64> {
        self.law.info().pole.map(|pole| match pole {
            Pole::Zero => 0.0,
            Pole::Base => self.constants.base_temperature,
        })
    }

    /// Its parameters: those of the law, those of the terms by formula, then those of the effects
    /// in the order they act.
    pub fn parameters(&self) -> impl Iterator<Item = &'static ParameterInfo> + '_ {
        let law = self.law.info().parameters.iter();
        let own = self.own.iter().flat_map(Formula::parameters);
        let effects = self.effects.iter().flat_map(|effect| effect.info().parameters);
        law.chain(own).chain(effects).filter(|parameter| self.includes(parameter.presence))
    }

    /// How many parameters it has.
    #[must_use]
    pub fn parameter_count(&self) -> usize {
        self.parameters().count()
    }

    /// Whether the torque is linear in a parameter, all nonlinear ones held. Where friction depends
    /// on the motor torque, which itself follows from it, or where that saturates, it is not.
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

    /// The model with these numbers, in the order of [`Spec::parameters`].
    ///
    /// # Errors
    /// A wrong number of values, or a value at which a formula cannot be evaluated.
    pub fn with<S: Real>(&self, values: &[S]) -> Result<Composed<S>, ModelError<'static>> {
        table::check(|| self.parameters(), values)?;
        let mut values = values.iter().copied();
        let mut next = |presence| {
            let value = if self.includes(presence) { values.next() } else { None };
            value.unwrap_or_else(S::zero)
        };
        let law = self.law.read(&mut next);
        let own = self.own.as_ref().map(|own| OwnTerms::read(own, || next(Presence::InFormula)));
        let effects = Effects::read(self.effects, &mut next);
        let bristle = effects.bristle();
        let (memory, has_state) = (self.memory(), self.has_state());
        let constants = self.constants.cast();
        Ok(Composed { law, own, effects, bristle, memory, has_state, constants })
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
        if self.own.is_some() && self.law != LawId::ByFormula {
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

/// What stands before a character and what after it. Searches of `core` contain code that can panic.
fn cut(text: &str, at: u8) -> (&str, Option<&str>) {
    match text.bytes().position(|byte| byte == at) {
        Some(i) => (text.get(..i).unwrap_or_default(), text.get(i + 1..)),
        None => (text, None),
    }
}

/// The effects of these ids, none twice and none that the law has by itself.
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

/// A law and its effects with numbers: immutable, its state is kept apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composed<S: Real> {
    law: Law<S>,
    own: Option<OwnTerms<S>>,
    effects: Effects<S>,
    bristle: Option<Bristle<S>>,
    memory: Memory,
    has_state: bool,
    constants: Constants<S::Plain>,
}

impl<S: Real> Composed<S> {
    /// The effects with their parameters.
    #[must_use]
    pub const fn effects(&self) -> &Effects<S> {
        &self.effects
    }

    /// Whether the torque depends on what went before.
    #[must_use]
    pub const fn has_state(&self) -> bool {
        self.has_state
    }

    /// What the state between dry friction and the torque consists of.
    #[must_use]
    pub const fn memory(&self) -> Memory {
        self.memory
    }

    /// The torque at one instant, taken apart.
    #[inline]
    #[must_use]
    pub fn split(&self, sample: &Sample<S::Plain>) -> Split<S> {
        let split = self.law.split(sample, &self.constants);
        if self.effects.is_empty() && self.own.is_none() {
            return split;
        }
        // A copy, so that a law alone need not pass through memory.
        let mut altered = split;
        if let Some(own) = &self.own {
            own.add_to(&mut altered, sample);
        }
        self.effects.apply(&mut altered, sample, &self.constants);
        altered
    }

    /// The torque of a model without a state as it acts, in steady sliding (T).
    #[inline]
    pub(crate) fn acting_torque(&self, sample: &Sample<S::Plain>) -> S {
        let direction = sample.velocity.sign();
        if self.effects.is_empty() && self.own.is_none() {
            return self.law.torque(sample, direction, &self.constants);
        }
        self.split(sample).torque(direction)
    }

    /// The bristle that stands between dry friction and the torque, where it is one.
    #[inline(always)]
    #[must_use]
    pub fn bristle(&self, sample: &Sample<S::Plain>) -> Option<Bristle<S>> {
        self.bristle.or_else(|| self.law.bristle(sample, &self.constants))
    }

    /// The deflection that stands between dry friction and the torque, where its state is a single
    /// one.
    #[inline]
    #[must_use]
    pub fn deflection(&self, sample: &Sample<S::Plain>) -> Option<Deflection<S>>
    where
        S: Scalar,
    {
        match &self.bristle {
            Some(bristle) => Some(bristle.deflection(sample.velocity)),
            None => self.law.deflection(sample, &self.constants),
        }
    }

    /// As [`split`](Self::split), at the end of an interval; steps the states of effects.
    #[inline]
    fn split_over(&self, state: &mut State<S>, interval: &Interval<S::Plain>) -> Split<S> {
        let mut split = self.law.split(&interval.sample, &self.constants);
        if let Some(own) = &self.own {
            own.add_to(&mut split, &interval.sample);
        }
        self.effects.apply_over(&mut split, state, interval, &self.constants);
        split
    }

    /// Whether what its state does in a step can be found without it, so that several rows can be
    /// evaluated side by side: there is none, or that of a bristle alone.
    #[must_use]
    pub fn runs_side_by_side(&self) -> bool {
        let is_bristle = || self.bristle(&Sample::at(S::Plain::zero())).is_some();
        !self.has_state || (!self.effects.have_state() && is_bristle())
    }

    /// The torque in steady sliding, where dry friction acts along `sgn v` (T), as it is measured.
    #[inline]
    #[must_use]
    pub fn static_torque(&self, sample: &Sample<S::Plain>) -> S {
        self.measured(self.split(sample).torque(sample.velocity.sign()), sample)
    }

    /// What the torque channel shows of a friction torque (T).
    #[inline]
    #[must_use]
    pub fn measured(&self, friction: S, sample: &Sample<S::Plain>) -> S {
        self.effects.measured(friction, sample, &self.constants)
    }

    /// The state that a sample held for long leaves behind; at rest one without tension.
    #[must_use]
    pub fn settled(&self, sample: &Sample<S::Plain>) -> State<S> {
        let mut state = State::default();
        let dt = S::Plain::from_f64(LONG);
        self.over(&mut state, &Interval::held(*sample, dt));
        state
    }

    /// Holds `sample` for `dt` (s); a model without a memory has no use for `state` and `dt`.
    #[inline]
    pub fn step(&self, state: &mut State<S>, sample: &Sample<S::Plain>, dt: S::Plain) -> Step<S> {
        self.over(state, &Interval { mean: true, ..Interval::held(*sample, dt) })
    }

    /// As [`step`](Self::step), over an interval. The torque at its end is as it is measured; the
    /// mean, which does the work, as it acts.
    #[inline]
    pub fn over(&self, state: &mut State<S>, interval: &Interval<S::Plain>) -> Step<S> {
        let split = if self.has_state {
            self.split_over(state, interval)
        } else {
            self.split(&interval.sample)
        };
        let step = if matches!(self.memory, Memory::None) {
            Step::same(split.torque(interval.sample.velocity.sign()))
        } else {
            let dry = state.dry_over(split.dry(), interval);
            match self.bristle(&interval.sample) {
                Some(bristle) => bristle.over(&mut state.bristle, dry, &split, interval),
                None => self.law.step(state, dry, &split, interval, &self.constants),
            }
        };
        let torque = self.effects.measured(step.torque, &interval.sample, &self.constants);
        Step { torque, ..step }
    }
}
