//! The equation of a law with one deflection, for proofs over all of its motions.

use crate::scalar::{Real, Scalar};

/// `tf = f + drag slope sgn v + V + additive`, `df/dt = s0 v slope`, with the slope a function of
/// `x = f sgn(v)/D`: 1 where the bristle is elastic, 0 where it slides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deflection<S> {
    /// Stiffness `s0` (T/X).
    pub stiffness: S,
    /// Damping times speed, `s1 |v|` (T).
    pub drag: S,
    /// The slope as a function of `x`.
    pub approach: Approach<S>,
}

/// How a deflection approaches sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Approach<S> {
    /// `1 - x`.
    Linear,
    /// `sgn(1 - x) |1 - x|^n`.
    Power(S),
    /// `1 - a x`, with `a = 0` up to this `x` and `a = 1` in sliding.
    Elastoplastic(S),
    /// `s (s - x)`, with this smoothed sign `s` in place of the sign.
    Smoothed(S),
}

impl<S: Scalar> Approach<S> {
    /// The slope `dz/dt` over `v` at `x`; it never increases with `x`.
    pub fn slope(&self, x: S) -> S {
        let one = S::Plain::one();
        let way = (-x).shift(one);
        match *self {
            Self::Linear => way,
            Self::Power(exponent) => way.sign() * way.abs().powf(exponent),
            Self::Elastoplastic(breakaway) => super::elastoplastic::slope_at(x, breakaway),
            Self::Smoothed(sign) => sign * (sign - x),
        }
    }
}
