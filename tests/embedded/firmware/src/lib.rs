//! The code that runs on the host and on the microcontroller: laws, a motion as input, and a hash
//! of their torques.
#![no_std]

use stribeck::law::{BittencourtA, Coulomb, Elastoplastic, Gms, Lugre, TadeseFull};
use stribeck::prelude::{Constants, FixedLaw, FrictionLaw, Sample, State};

/// The number type that is tested.
#[cfg(not(feature = "double"))]
pub type Number = f32;
/// The number type that is tested.
#[cfg(feature = "double")]
pub type Number = f64;

/// Sample period (s), 4 kHz.
const PERIOD: Number = 0.00025;

/// Inputs of one sample.
#[derive(Clone, Copy)]
pub struct Reading {
    pub velocity: Number,
    pub temperature: Number,
    pub load_torque: Number,
}

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

/// The torque of one joint for one reading.
pub type Step = extern "C" fn(&mut Joints, Number, Number, Number) -> Number;

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

/// A reproducible motion: changing accelerations, rests, large and tiny speeds.
pub struct Motion {
    seed: u32,
    velocity: Number,
    acceleration: Number,
    left: u32,
}

impl Motion {
    pub const fn new() -> Self {
        Self { seed: 0x9e37_79b9, velocity: 0.0, acceleration: 0.0, left: 0 }
    }

    fn random(&mut self) -> u32 {
        self.seed ^= self.seed << 13;
        self.seed ^= self.seed >> 17;
        self.seed ^= self.seed << 5;
        self.seed
    }

    /// A number between -1 and 1, most of them small.
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_wrap)]
    fn spread(&mut self) -> Number {
        let whole = (self.random() as i32 >> 8) as Number;
        let uniform = whole * (1.0 / 8_388_608.0);
        uniform * uniform * uniform
    }

    /// The next reading.
    pub fn next(&mut self) -> Reading {
        if self.left == 0 {
            self.left = 1 + self.random() % 256;
            self.acceleration = 40.0 * self.spread() * PERIOD;
            if self.random() % 8 == 0 {
                (self.velocity, self.acceleration) = (0.0, 0.0);
            }
        }
        self.left -= 1;
        let next = self.velocity + self.acceleration;
        if next > 3.0 || next < -3.0 {
            self.acceleration = -self.acceleration;
        } else {
            self.velocity = next;
        }
        Reading {
            velocity: self.velocity,
            temperature: 40.0 + 15.0 * self.spread(),
            load_torque: 10.0 * self.spread(),
        }
    }
}

/// FNV-1a over the bits; every NaN counts the same.
pub struct Hash(pub u64);

impl Hash {
    pub const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub fn add(&mut self, x: Number) {
        let x = if x.is_nan() { Number::NAN } else { x };
        self.0 = (self.0 ^ u64::from(x.to_bits())).wrapping_mul(0x0100_0000_01b3);
    }
}

/// The hash of the torques of a joint for `count` readings of the motion.
pub fn hash(joints: &mut Joints, step: Step, count: u32) -> u64 {
    let (mut motion, mut hash) = (Motion::new(), Hash::new());
    for _ in 0..count {
        let reading = motion.next();
        hash.add(step(joints, reading.velocity, reading.temperature, reading.load_torque));
    }
    hash.0
}
