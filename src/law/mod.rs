//! Friction laws, one file each: parameters, table and formula.
//!
//! A new law is one file here and one row in [`crate::catalog`].
//!
//! Bounds keep dry friction positive, but not where the paper's coefficients need either sign:
//! `indri_a`, `makkar`, `bittencourt_b`, `m_star`, `hao_b`, `iskandar`, `simoni` and `indri_static`
//! can take it below zero outside the data. A bristle around such a law is refused there.

mod bam;
mod bittencourt_2010;
mod bittencourt_a;
mod bittencourt_b;
mod bliman_sorine;
mod by_formula;
mod clochiatti;
mod coulomb;
mod curves;
mod dahl;
mod dong;
mod elastoplastic;
mod elements;
mod gantry_map;
mod gaz;
mod gms;
mod grotjahn;
mod hao;
mod indri_a;
mod indri_b;
mod indri_static;
mod iskandar;
mod karahan_karci;
mod leuven;
mod li;
mod lugre;
mod madsen;
mod makkar;
mod nevmerzhitskiy;
mod shao;
mod tadese_full;
mod tadese_t;
mod wolf;
mod xiao;
mod zhou;

pub use bam::{BamM1, BamM2, BamM3, BamM4, BamM5, BamM6};
pub use bittencourt_2010::{M0, M1};
pub use bittencourt_a::BittencourtA;
pub use bittencourt_b::{BittencourtB, MStar};
pub use bliman_sorine::BlimanSorine;
pub use by_formula::ByFormula;
pub use clochiatti::Clochiatti;
pub use coulomb::Coulomb;
pub use dahl::Dahl;
pub use dong::Dong;
pub use elastoplastic::Elastoplastic;
pub use gantry_map::GantryMap;
pub use gaz::{GazA, GazB};
pub use gms::Gms;
pub use grotjahn::{GrotjahnA, GrotjahnB};
pub use hao::{HaoA, HaoB, Simoni};
pub use indri_a::IndriA;
pub use indri_b::IndriB;
pub use indri_static::IndriStatic;
pub use iskandar::Iskandar;
pub use karahan_karci::KarahanKarci;
pub use leuven::Leuven;
pub use li::Li;
pub use lugre::Lugre;
pub use madsen::Madsen;
pub use makkar::Makkar;
pub use nevmerzhitskiy::Nevmerzhitskiy;
pub use shao::Shao;
pub use tadese_full::TadeseFull;
pub use tadese_t::TadeseT;
pub use wolf::Wolf;
pub use xiao::Xiao;
pub use zhou::Zhou;

use crate::constants::Constants;
use crate::dynamics::{Bristle, Deflection, Interval, Memory, State, Step};
use crate::sample::{Sample, Split};
use crate::scalar::{Real, Scalar};
use crate::table::{LawInfo, Parameters};

/// What a file in this folder provides.
pub trait FrictionLaw<S: Real>: Parameters<S> {
    /// The law's table.
    const INFO: LawInfo;

    /// What the state of a law with a memory consists of.
    const MEMORY: Memory = Memory::Deflection;

    /// The torque at one instant, taken apart: in steady sliding where the law has a memory.
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S>;

    /// The bristle that its state is at this sample, where it is one.
    #[inline]
    fn bristle(
        &self,
        _sample: &Sample<S::Plain>,
        _constants: &Constants<S::Plain>,
    ) -> Option<Bristle<S>> {
        None
    }

    /// The deflection that its state consists of at this sample, where it is a single one.
    #[inline]
    fn deflection(
        &self,
        sample: &Sample<S::Plain>,
        constants: &Constants<S::Plain>,
    ) -> Option<Deflection<S>>
    where
        S: Scalar,
    {
        Some(self.bristle(sample, constants)?.deflection(sample.velocity))
    }

    /// Steps over an interval over which the dry magnitude `dry` is held. `split` is that of the
    /// sample, with what effects have added; its dry magnitude is another where a mean velocity is
    /// held: the state tends to it towards the end.
    ///
    /// A law whose `captures` name `presliding` has a memory: it is a bristle or steps by itself; in
    /// all others dry friction acts along the sign of the velocity.
    #[inline]
    fn step(
        &self,
        _state: &mut State<S>,
        _dry: S,
        split: &Split<S>,
        interval: &Interval<S::Plain>,
        _constants: &Constants<S::Plain>,
    ) -> Step<S> {
        Step::same(split.torque(interval.sample.velocity.sign()))
    }
}
