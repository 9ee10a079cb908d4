//! Friction along the direction of motion, over a box or at a point.

use super::enclosure::Enclosure;
use crate::composed::Composed;
use crate::dynamics::Approach;
use crate::sample::Sample;
use crate::scalar::{Real, Scalar};

/// Error bound of the slope of an elastoplastic approach, beyond what its interval covers: the law
/// neglects terms of the order of 1e-130 near full sliding.
const SLOPE_SLACK: f64 = 1e-14;

/// A model with one deflection, along the direction of motion: the power it dissipates is
/// `|v| (g + drag slope + resistance)` and `df/dt = s0 |v| slope`, with `g` the bristle force.
#[derive(Clone, Copy, Debug)]
pub struct Bristled<S> {
    /// Dry magnitude `D` (T).
    pub dry: S,
    /// `zeta`, the friction in parallel with the bristle (T).
    pub resistance: S,
    /// Damping times speed (T).
    pub drag: S,
    approach: Approach<S>,
}

impl<S: Scalar> Bristled<S> {
    /// `None` if the state of the model is not a single deflection.
    pub fn of(model: &Composed<S>, sample: &Sample<S::Plain>) -> Option<Self> {
        let deflection = model.deflection(sample)?;
        let split = model.split(sample);
        Some(Self {
            dry: split.dry(),
            resistance: (split.rate + split.additive).scale(sample.velocity.sign()),
            drag: deflection.drag,
            approach: deflection.approach,
        })
    }

    /// The bristle force along the motion in steady sliding (T).
    pub fn strength(&self) -> S {
        match self.approach {
            Approach::Smoothed(sign) => self.dry * sign,
            _ => self.dry,
        }
    }

    /// Whether the slope is `1 - x`, as of `dz/dt = v - s0 |v|/D z`.
    pub fn is_linear(&self) -> bool {
        matches!(self.approach, Approach::Linear)
    }

    /// The leg of a cycle on which the deflection grows along the motion, or on which it falls
    /// back, at a bristle force `g` along the motion (T).
    pub fn leg(&self, force: S::Plain, grows: bool) -> Leg<S> {
        let slope = self.approach.slope(self.dry.reciprocal_times(force));
        let load = self.resistance.shift(force);
        if grows {
            Leg { load, pace: slope, drag: self.drag }
        } else {
            Leg { load, pace: -slope, drag: -self.drag }
        }
    }
}

impl Bristled<Enclosure> {
    /// Power over `|dz/dt|` (T) where the deflection grows along the motion and where it falls
    /// back, at a bristle force `g` along the motion; `None` where it does not do so.
    pub fn work_per_deflection(&self, force: Enclosure) -> [Option<Enclosure>; 2] {
        let slope = self.slope(force / self.dry);
        let load = force + self.resistance;
        let grows = slope.positive_part().map(|slope| load / slope + self.drag);
        let falls = (-slope).positive_part().map(|slope| load / slope - self.drag);
        [grows, falls]
    }

    /// Power over `|v|` beyond the increase of `f^2/(2 s0)` (T).
    pub fn dissipated(&self, force: Enclosure) -> Enclosure {
        let x = force / self.dry;
        let slope = self.slope(x);
        let sheared = match self.approach {
            Approach::Linear => force.square() / self.dry,
            Approach::Smoothed(_) => force * (Enclosure::point(1.0) - slope),
            // 1 - slope has the sign of the force.
            Approach::Power(_) | Approach::Elastoplastic(_) => {
                let sheared = force * (Enclosure::point(1.0) - slope);
                Enclosure::new(sheared.lower.max(0.0), sheared.upper.max(0.0))
            }
        };
        sheared + self.drag * slope + self.resistance
    }

    /// The slope decreases with `x`, or is constant: its extremes are at the ends, where the law is
    /// evaluated on intervals of one number. There `1 - x` is exact near 1, so that no interval lies
    /// on both sides of a branch.
    fn slope(&self, x: Enclosure) -> Enclosure {
        let at = |x: f64| {
            if x.is_infinite() {
                return Enclosure::point(-x);
            }
            self.approach.slope(Enclosure::point(x))
        };
        let values = at(x.lower).hull(at(x.upper));
        match self.approach {
            Approach::Elastoplastic(_) => Enclosure::new(
                values.lower - SLOPE_SLACK * (1.0 + values.lower.abs()),
                values.upper + SLOPE_SLACK * (1.0 + values.upper.abs()),
            ),
            _ => values,
        }
    }
}

/// A leg of a cycle: the deflection grows or falls.
#[derive(Clone, Copy, Debug)]
pub struct Leg<S> {
    /// Friction apart from the damping of the bristle (T).
    pub load: S,
    /// Rate of deflection over velocity; negative where the deflection moves the other way.
    pub pace: S,
    /// Work of the damping per deflection (T).
    pub drag: S,
}

impl<S: Scalar> Leg<S> {
    /// Power over `|dz/dt|` (T); `None` where the deflection moves the other way.
    pub fn work(self) -> Option<S> {
        (self.pace.value() > 0.0).then(|| self.load / self.pace + self.drag)
    }
}

/// Friction in steady sliding, along the motion (T).
pub fn sliding<S: Scalar>(model: &Composed<S>, sample: &Sample<S::Plain>) -> S {
    let direction = sample.velocity.sign();
    match Bristled::of(model, sample) {
        Some(bristled) if model.has_state() => bristled.strength() + bristled.resistance,
        _ => model.split(sample).torque(direction).scale(direction),
    }
}
