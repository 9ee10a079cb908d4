//! The law given by a formula alone.

use core::marker::PhantomData;

use super::FrictionLaw;
use crate::constants::Constants;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{LawInfo, ParameterInfo, Parameters, Presence};

/// A law without parameters of its own: all terms come from a [formula](crate::formula).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ByFormula<S>(PhantomData<S>);

impl<S> Parameters<S> for ByFormula<S> {
    const TABLE: &'static [ParameterInfo] = &[];

    #[inline]
    fn read(_: impl FnMut(Presence) -> S) -> Self {
        Self(PhantomData)
    }
}

impl<S: Real> FrictionLaw<S> for ByFormula<S> {
    const INFO: LawInfo = LawInfo {
        id: "formula",
        title: "Law by formula",
        source: "the user's formula",
        formula: "as given",
        parameters: Self::TABLE,
        channels: &[],
        constants: &[],
        pole: None,
        captures: &[],
    };

    #[inline]
    fn split(&self, _: &Sample<S::Plain>, _: &Constants<S::Plain>) -> Split<S> {
        Split::zero()
    }
}
