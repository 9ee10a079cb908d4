//! Dahl's law (Dahl 1968).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::dynamics::{Approach, DahlBristle, Deflection, Interval, State, Step};
use crate::sample::{Sample, Split};
use crate::scalar::{Real, Scalar};
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Dahl: a deflection that approaches sliding as a power of the remaining distance.
    Dahl {
        /// Torque per deflection before sliding.
        bristle_stiffness: "a1" ["T/X"] 0.5 .. 2e6, start 50.0, Stiffness, Nonlinear;
        /// Dry friction in full sliding.
        coulomb_friction: "a2" ["T"] 0.0 .. 1e2, start 0.5 drawn 0.0 .. 10.0, Torque, Dry;
        /// Exponent of the approach to sliding: exponential with 1, slower above 1.
        dahl_exponent: "a3" ["1"] 0.1 .. 100.0, start 1.0 drawn 0.1 .. 50.0, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Dahl<S> {
    const INFO: LawInfo = LawInfo {
        id: "dahl",
        title: "Dahl",
        source: "Dahl 1968; UR5e review 2024/25, table 3",
        formula: "a1 z; dz/dt = v sgn(u) |u|^a3, u = 1 - sgn(v) a1 z/a2",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "presliding"],
    };

    #[inline]
    fn split(&self, _: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split { coulomb: self.coulomb_friction, ..Split::zero() }
    }

    #[inline]
    fn deflection(&self, _: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Option<Deflection<S>>
    where
        S: Scalar,
    {
        Some(Deflection {
            stiffness: self.bristle_stiffness,
            drag: S::zero(),
            approach: Approach::Power(self.dahl_exponent),
        })
    }

    #[inline]
    fn step(
        &self,
        state: &mut State<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
        _: &Constants<S::Plain>,
    ) -> Step<S> {
        let bristle =
            DahlBristle { stiffness: self.bristle_stiffness, exponent: self.dahl_exponent };
        bristle.step_over(&mut state.bristle, dry, split, interval)
    }
}
