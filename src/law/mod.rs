//! Friction laws, one per file: parameters, table and formula.
//!
//! A new law is one file here, its `mod` row and its name in `every_law`.
//!
//! Bounds admit every parameter set of the papers. They keep dry friction positive, except where
//! those sets need both signs: `bittencourt_a`, `wolf`, `zhou`, `li`, `indri_a`, `makkar`,
//! `bittencourt_b`, `m_star`, `hao_b`, `iskandar`, `simoni`, `nevmerzhitskiy` and `indri_static` can
//! have negative dry friction outside the data. There a bristle for such a law is refused.

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

/// Every law as `file::Type`, in the order of the catalog: the one list of them. The last is the law
/// that a formula writes.
macro_rules! every_law {
    ($list:ident) => {
        $list! {
            coulomb::Coulomb, bittencourt_a::BittencourtA, clochiatti::Clochiatti, dong::Dong,
            gaz::GazA, gaz::GazB, grotjahn::GrotjahnA, grotjahn::GrotjahnB, hao::HaoA,
            indri_a::IndriA, makkar::Makkar, shao::Shao, wolf::Wolf, zhou::Zhou,
            bittencourt_b::BittencourtB, hao::HaoB, iskandar::Iskandar, li::Li, madsen::Madsen,
            nevmerzhitskiy::Nevmerzhitskiy, hao::Simoni, dahl::Dahl, lugre::Lugre, indri_b::IndriB,
            tadese_t::TadeseT, tadese_full::TadeseFull, xiao::Xiao, bliman_sorine::BlimanSorine,
            elastoplastic::Elastoplastic, leuven::Leuven, gms::Gms, gantry_map::GantryMap,
            indri_static::IndriStatic, bittencourt_2010::M0, bittencourt_2010::M1,
            bittencourt_b::MStar, karahan_karci::KarahanKarci, bam::BamM1, bam::BamM2, bam::BamM3,
            bam::BamM4, bam::BamM5, bam::BamM6; by_formula::ByFormula
        }
    };
}
pub(crate) use every_law;

macro_rules! exported {
    ($($file:ident::$law:ident),+; $formula_file:ident::$by_formula:ident) => {
        $(pub use $file::$law;)+
        pub(crate) use $formula_file::$by_formula;
    };
}
every_law!(exported);

pub use crate::dynamics::{Approach, Bristle, Deflection};
pub use crate::sample::{Split, StribeckCurve};
pub use crate::table::Parameters;

use crate::constants::Constants;
use crate::dynamics::{Interval, Memory, State, Step};
use crate::sample::Sample;
use crate::scalar::{Real, Scalar};
use crate::table::LawInfo;

/// The interface of a law.
pub trait FrictionLaw<S: Real>: Parameters<S> {
    /// The law's table.
    const INFO: LawInfo;

    /// The kind of state of a law with memory.
    const MEMORY: Memory = Memory::Deflection;

    /// The torque at one instant by its parts; in steady sliding if the law has memory.
    fn split(&self, sample: &Sample<S::Plain>, constants: &Constants<S::Plain>) -> Split<S>;

    /// The bristle at this sample, if the state is a bristle.
    #[inline]
    fn bristle(
        &self,
        _sample: &Sample<S::Plain>,
        _constants: &Constants<S::Plain>,
    ) -> Option<Bristle<S>> {
        None
    }

    /// The equation of the deflection at this sample, if the state is a single deflection.
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

    /// Steps over an interval in which the dry magnitude `dry` is constant. `split` belongs to the
    /// sample and includes the effects; if the interval has a mean velocity its dry magnitude
    /// differs from `dry`, and the state follows it towards the end.
    ///
    /// A law whose `captures` contain `presliding` has memory: it has a bristle or overrides this
    /// function. In all others dry friction acts along the sign of the velocity.
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
