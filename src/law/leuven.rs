//! The modified Leuven law (Lampaert, Swevers and Al-Bender 2002).

use super::FrictionLaw;
use super::elements::{self, ElementParameters};
use crate::constants::Constants;
use crate::dynamics::{Interval, LeuvenBristle, Memory, State, Step};
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{LawInfo, ParameterInfo, Parameters, Presence, parameters};

parameters! {
    /// The parameters that all elements of the Leuven law share.
    Shared {
        /// Torque per deflection rate.
        bristle_damping: "s1" ["T s/X"] 0.0 .. 5.0, start 0.0, Damping, Rate;
        /// Torque per speed.
        viscous_friction: "s2" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Height of the Stribeck curve above the friction in full sliding, at rest.
        stribeck_height: "dFs" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "delta" ["1"] 0.5 .. 4.0, start 2.0, None, Nonlinear;
    }
}

/// Modified Leuven: one deflection whose hysteresis force is that of Maxwell slip elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leuven<S> {
    shared: Shared<S>,
    elements: ElementParameters<S>,
}

impl<S: Real> Parameters<S> for Leuven<S> {
    const TABLE: &'static [ParameterInfo] =
        &elements::with_elements::<37>(<Shared<S> as Parameters<S>>::TABLE);

    #[inline]
    fn read(mut next: impl FnMut(Presence) -> S) -> Self {
        Self { shared: Shared::read(&mut next), elements: ElementParameters::read(&mut next) }
    }
}

impl<S: Real> FrictionLaw<S> for Leuven<S> {
    const INFO: LawInfo = LawInfo {
        id: "leuven",
        title: "Leuven, Maxwell slip form",
        source: "Lampaert, Swevers and Al-Bender 2002, with n = 1: the elements shape the transition",
        formula: "f + s1 dz/dt + s2 v; dz/dt = v (1 - f sgn v/s); f = f_1 + ... + f_N, \
                  df_i = ki dz while |f_i| <= W_i; s = F + dFs exp(-|v/vs|^delta), \
                  F = F1 + ... + FN, W_i = Fi (F + dFs)/F",
        parameters: Self::TABLE,
        channels: &[],
        constants: &["elements"],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "presliding"],
    };

    const MEMORY: Memory = Memory::Elements;

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S> {
        let v = sample.velocity;
        Split {
            coulomb: self.elements.coulomb(constants.element_count()),
            height: self.shared.stribeck_height,
            shape: stribeck_curve(v, self.shared.stribeck_velocity, self.shared.stribeck_exponent),
            rate: self.shared.viscous_friction.scale(v),
            ..Split::zero()
        }
    }

    #[inline]
    fn step(
        &self,
        state: &mut State<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
        constants: &Constants<S::Plain>,
    ) -> Step<S> {
        let bristle = LeuvenBristle {
            friction: &self.elements.friction,
            stiffness: &self.elements.stiffness,
            count: constants.element_count(),
            damping: self.shared.bristle_damping,
        };
        bristle.step_over(&mut state.elements, dry, split, interval)
    }
}
