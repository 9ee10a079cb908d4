//! Friction laws, one file each: parameters, table and formula.
//!
//! A new law is one file here and one row in [`crate::catalog`].

mod bittencourt_a;
mod coulomb;
mod gantry_map;
mod lugre;

pub use bittencourt_a::BittencourtA;
pub use coulomb::Coulomb;
pub use gantry_map::GantryMap;
pub use lugre::Lugre;

use crate::bristle::Bristle;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, Parameters};

/// What a file in this folder provides.
pub trait FrictionLaw<S: Real>: Parameters<S> {
    /// The law's table.
    const INFO: LawInfo;

    /// The torque at one instant, taken apart.
    fn split(&self, sample: &Sample<S::Plain>) -> Split<S>;

    /// The bristle, if the law is dynamic.
    #[inline]
    fn bristle(&self) -> Option<Bristle<S>> {
        None
    }
}
