use crate::scalar::Scalar;

/// Gravity at a joint, `constant + cos * cos q + sin * sin q` (T): the first of a prismatic joint, the
/// others of a revolute one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity<P> {
    /// The same everywhere.
    pub constant: P,
    /// At `q = 0`.
    pub cos: P,
    /// At a quarter of a turn.
    pub sin: P,
}

impl<P: Scalar + PartialOrd> Gravity<P> {
    /// None.
    #[must_use]
    pub fn none() -> Self {
        Self { constant: P::zero(), cos: P::zero(), sin: P::zero() }
    }

    /// Mean torque along a way from `position` (T): times the way it is what the potential energy
    /// gains, exactly.
    #[must_use]
    pub fn mean(&self, position: P, way: P) -> P {
        if self.cos.is_zero() && self.sin.is_zero() {
            return self.constant;
        }
        let half = way * P::from_f64(0.5);
        let (sin, cos) = (position + half).sin_cos();
        self.constant + (self.cos * cos + self.sin * sin) * cardinal_sine(half)
    }

    /// Potential energy at `position` (J).
    #[must_use]
    pub fn potential(&self, position: P) -> P {
        let (sin, cos) = position.sin_cos();
        self.constant * position + self.cos * sin - self.sin * cos
    }
}

/// `sin(x)/x`.
fn cardinal_sine<P: Scalar + PartialOrd>(x: P) -> P {
    if x.is_zero() { P::one() } else { x.sin() / x }
}
