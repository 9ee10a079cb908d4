//! The elastoplastic law (Dupont, Hayward, Armstrong and Altpeter 2002).

use super::FrictionLaw;
use super::curves::gaussian_curve;
use crate::constants::Constants;
use crate::dynamics::{Approach, Deflection, ElastoplasticBristle, Interval, State, Step};
use crate::sample::{Sample, Split};
use crate::scalar::{Real, Scalar};
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// A bristle that is elastic up to a share of its deflection in full sliding, so that it does
    /// not drift under a small torque.
    Elastoplastic {
        /// Torque per deflection before sliding.
        bristle_stiffness: "s0" ["T/X"] 0.5 .. 2e6, start 50.0, Stiffness, Nonlinear;
        /// Torque per deflection rate.
        bristle_damping: "s1" ["T s/X"] 0.0 .. 5.0, start 0.0, Damping, Rate;
        /// Torque per speed.
        viscous_friction: "s2" ["T s/X"] 0.0 .. 10.0, start 0.1, Damping, Rate;
        /// Dry friction in full sliding.
        coulomb_friction: "Fc" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Dry friction at break-away, Coulomb friction included.
        static_friction: "Fs" ["T"] 0.0 .. 10.0, start 0.7, Torque, Dry;
        /// Speed at which the Stribeck curve has fallen to 1/e.
        stribeck_velocity: "vs" ["X/s"] 0.002 .. 1.0, start 0.1, Speed, Nonlinear;
        /// Ratio of the deflection up to which the bristle is elastic to that in full sliding.
        breakaway_ratio: "b" ["1"] 0.01 .. 0.99, start 0.5, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for Elastoplastic<S> {
    const INFO: LawInfo = LawInfo {
        id: "elastoplastic",
        title: "Elastoplastic",
        source: "Dupont, Hayward, Armstrong and Altpeter 2002, eqs 8-14, zb = b zm",
        formula: "s0 z + s1 dz/dt + s2 v; dz/dt = v (1 - a z sgn v/zm), zm = g/s0, zb = b zm; a = 0 for \
                  z sgn v < zb, 1 for z sgn v > zm, (1 + sin(pi (|z| - (zm + zb)/2)/(zm - zb)))/2 \
                  between; g = Fc + (Fs - Fc) exp(-(v/vs)^2)",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "viscous", "stribeck", "presliding"],
    };

    #[inline]
    fn split(&self, sample: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split {
            coulomb: self.coulomb_friction,
            height: self.static_friction - self.coulomb_friction,
            shape: gaussian_curve(sample.velocity, self.stribeck_velocity),
            rate: self.viscous_friction.scale(sample.velocity),
            ..Split::zero()
        }
    }

    #[inline]
    fn deflection(
        &self,
        sample: &Sample<S::Plain>,
        _: &Constants<S::Plain>,
    ) -> Option<Deflection<S>>
    where
        S: Scalar,
    {
        Some(Deflection {
            stiffness: self.bristle_stiffness,
            drag: self.bristle_damping.scale(sample.velocity.abs()),
            approach: Approach::Elastoplastic(self.breakaway_ratio),
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
        let bristle = ElastoplasticBristle {
            stiffness: self.bristle_stiffness,
            damping: self.bristle_damping,
            breakaway: self.breakaway_ratio,
        };
        bristle.step_over(&mut state.bristle, dry, split, interval)
    }
}
