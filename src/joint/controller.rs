use super::trajectory::Reference;
use crate::scalar::Scalar;

/// A sampled PID controller of position, its torque held until the next sample:
/// `kp e + ki int e dt + kd (b vd - v)`, limited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller<P> {
    /// `kp` (T/X).
    pub proportional: P,
    /// `ki` (T/(X s)).
    pub integral: P,
    /// `kd` (T s/X).
    pub derivative: P,
    /// `b`: share of the desired velocity that the derivative part sees; 0 damps all motion.
    pub velocity_weight: P,
    /// Largest torque (T).
    pub limit: P,
}

/// What a controller remembers: the integral part (T).
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
    /// The torque over the next `dt` (s), `feedforward` (T) included. The integral stands still
    /// while the limit is reached, unless it leads away from it.
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
