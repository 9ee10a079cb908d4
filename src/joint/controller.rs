//! A position controller.

use super::trajectory::Reference;
use crate::scalar::Scalar;

/// A sampled PID position controller with zero-order hold: `kp e + ki int e dt + kd (b vd - v)`,
/// limited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller<P> {
    /// `kp` (T/X).
    pub proportional: P,
    /// `ki` (T/(X s)).
    pub integral: P,
    /// `kd` (T s/X).
    pub derivative: P,
    /// `b`: weight of the desired velocity in the derivative part; 0 damps all motion.
    pub velocity_weight: P,
    /// Largest torque (T).
    pub limit: P,
}

/// State of a controller: the integral part (T).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort<P> {
    /// `ki int e dt`.
    pub integral: P,
}

impl<P: Scalar + PartialOrd> Default for Effort<P> {
    fn default() -> Self {
        Self { integral: P::zero() }
    }
}

impl<P: Scalar + PartialOrd> Controller<P> {
    /// The torque over the next `dt` (s), `feedforward` (T) included. At the limit the integral is
    /// held, unless it leads away from the limit.
    pub fn torque(
        &self,
        effort: &mut Effort<P>,
        desired: &Reference<P>,
        (position, velocity): (P, P),
        feedforward: P,
        dt: P,
    ) -> P {
        let error = desired.position - position;
        let damping = self.derivative * (self.velocity_weight * desired.velocity - velocity);
        let wanted = self.proportional * error + effort.integral + damping + feedforward;
        let given = limited(wanted, self.limit);
        let growth = self.integral * error * dt;
        if given == wanted || growth * wanted < P::zero() {
            effort.integral += growth;
        }
        given
    }
}

fn limited<P: Scalar + PartialOrd>(torque: P, limit: P) -> P {
    if torque > limit {
        limit
    } else if torque < -limit {
        -limit
    } else {
        torque
    }
}
