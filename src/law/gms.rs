//! Generalized Maxwell slip (Al-Bender, Lampaert and Swevers 2005).

use super::FrictionLaw;
use super::elements::{self, ElementParameters};
use crate::constants::Constants;
use crate::dynamics::{Interval, MaxwellSlip, Memory, State, Step};
use crate::sample::{Sample, Split, stribeck_curve};
use crate::scalar::Real;
use crate::table::{LawInfo, ParameterInfo, Parameters, Presence, parameters};

parameters! {
    /// The parameters that all elements of the generalized Maxwell slip law share.
    Shared {
        /// Height of the Stribeck curve above the friction in full sliding, at rest.
        stribeck_height: "dFs" ["T"] 0.0 .. 10.0, start 0.2, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Exponent of the Stribeck curve.
        stribeck_exponent: "alpha" ["1"] 0.5 .. 4.0, start 2.0, None, Nonlinear;
        /// Rate at which the force of a sliding element settles.
        attraction: "C" ["T/s"] 0.1 .. 1e6, start 100.0, TorqueRate, Nonlinear;
        /// Torque per speed.
        viscous_friction: "s2" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
    }
}

/// Generalized Maxwell slip: parallel elements that stick or slide, with nonlocal memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gms<S> {
    shared: Shared<S>,
    elements: ElementParameters<S>,
}

impl<S: Real> Parameters<S> for Gms<S> {
    const TABLE: &'static [ParameterInfo] =
        &elements::with_elements::<37>(<Shared<S> as Parameters<S>>::TABLE);

    #[inline]
    fn read(mut next: impl FnMut(Presence) -> S) -> Self {
        Self { shared: Shared::read(&mut next), elements: ElementParameters::read(&mut next) }
    }
}

impl<S: Real> FrictionLaw<S> for Gms<S> {
    const INFO: LawInfo = LawInfo {
        id: "gms",
        title: "Generalized Maxwell slip",
        source: "Al-Bender, Lampaert and Swevers 2005, eqs 18-20; without damping of the elements",
        formula: "f_1 + ... + f_N + s2 v; sticking df_i/dt = ki v until f_i sgn v = a_i s, then \
                  sliding df_i/dt = C (a_i sgn v - f_i/s) until v passes through 0; \
                  s = F + dFs exp(-|v/vs|^alpha), F = F1 + ... + FN, a_i = Fi/F",
        parameters: Self::TABLE,
        channels: &[],
        constants: &["elements"],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "presliding", "frictional_lag"],
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
        let slip = MaxwellSlip {
            friction: &self.elements.friction,
            stiffness: &self.elements.stiffness,
            count: constants.element_count(),
            attraction: self.shared.attraction,
        };
        slip.step_over(&mut state.elements, dry, split, interval)
    }
}
