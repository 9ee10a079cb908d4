//! A bristle around any split law, stepped exactly for a velocity held over the step.
//!
//! `dz/dt = v - s0 |v|/D z`, `tf = s0 z + s1 dz/dt + V + additive` (Canudas de Wit et al. 1995,
//! eqs 4-6, with any dry magnitude `D`). With `x = s0 |v| dt/D` the solution is
//! `z+ = e^-x z + v dt phi_1(-x)`: stable and free of overshoot for every stiffness and step.

use super::{Interval, Step};
use crate::sample::Split;
use crate::scalar::Real;

/// Above this `x` the bristle has forgotten where it was: `e^-700 < 1e-304`.
const SATURATED: f64 = 700.0;

/// Parameters of a bristle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristle<S> {
    /// Stiffness `s0` (T/X).
    pub stiffness: S,
    /// Damping `s1` (T s/X).
    pub damping: S,
}

/// State of a bristle, kept apart from its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BristleState<S> {
    /// Mean deflection `z` (X).
    pub z: S,
}

impl<S: Real> Default for BristleState<S> {
    fn default() -> Self {
        Self { z: S::zero() }
    }
}

impl<S: Real> Bristle<S> {
    /// Steps over `interval`.
    #[inline]
    pub fn over(
        &self,
        state: &mut BristleState<S>,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        if interval.mean {
            return self.step(state, split, interval.velocity, interval.dt);
        }
        Step::same(self.step_to(state, split, interval.velocity, interval.dt))
    }

    /// Holds `velocity` and `split` for `dt` (s). With `dt <= 0` the state stays as it is.
    ///
    /// At rest the deflection is kept. A magnitude `D <= 0` has no bristle; the limit
    /// `z = sgn(v) D/s0` is used, so that a fit passing through it sees a finite slope.
    #[inline]
    pub fn step(
        &self,
        state: &mut BristleState<S>,
        split: &Split<S>,
        velocity: S::Plain,
        dt: S::Plain,
    ) -> Step<S> {
        let z = state.z;
        let (torque, path) = self.advance(state, split, velocity, dt);
        let mean_torque = match path {
            Path::Rest => torque,
            Path::Saturated { dry, travel } if dt.value() > 0.0 => {
                // The mean still holds the transient's area, (z - end)/x.
                let area = (z - state.z) * (dry / travel);
                let slip = (state.z - z).scale(S::Plain::one() / dt);
                torque + self.stiffness * area + self.damping * slip
            }
            Path::Saturated { .. } => torque,
            Path::Transient { y, phi, slip } => {
                let mean = z + (y.phi(2) * slip).scale(dt);
                self.stiffness * mean + self.damping * (phi * slip) + split.rate + split.additive
            }
        };
        Step { torque, mean_torque }
    }

    /// As [`step`](Self::step), for the torque at the end of the step alone.
    #[inline]
    pub fn step_to(
        &self,
        state: &mut BristleState<S>,
        split: &Split<S>,
        velocity: S::Plain,
        dt: S::Plain,
    ) -> S {
        self.advance(state, split, velocity, dt).0
    }

    #[inline]
    fn advance(
        &self,
        state: &mut BristleState<S>,
        split: &Split<S>,
        velocity: S::Plain,
        dt: S::Plain,
    ) -> (S, Path<S>) {
        let s0 = self.stiffness;
        let speed = velocity.abs();
        if speed.value() == 0.0 {
            return (s0 * state.z + split.rate + split.additive, Path::Rest);
        }
        let dry = split.dry();
        let dt = if dt.value() > 0.0 { dt } else { S::Plain::zero() };
        let pull = s0.scale(speed);
        if pull.value() * dt.value() >= SATURATED * dry.value() {
            state.z = (dry / s0).scale(velocity.sign());
            let torque = s0 * state.z + split.rate + split.additive;
            return (torque, Path::Saturated { dry, travel: pull.scale(dt) });
        }
        // dz/dt decays exponentially, so it is carried forward rather than differenced.
        let pace = pull / dry;
        let y = pace.scale(-dt);
        let phi = y.phi(1);
        let decay = (y * phi).shift(S::Plain::one());
        let slip = (-(pace * state.z)).shift(velocity);
        state.z.add_scaled(&(phi * slip), dt);
        let torque = s0 * state.z + self.damping * (decay * slip) + split.rate + split.additive;
        (torque, Path::Transient { y, phi, slip })
    }
}

/// How a step went, and what its mean takes from there.
enum Path<S> {
    Rest,
    Saturated { dry: S, travel: S },
    Transient { y: S, phi: S, slip: S },
}
