//! A bristle around any split law, stepped exactly for a velocity held over the step.
//!
//! `dz/dt = v - s0 |v|/D z`, `tf = s0 z + s1 dz/dt + V + additive` (Canudas de Wit et al. 1995,
//! eqs 4-6, with any dry magnitude `D`). With `x = s0 |v| dt/D` the solution is
//! `z+ = e^-x z + v dt phi_1(-x)`: stable and free of overshoot for every stiffness and step.

use super::{Interval, SATURATED, Step, following};
use crate::sample::Split;
use crate::scalar::{Real, Scalar};

/// A bristle that settles faster than this (s) has settled in any step.
const SHORTEST: f64 = 1e-12;

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

impl<S: Scalar> Default for BristleState<S> {
    fn default() -> Self {
        Self { z: S::zero() }
    }
}

impl<S: Scalar> Bristle<S> {
    /// Steps over `interval` with the dry magnitude `dry` held; `split` is that of the sample, with
    /// which the torque is read.
    #[inline]
    pub fn over(
        &self,
        state: &mut BristleState<S>,
        dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
    ) -> Step<S> {
        let held = Held { dry, velocity: interval.velocity(), dt: interval.dt };
        let before = state.z;
        let path = self.advance(state, &held);
        let torque = if interval.mean_velocity.is_some() {
            let end = split.dry();
            let moved = (end - dry) / self.stiffness;
            state.z += moved.scale(held.velocity.sign()) * path.following();
            let rate = self.rate(state.z, end, interval.sample.velocity);
            self.stiffness * state.z + self.damping * rate + split.rate + split.additive
        } else {
            self.torque(state, split, &path)
        };
        if !interval.mean {
            return Step::same(torque);
        }
        Step { torque, mean_torque: self.mean_torque(before, state, split, &held, &path) }
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
        let held = Held { dry: split.dry(), velocity, dt };
        let before = state.z;
        let path = self.advance(state, &held);
        let torque = self.torque(state, split, &path);
        Step { torque, mean_torque: self.mean_torque(before, state, split, &held, &path) }
    }

    #[inline]
    fn advance(&self, state: &mut BristleState<S>, held: &Held<S>) -> Path<S> {
        let Held { dry, velocity, dt } = *held;
        let speed = velocity.abs();
        if speed.value() == 0.0 {
            return Path::Rest;
        }
        let dt = if dt.value() > 0.0 { dt } else { S::Plain::zero() };
        let pull = self.stiffness.scale(speed);
        if pull.value() * dt.value().max(SHORTEST) >= SATURATED * dry.value() {
            if dt.value() > 0.0 {
                state.z = self.settled(held);
            }
            return Path::Saturated { travel: pull.scale(dt) };
        }
        // dz/dt decays exponentially, so it is carried forward rather than differenced.
        let pace = pull / dry;
        let y = pace.scale(-dt);
        let phi = y.phi(1);
        let slip = (-(pace * state.z)).shift(velocity);
        state.z.add_scaled(&(phi * slip), dt);
        Path::Transient { y, phi, slip }
    }

    /// Where the deflection tends to.
    #[inline]
    fn settled(&self, held: &Held<S>) -> S {
        (held.dry / self.stiffness).scale(held.velocity.sign())
    }

    /// Torque at the end of the step, with the velocity that was held.
    #[inline]
    fn torque(&self, state: &BristleState<S>, split: &Split<S>, path: &Path<S>) -> S {
        let elastic = self.stiffness * state.z;
        match path {
            Path::Rest | Path::Saturated { .. } => elastic + split.rate + split.additive,
            Path::Transient { y, phi, slip } => {
                let decay = (*y * *phi).shift(S::Plain::one());
                elastic + self.damping * (decay * *slip) + split.rate + split.additive
            }
        }
    }

    /// `dz/dt` at `z`; 0 of a bristle that has settled at once.
    #[inline]
    fn rate(&self, z: S, dry: S, velocity: S::Plain) -> S {
        let pull = self.stiffness.scale(velocity.abs());
        if pull.value() * SHORTEST >= SATURATED * dry.value() {
            return S::zero();
        }
        (-(pull / dry * z)).shift(velocity)
    }

    #[inline]
    fn mean_torque(
        &self,
        before: S,
        state: &BristleState<S>,
        split: &Split<S>,
        held: &Held<S>,
        path: &Path<S>,
    ) -> S {
        let dt = held.dt;
        let steady = split.rate + split.additive;
        match path {
            Path::Rest => self.stiffness * state.z + steady,
            Path::Saturated { travel } if dt.value() > 0.0 => {
                // The mean still holds the transient's area, (z - end)/x.
                let area = (before - state.z) * (held.dry / *travel);
                let slip = (state.z - before).scale(S::Plain::one() / dt);
                self.stiffness * (state.z + area) + self.damping * slip + steady
            }
            Path::Saturated { .. } => self.stiffness * state.z + steady,
            Path::Transient { y, phi, slip } => {
                // Counted from where the deflection is for most of the step, nothing cancels.
                let mean = if y.value() < -1.0 {
                    let settled = self.settled(held);
                    settled + (before - settled) * *phi
                } else {
                    before + (y.phi(2) * *slip).scale(dt)
                };
                self.stiffness * mean + self.damping * (*phi * *slip) + steady
            }
        }
    }
}

/// What stays the same over a step.
struct Held<S: Scalar> {
    dry: S,
    velocity: S::Plain,
    dt: S::Plain,
}

/// How a step went, and what is read from it.
enum Path<S> {
    Rest,
    Saturated { travel: S },
    Transient { y: S, phi: S, slip: S },
}

impl<S: Scalar> Path<S> {
    /// How far the deflection has followed where it tends to.
    #[inline]
    fn following(&self) -> S {
        match self {
            Self::Rest => S::zero(),
            Self::Saturated { .. } => S::one(),
            Self::Transient { y, phi, .. } => following(*y, *phi),
        }
    }
}
