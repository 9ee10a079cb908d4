//! The code that runs on the host and on the microcontroller: laws, an arm, a robot, a motion as
//! input, and a hash of what they answer.
#![no_std]

// A program has one of them, so that none changes how the compiler inlines another.
#[cfg(feature = "arm")]
mod arm;
#[cfg(not(any(feature = "arm", feature = "robot")))]
mod laws;
#[cfg(feature = "robot")]
mod robot;

#[cfg(feature = "arm")]
pub use arm::{COUNTED, Joints, PROBED, STEPS, VALUES};
#[cfg(not(any(feature = "arm", feature = "robot")))]
pub use laws::{COUNTED, Joints, PROBED, STEPS, VALUES};
#[cfg(feature = "robot")]
pub use robot::{COUNTED, Joints, PROBED, STEPS, VALUES};

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

/// The answer to velocity, temperature and load torque.
pub type Step = extern "C" fn(&mut Joints, Number, Number, Number) -> Number;

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

/// The hash of the answers of a step to `count` readings of the motion.
pub fn hash(joints: &mut Joints, step: Step, count: u32) -> u64 {
    let (mut motion, mut hash) = (Motion::new(), Hash::new());
    for _ in 0..count {
        let reading = motion.next();
        hash.add(step(joints, reading.velocity, reading.temperature, reading.load_torque));
    }
    hash.0
}
