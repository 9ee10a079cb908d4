//! The second-order law of Bliman and Sorine (1995; Olsson et al. 1998).

use super::FrictionLaw;
use crate::constants::Constants;
use crate::dynamics::{Interval, Memory, Relaxation, State, Step};
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters, parameters};

parameters! {
    /// Bliman and Sorine, second order: a fast force along the motion minus a slow one, so that
    /// friction peaks after a reversal. It depends on the distance, not on the speed.
    BlimanSorine {
        /// Dry friction in full sliding, `f1 - f2`.
        coulomb_friction: "Fc" ["T"] 0.0 .. 10.0, start 0.5, Torque, Dry;
        /// Ratio of the slow force to the friction in full sliding, `f2/(f1 - f2)`.
        overshoot_ratio: "rho" ["1"] 0.0 .. 10.0, start 0.3, None, Nonlinear;
        /// Distance over which the slow force builds up.
        sliding_distance: "eps" ["X"] 1e-6 .. 10.0, start 0.05, Position, Nonlinear;
        /// Ratio of the distance of the fast force to that of the slow one.
        distance_ratio: "eta" ["1"] 0.001 .. 1.0, start 0.3, None, Nonlinear;
    }
}

impl<S: Real> FrictionLaw<S> for BlimanSorine<S> {
    const INFO: LawInfo = LawInfo {
        id: "bliman_sorine",
        title: "Bliman and Sorine",
        source: "Bliman and Sorine 1995, second order; Olsson et al. 1998",
        formula: "x1 + x2; dx1/dt = |v| (f1 sgn v - x1)/(eta eps); dx2/dt = -|v| (f2 sgn v + x2)/eps; \
                  f1 = (1 + rho) Fc, f2 = rho Fc",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &["coulomb", "presliding"],
    };

    const MEMORY: Memory = Memory::Forces(2);

    #[inline]
    fn split(&self, _: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split { coulomb: self.coulomb_friction, ..Split::zero() }
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
        let direction = interval.velocity().sign();
        let fast = self.overshoot_ratio.shift(S::Plain::one());
        let slow = -self.overshoot_ratio;
        let (mut torque, mut mean) = (split.rate + split.additive, split.rate + split.additive);
        let parts =
            [(fast, self.distance_ratio * self.sliding_distance), (slow, self.sliding_distance)];
        for ((share, hold), force) in parts.into_iter().zip(&mut state.elements.force) {
            let target = (share * dry).scale(direction);
            let relaxation = Relaxation { target, pull: S::one(), hold };
            let relaxed = relaxation.step_over(*force, interval.travel());
            *force = relaxed.end;
            if interval.mean_velocity.is_some() {
                let moved = (share * (split.dry() - dry)).scale(direction);
                *force += moved * relaxed.following();
            }
            torque += *force;
            mean += relaxed.mean;
        }
        if interval.mean { Step { torque, mean_torque: mean } } else { Step::same(torque) }
    }
}
