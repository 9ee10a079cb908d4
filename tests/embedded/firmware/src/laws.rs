//! Friction laws, each selected at compile time.

use stribeck::law::{BittencourtA, Coulomb, Elastoplastic, Gms, Lugre, TadeseFull};
use stribeck::prelude::{Constants, FixedLaw, FrictionLaw, Sample, State};

use crate::{Number, PERIOD, Reading, Step};

/// Steps whose instructions are counted.
pub const COUNTED: u32 = 10_000;
/// Steps whose stack use is measured.
pub const PROBED: u32 = 1000;
/// A law and its state, as in a controller.
pub struct Joint<L> {
    law: FixedLaw<L, Number>,
    state: State<Number>,
}

impl<L: FrictionLaw<Number>> Joint<L> {
    fn new(values: &[Number]) -> Option<Self> {
        let law = FixedLaw::from_values(values, &Constants::default()).ok()?;
        Some(Self { law, state: State::default() })
    }

    #[inline(always)]
    fn torque(&mut self, reading: &Reading) -> Number {
        let sample = Sample {
            temperature: reading.temperature,
            load_torque: reading.load_torque,
            ..Sample::at(reading.velocity)
        };
        self.law.torque(&mut self.state, &sample, PERIOD)
    }
}

macro_rules! joints {
    ($($joint:ident: $law:ident = $values:expr;)+) => {
        /// One joint for each law that is tested.
        pub struct Joints {
            $(pub $joint: Joint<$law<Number>>,)+
        }

        impl Joints {
            /// All joints at rest; `None` if a law refuses its parameters.
            pub fn new() -> Option<Self> {
                Some(Self { $($joint: Joint::new(core::hint::black_box(&$values))?,)+ })
            }
        }

        /// Name and parameters of each law.
        pub const VALUES: &[(&str, &[Number])] = &[$((stringify!($joint), &$values),)+];

        /// Name and step of each law.
        pub const STEPS: &[(&str, Step)] = &[$((stringify!($joint), $joint),)+];

        $(
            #[unsafe(no_mangle)]
            #[inline(never)]
            extern "C" fn $joint(
                joints: &mut Joints,
                velocity: Number,
                temperature: Number,
                load_torque: Number,
            ) -> Number {
                joints.$joint.torque(&Reading { velocity, temperature, load_torque })
            }
        )+
    };
}

joints! {
    coulomb: Coulomb = [1.5, 2.0];
    bittencourt_a: BittencourtA = [2.0, 0.7, 0.08, 1.3, 1.5];
    bittencourt_a_squared: BittencourtA = [2.0, 0.7, 0.08, 2.0, 1.5];
    lugre_squared: Lugre = [2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 2.0];
    lugre: Lugre = [2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 1.3];
    tadese_full: TadeseFull = [
        2000.0, 12.0, 0.02, 2.0, 1.8,
        3.0, -0.02, 0.9, 0.01, 2.8, -0.018, 0.8, 0.012,
        0.3, 3.0, 0.1, 0.05, 0.01,
        -0.2, 2.5, -0.08, -0.04, 0.01,
        -0.3, 3.5, -0.1, 0.05, -0.01,
        0.2, 2.0, 0.09, -0.03, -0.01,
    ];
    gms: Gms = [
        0.7, 0.08, 2.0, 200.0, 1.5,
        0.5, 4000.0, 0.5, 2000.0, 0.5, 1000.0, 0.5, 500.0,
    ];
    elastoplastic: Elastoplastic = [2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 0.4];
}
