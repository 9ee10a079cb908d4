//! The temperature factor of dry and viscous friction.

use crate::scalar::Real;

/// `1 + (s/k) (exp(-k (T - T0)) - 1)`: falls with slope `s` at `T0` and flattens with curvature
/// `k`; in terms of `phi_1`, so that it becomes the straight line `1 - s (T - T0)` at `k = 0`.
#[inline]
pub fn temperature_factor<S: Real>(slope: S, curvature: S, above_reference: S::Plain) -> S {
    (slope * curvature.scale(-above_reference).phi(1))
        .scale(-above_reference)
        .shift(S::Plain::one())
}
