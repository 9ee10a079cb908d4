//! A bristle around any split law, stepped exactly for a velocity held over the step.
//!
//! `dz/dt = v - s0 |v|/D z`, `tf = s0 z + s1 dz/dt + V + additive` (Canudas de Wit et al. 1995,
//! eqs 4-6, with any dry magnitude `D`). With `x = s0 |v| dt/D` the solution is
//! `z+ = e^-x z + v dt phi_1(-x)`: stable and free of overshoot for every stiffness and step.

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

/// What one step yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S> {
    /// Torque at the end of the step (T).
    pub torque: S,
    /// Torque averaged over the step (T): times `v dt` it is the exact work.
    pub mean_torque: S,
}

impl<S: Real> Bristle<S> {
    /// Holds `velocity` and `split` for `dt` (s). With `dt <= 0` the state stays as it is.
    ///
    /// At rest the deflection is kept. A magnitude `D <= 0` has no bristle; the limit
    /// `z = sgn(v) D/s0` is used, so that a fit passing through it sees a finite slope.
    #[inline]
    pub fn step(
        &self,
        state: &mut BristleState<S>,
        split: &Split<S>,
        velocity: S,
        dt: S,
    ) -> Step<S> {
        let (s0, z) = (self.stiffness, state.z);
        let smooth = split.rate + split.additive;
        let speed = velocity.abs();
        if speed.value() == 0.0 {
            let torque = s0 * z + smooth;
            return Step { torque, mean_torque: torque };
        }
        let dry = split.dry();
        let dt = if dt.value() > 0.0 { dt } else { S::zero() };
        let travel = s0 * speed * dt;
        if travel.value() >= SATURATED * dry.value() {
            let end = velocity.sign() * dry / s0;
            state.z = end;
            let torque = s0 * end + smooth;
            // The mean still holds the transient's area, (z - end)/x.
            let area = if dt.value() > 0.0 { (z - end) * (dry / travel) } else { S::zero() };
            let slip = if dt.value() > 0.0 { (end - z) / dt } else { S::zero() };
            return Step { torque, mean_torque: torque + s0 * area + self.damping * slip };
        }
        // dz/dt decays exponentially, so it is carried forward rather than differenced.
        let y = -travel / dry;
        let phi = y.phi(1);
        let decay = S::one() + y * phi;
        let slip = velocity - s0 * speed * z / dry;
        let end = z + dt * phi * slip;
        state.z = end;
        let mean = z + dt * y.phi(2) * slip;
        Step {
            torque: s0 * end + self.damping * (decay * slip) + smooth,
            mean_torque: s0 * mean + self.damping * (phi * slip) + smooth,
        }
    }
}
