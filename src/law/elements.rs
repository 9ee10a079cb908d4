//! Parameters of laws with several elements in parallel.

use crate::dynamics::MAX_ELEMENTS;
use crate::scalar::Real;
use crate::table::{ParameterInfo, Presence, Role, Scale};

/// Friction and stiffness of each element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementParameters<S> {
    /// Force of each element in sliding (T).
    pub friction: [S; MAX_ELEMENTS],
    /// Stiffness of each element (T/X).
    pub stiffness: [S; MAX_ELEMENTS],
}

impl<S: Real> ElementParameters<S> {
    /// Reads them in the order of [`TABLE`].
    #[inline]
    pub fn read(next: &mut impl FnMut(Presence) -> S) -> Self {
        let mut read =
            Self { friction: [S::zero(); MAX_ELEMENTS], stiffness: [S::zero(); MAX_ELEMENTS] };
        for (row, own) in
            TABLE.chunks_exact(2).zip(read.friction.iter_mut().zip(&mut read.stiffness))
        {
            *own.0 = next(row[0].presence);
            *own.1 = next(row[1].presence);
        }
        read
    }

    /// Dry friction in full sliding (T), never 0: each element has a positive share.
    #[inline]
    pub fn coulomb(&self, count: usize) -> S {
        self.friction[..count.min(MAX_ELEMENTS)].iter().fold(S::zero(), |sum, &part| sum + part)
    }
}

macro_rules! table {
    ($($number:literal starts at $start:literal;)+) => {
        /// Two entries per element. The start values of stiffness differ, and those of the first
        /// few differ widely: equal elements would stay equal in a fit.
        pub const TABLE: &[ParameterInfo] = &[$(
            ParameterInfo {
                name: concat!("element_friction_", $number),
                symbol: concat!("F", $number),
                unit: "T",
                lower: 1e-4,
                upper: 10.0,
                start: 0.15,
                drawn: (1e-4, 10.0),
                scale: Scale::Torque,
                role: Role::Dry,
                presence: Presence::Element($number),
                description: concat!("Dry friction of element ", $number, " in full sliding."),
            },
            ParameterInfo {
                name: concat!("element_stiffness_", $number),
                symbol: concat!("k", $number),
                unit: "T/X",
                lower: 0.05,
                upper: 2e6,
                start: $start,
                drawn: (0.05, 2e6),
                scale: Scale::Stiffness,
                role: Role::Nonlinear,
                presence: Presence::Element($number),
                description: concat!("Torque per deflection of element ", $number, "."),
            },
        )+];
    };
}

table! {
    1 starts at 100.0;
    2 starts at 10.0;
    3 starts at 1e3;
    4 starts at 1.0;
    5 starts at 1e4;
    6 starts at 30.0;
    7 starts at 300.0;
    8 starts at 3.0;
    9 starts at 3e3;
    10 starts at 17.0;
    11 starts at 170.0;
    12 starts at 1.7;
    13 starts at 1.7e3;
    14 starts at 55.0;
    15 starts at 550.0;
    16 starts at 5.5;
}

/// The table of a law's other parameters, followed by those of its elements.
pub const fn with_elements<const N: usize>(own: &[ParameterInfo]) -> [ParameterInfo; N] {
    let mut rows = [TABLE[0]; N];
    let mut i = 0;
    while i < N {
        rows[i] = if i < own.len() { own[i] } else { TABLE[i - own.len()] };
        i += 1;
    }
    rows
}
