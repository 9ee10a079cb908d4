//! Presliding: a bristle for any static law.

use super::FrictionEffect;
use crate::dynamics::Bristle;
use crate::scalar::Real;
use crate::table::{EffectInfo, Parameters, parameters};

parameters! {
    /// A bristle in place of the sign of the velocity.
    Presliding {
        /// Torque per deflection before sliding.
        presliding_stiffness: "s0" ["T/X"] 0.5 .. 2e6, start 50.0, Stiffness, Nonlinear;
        /// Torque per deflection rate.
        presliding_damping: "s1" ["T s/X"] 0.0 .. 5.0, start 0.0, Damping, Rate;
    }
}

impl<S: Real> FrictionEffect<S> for Presliding<S> {
    const INFO: EffectInfo = EffectInfo {
        id: "presliding",
        group: "friction",
        title: "Presliding",
        what: "Contacts bend before they slide, so torque follows displacement after a reversal.",
        formula: "s0 z + s1 dz/dt + V; dz/dt = v - s0 |v|/D z",
        needs: "several samples within the presliding distance after a reversal",
        beyond: None,
        channels: &[],
        constants: &[],
        parameters: Self::TABLE,
    };

    #[inline]
    fn bristle(&self) -> Option<Bristle<S>> {
        Some(Bristle::new(self.presliding_stiffness, self.presliding_damping))
    }
}
