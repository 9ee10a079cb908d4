//! Gravity torque of a joint.

use crate::scalar::Scalar;

/// Gravity at a joint, `constant + cos * cos q + sin * sin q` (T): `constant` for a prismatic
/// joint, the others for a revolute one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity<P> {
    /// The constant part.
    pub constant: P,
    /// The torque at `q = 0`.
    pub cos: P,
    /// The torque at a quarter turn.
    pub sin: P,
}

impl<P: Scalar + PartialOrd> Gravity<P> {
    /// No gravity.
    #[must_use]
    pub fn none() -> Self {
        Self { constant: P::zero(), cos: P::zero(), sin: P::zero() }
    }

    /// Mean torque over a displacement `way` from `position` (T): times the displacement it is
    /// exactly the change of potential energy.
    #[must_use]
    pub fn mean(&self, position: P, way: P) -> P {
        self.about(position).mean(position, way)
    }

    /// Gravity as a function of the displacement from `position`.
    pub(super) fn about(&self, position: P) -> GravityAbout<P> {
        let (sin, cos) =
            if self.is_constant() { (P::zero(), P::one()) } else { position.sin_cos() };
        let own = Self {
            constant: self.constant,
            cos: self.cos * cos + self.sin * sin,
            sin: self.sin * cos - self.cos * sin,
        };
        GravityAbout { position, own }
    }

    /// Whether it does not depend on the position.
    fn is_constant(&self) -> bool {
        self.cos.is_zero() && self.sin.is_zero()
    }

    /// Potential energy at `position` (J).
    #[must_use]
    pub fn potential(&self, position: P) -> P {
        let (sin, cos) = position.sin_cos();
        self.constant * position + self.cos * sin - self.sin * cos
    }
}

/// Gravity as a function of the displacement from a position: accurate for small ones, and sine and
/// cosine of the position are computed once.
#[derive(Clone, Copy, Debug)]
pub(super) struct GravityAbout<P> {
    position: P,
    own: Gravity<P>,
}

impl<P: Scalar + PartialOrd> GravityAbout<P> {
    /// Mean torque over a displacement `way` (T).
    pub(super) fn mean(&self, position: P, way: P) -> P {
        let Gravity { constant, cos, sin } = self.own;
        if self.own.is_constant() {
            return constant;
        }
        let half = way * P::from_f64(0.5);
        let (sin_half, cos_half) = half.sin_cos();
        let before = position - self.position;
        let (sin_middle, cos_middle) =
            if before.is_zero() { (sin_half, cos_half) } else { (before + half).sin_cos() };
        let cardinal_sine = if half.is_zero() { P::one() } else { sin_half / half };
        constant + (cos * cos_middle + sin * sin_middle) * cardinal_sine
    }
}
