//! The laws and effects by id. Their lists are in `src/law/mod.rs` and `src/effect/mod.rs`.

use crate::constants::Constants;
use crate::dynamics::{Bristle, Deflection, History, Interval, Memory, State, Step};
use crate::effect::{self, FrictionEffect};
use crate::law::{self, FrictionLaw};
use crate::sample::{Sample, Split};
use crate::scalar::{Real, Scalar};
use crate::table::Parameters;

pub use crate::constants::CONSTANTS;
pub use crate::table::{
    ConstantInfo, EffectInfo, LawInfo, ParameterInfo, Pole, Presence, Role, Scale,
};

macro_rules! laws {
    ($($file:ident::$law:ident),+; $formula_file:ident::$by_formula:ident) => {
        /// The id of a law.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs)]
        pub enum LawId {
            $($law,)+
            $by_formula,
        }

        /// A law with its parameter values.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) enum Law<S> {
            $($law(law::$law<S>),)+
            $by_formula(law::$by_formula<S>),
        }

        impl LawId {
            /// All laws of the catalog, without that of a formula.
            pub const ALL: &[Self] = &[$(Self::$law,)+];

            /// Its table.
            #[must_use]
            pub const fn info(self) -> &'static LawInfo {
                match self {
                    $(Self::$law => const { &<law::$law<f64> as FrictionLaw<f64>>::INFO },)+
                    Self::$by_formula => const { &<law::$by_formula<f64> as FrictionLaw<f64>>::INFO },
                }
            }

            /// The kind of its state, if it has memory.
            #[must_use]
            pub const fn memory(self) -> Memory {
                match self {
                    $(Self::$law => <law::$law<f64> as FrictionLaw<f64>>::MEMORY,)+
                    Self::$by_formula => <law::$by_formula<f64> as FrictionLaw<f64>>::MEMORY,
                }
            }

            /// The law with the parameters that `next` returns.
            #[inline]
            pub(crate) fn read<S: Real>(self, next: impl FnMut(Presence) -> S) -> Law<S> {
                match self {
                    $(Self::$law => Law::$law(law::$law::read(next)),)+
                    Self::$by_formula => Law::$by_formula(law::$by_formula::read(next)),
                }
            }
        }

        impl<S: Real> Law<S> {
            /// The torque at one sample, by its parts.
            #[inline(always)]
            pub fn split(
                &self,
                sample: &Sample<S::Plain>,
                constants: &Constants<S::Plain>,
            ) -> Split<S> {
                match self {
                    $(Self::$law(law) => law.split(sample, constants),)+
                    Self::$by_formula(law) => law.split(sample, constants),
                }
            }

            /// The torque in steady sliding along `direction`; computes only the parts that this
            /// needs.
            #[inline]
            pub fn torque(
                &self,
                sample: &Sample<S::Plain>,
                direction: S::Plain,
                constants: &Constants<S::Plain>,
            ) -> S {
                match self {
                    $(Self::$law(law) => law.split(sample, constants).torque(direction),)+
                    Self::$by_formula(law) => law.split(sample, constants).torque(direction),
                }
            }

            /// The bristle at this sample, if the state is a bristle.
            #[inline(always)]
            pub fn bristle(
                &self,
                sample: &Sample<S::Plain>,
                constants: &Constants<S::Plain>,
            ) -> Option<Bristle<S>> {
                match self {
                    $(Self::$law(law) => law.bristle(sample, constants),)+
                    Self::$by_formula(law) => law.bristle(sample, constants),
                }
            }

            /// The equation of the deflection, if the state is a single deflection.
            #[inline]
            pub fn deflection(
                &self,
                sample: &Sample<S::Plain>,
                constants: &Constants<S::Plain>,
            ) -> Option<Deflection<S>>
            where
                S: Scalar,
            {
                match self {
                    $(Self::$law(law) => law.deflection(sample, constants),)+
                    Self::$by_formula(law) => law.deflection(sample, constants),
                }
            }

            /// Steps over an interval in which dry friction is constant.
            #[inline]
            pub fn step(
                &self,
                state: &mut State<S>,
                dry: S,
                split: &Split<S>,
                interval: &Interval<S::Plain>,
                constants: &Constants<S::Plain>,
            ) -> Step<S> {
                match self {
                    $(Self::$law(law) => law.step(state, dry, split, interval, constants),)+
                    Self::$by_formula(law) => law.step(state, dry, split, interval, constants),
                }
            }
        }
    };
}

macro_rules! effects {
    ($($id:ident: $effect:ident),+ $(,)?) => {
        /// The id of an effect.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[allow(missing_docs)]
        pub enum EffectId {
            $($effect,)+
        }

        impl EffectId {
            /// All effects, in the order in which they act.
            pub const ALL: &[Self] = &[$(Self::$effect,)+];

            /// Its table.
            #[must_use]
            pub const fn info(self) -> &'static EffectInfo {
                match self {
                    $(Self::$effect => {
                        const { &<effect::$effect<f64> as FrictionEffect<f64>>::INFO }
                    })+
                }
            }

            /// Whether it has a state, separate from that of a bristle.
            #[must_use]
            pub const fn has_state(self) -> bool {
                match self {
                    $(Self::$effect => <effect::$effect<f64> as FrictionEffect<f64>>::HAS_STATE,)+
                }
            }
        }

        /// Effects with their parameter values.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct Effects<S> {
            present: EffectSet,
            $(pub(crate) $id: Option<effect::$effect<S>>,)+
        }

        impl<S: Real> Effects<S> {
            /// The effects of `set`, with the parameters that `next` returns.
            #[inline]
            pub fn read(set: EffectSet, mut next: impl FnMut(Presence) -> S) -> Self {
                Self {
                    present: set,
                    $($id: set
                        .contains(EffectId::$effect)
                        .then(|| effect::$effect::read(&mut next)),)+
                }
            }

            /// Whether there are no effects.
            #[inline]
            pub fn is_empty(&self) -> bool {
                self.present == EffectSet::NONE
            }

            /// The sample that acts, where the sensors show another one.
            #[inline(always)]
            pub fn acting(&self, sample: &Sample<S::Plain>) -> Sample<S::Plain> {
                let mut acting = *sample;
                $(if let Some(effect) = &self.$id {
                    effect.put_right(&mut acting);
                })+
                acting
            }

            /// Applies the effects to the split, in their order.
            #[inline]
            pub fn apply(
                &self,
                split: &mut Split<S>,
                sample: &Sample<S::Plain>,
                constants: &Constants<S::Plain>,
            ) {
                $(if let Some(effect) = &self.$id {
                    effect.apply(split, sample, constants);
                })+
            }

            /// Like [`apply`](Self::apply), at the end of an interval; steps the states of effects.
            #[inline]
            pub fn apply_over(
                &self,
                split: &mut Split<S>,
                history: &mut impl History<S>,
                interval: &Interval<S::Plain>,
                constants: &Constants<S::Plain>,
            ) {
                $(if let Some(effect) = &self.$id {
                    effect.apply_over(split, history, interval, constants);
                })+
            }

            /// The measured value of a friction torque.
            #[inline]
            pub fn measured(
                &self,
                friction: S,
                sample: &Sample<S::Plain>,
                constants: &Constants<S::Plain>,
            ) -> S {
                $(let friction = match &self.$id {
                    Some(effect) => effect.measured(friction, sample, constants),
                    None => friction,
                };)+
                friction
            }

            /// The bristle that an effect adds, if any.
            #[inline]
            pub fn bristle(&self) -> Option<Bristle<S>> {
                None$(.or_else(|| self.$id.as_ref().and_then(FrictionEffect::bristle)))+
            }
        }
    };
}

crate::law::every_law!(laws);
crate::effect::every_effect!(effects);

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EffectSet(u32);

impl EffectSet {
    /// No effect.
    pub const NONE: Self = Self(0);

    /// Whether the set has this effect.
    #[inline]
    #[must_use]
    pub const fn contains(self, id: EffectId) -> bool {
        self.0 & (1 << id as u32) != 0
    }

    /// The set with this effect.
    #[must_use]
    pub const fn with(self, id: EffectId) -> Self {
        Self(self.0 | (1 << id as u32))
    }

    /// The effects in the order in which they act.
    pub fn iter(self) -> impl Iterator<Item = EffectId> + Clone {
        EffectId::ALL.iter().copied().filter(move |&id| self.contains(id))
    }
}

/// The law of this id.
#[must_use]
pub fn law(id: &str) -> Option<LawId> {
    LawId::ALL.iter().copied().find(|law| law.info().id == id)
}

/// The effect of this id.
#[must_use]
pub fn effect(id: &str) -> Option<EffectId> {
    EffectId::ALL.iter().copied().find(|effect| effect.info().id == id)
}
