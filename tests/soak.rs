//! Hours of a controller at 1 kHz whose sensors fail: readings that are missing, NaN, infinite, stuck,
//! too large or with flipped bits. The torque stays finite and within its limit, the state within its
//! bound, and after a fault the joint finds back to the torque of one without faults.
//!
//! ```console
//! cargo test --release --test soak -- --ignored
//! ```

mod common;

use stribeck::law::Lugre;
use stribeck::{
    Composed, Feedforward, FixedLaw, Friction, Limits, Real, Sample, Scalar, Source, Spec,
};

const RATE: u64 = 1000;
const HOUR: u64 = 3600 * RATE;
const TORQUE: f64 = 20.0;
const SPEED: f64 = 3.0;
/// Steps with valid readings, in motion, after which a fault is forgotten.
const FORGOTTEN: u64 = 2000;

/// Random numbers: splitmix64, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ x >> 31
    }

    /// Between 0 and 1.
    fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (0.5 * f64::EPSILON)
    }
}

/// The faults of a sensor; one begins about every second.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Nan,
    Infinite,
    Spike,
    Bits,
    Stuck,
    Dropout,
}

const FAULTS: [Fault; 6] =
    [Fault::Nan, Fault::Infinite, Fault::Spike, Fault::Bits, Fault::Stuck, Fault::Dropout];

/// A sensor, with its present fault and the step at which that ends.
struct Sensor {
    numbers: Numbers,
    fault: Option<(Fault, u64)>,
    last: f64,
}

impl Sensor {
    /// The reading of a velocity at a step; `None` if it is missing.
    fn read(&mut self, velocity: f64, step: u64) -> Option<f64> {
        if self.fault.is_none_or(|(_, end)| step >= end) {
            self.fault = None;
            if self.numbers.next().is_multiple_of(RATE) {
                let kind = FAULTS[(self.numbers.next() % 6) as usize];
                // From one step to ten seconds, uniform over decades.
                let lasts = 1 + Real::powf(10.0, 4.0 * self.numbers.share()) as u64;
                self.fault = Some((kind, step + lasts));
            }
        }
        let Some((fault, _)) = self.fault else {
            self.last = velocity;
            return Some(velocity);
        };
        match fault {
            Fault::Nan => Some(f64::NAN),
            Fault::Infinite => Some(if step & 1 == 0 { f64::INFINITY } else { f64::NEG_INFINITY }),
            Fault::Spike => Some(velocity * Real::powf(10.0, 300.0 * self.numbers.share())),
            Fault::Bits => {
                Some(f64::from_bits(velocity.to_bits() ^ 1 << (self.numbers.next() % 64)))
            }
            Fault::Stuck => Some(self.last),
            Fault::Dropout => None,
        }
    }
}

/// A motion with reversals, fast and slow phases and rest.
fn velocity(step: u64) -> f64 {
    let t = step as f64 / RATE as f64;
    let phase = t % 60.0;
    if phase > 50.0 { 0.0 } else { Real::sin(0.7 * t) * Real::powf(10.0, 0.1 * phase - 4.5) }
}

/// The largest deflection of a law, and its largest error once faults are forgotten.
#[derive(Clone, Copy)]
struct Bounds {
    deflection: f64,
    error: f64,
}

/// Runs a joint with faults beside one without.
fn soak<S: Scalar<Plain = S> + PartialOrd, F: Friction<S> + Copy>(
    friction: F,
    steps: u64,
    bounds: Option<Bounds>,
) {
    let limits =
        Limits { torque: S::from_f64(TORQUE), speed: S::from_f64(SPEED), held: RATE as u32 / 100 };
    let made = || Feedforward::new(friction, S::from_f64(1.0 / RATE as f64), limits).unwrap();
    let (mut joint, mut calm) = (made(), made());
    let mut sensor = Sensor { numbers: Numbers(1), fault: None, last: 0.0 };
    let (mut moving, mut compared, mut bridged) = (0, 0_u64, 0_u64);
    for step in 0..steps {
        let velocity = velocity(step);
        let reading = sensor.read(velocity, step);
        let sample = reading.map(|v| Sample::at(S::from_f64(v)));
        let feed = joint.next(sample.as_ref());
        let expected = calm.next(Some(&Sample::at(S::from_f64(velocity)))).torque.value();
        let torque = feed.torque.value();
        assert!(torque.is_finite() && torque.abs() <= TORQUE, "{step}: {torque} at {reading:?}");
        let z = joint.state().deflection().value();
        let farthest = bounds.map_or(f64::MAX, |bounds| bounds.deflection);
        assert!(z.abs() <= farthest, "{step}: deflection {z} at {reading:?}");
        bridged += u64::from(matches!(feed.source, Source::Last | Source::None));
        let calmly = sensor.fault.is_none() && velocity.abs() > 0.01;
        moving = if sensor.fault.is_some() { 0 } else { moving + u64::from(calmly) };
        if let Some(bounds) = bounds.filter(|_| moving > FORGOTTEN) {
            let error = (torque - expected).abs();
            assert!(error <= bounds.error, "{step}: {torque} and {expected} without faults");
            compared += 1;
        }
    }
    assert!(bridged > steps / 100, "{bridged} of {steps}");
    assert!(bounds.is_none() || compared > steps / 1000, "{compared} of {steps}");
}

fn lugre<S: Real>() -> Lugre<S> {
    let of = S::from_f64;
    Lugre {
        bristle_stiffness: of(2000.0),
        bristle_damping: of(12.0),
        viscous_friction: of(1.5),
        coulomb_friction: of(2.0),
        static_friction: of(2.7),
        stribeck_velocity: of(0.08),
        stribeck_exponent: of(2.0),
    }
}

fn of_the_catalog(law: &str) -> Composed<f64> {
    let spec = Spec::new(law, []).unwrap();
    spec.with(&common::values(&spec)[..]).unwrap()
}

/// Laws of the catalog, of which some remember a fault until they have travelled far.
fn catalog_laws(steps: u64) {
    for law in ["dahl", "elastoplastic", "gms", "leuven", "bliman_sorine", "tadese_full"] {
        soak::<f64, _>(of_the_catalog(law), steps, None);
    }
}

/// The deflection of `lugre` is at most `D/s0`, up to rounding.
fn both_precisions(steps: u64) {
    let farthest = 2.7 / 2000.0;
    let double = Bounds { deflection: farthest * (1.0 + 1e-12), error: 1e-9 };
    soak::<f64, _>(FixedLaw::<_, f64>::new(lugre()), steps, Some(double));
    let single = Bounds { deflection: farthest * (1.0 + 1e-5), error: 1e-3 };
    soak::<f32, _>(FixedLaw::<_, f32>::new(lugre()), steps, Some(single));
}

#[test]
fn minutes() {
    both_precisions(HOUR / 20);
    catalog_laws(HOUR / 120);
}

#[test]
#[ignore = "takes a minute in a release build"]
fn eight_hours() {
    both_precisions(8 * HOUR);
    catalog_laws(HOUR);
}
