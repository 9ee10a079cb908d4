//! Passivity of the sampled friction: over a step the work equals the stored plus the dissipated
//! energy, to rounding, for any step.
//!
//! The dissipated energy is computed independently of the step: with `x = s0 z sgn(v)/D` the power
//! is `|v| (D x^2 + s1 |v| (1 - x) + V sgn v)`, and `1 - x` falls as `e^(-r t)`.

use super::super::{Bristle, BristleState};
use crate::{Real, Sample, Scalar, Spec, State, law::Split};

const MANY: u32 = 10_000_000;
const SOME: u32 = 1_000_000;

/// A pseudo-random generator (xorshift64*).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// A number below `count`.
    fn below(&mut self, count: u64) -> u64 {
        (self.bits() >> 32) % count
    }

    /// From `2^low` to `2^high`, uniform over the powers of two.
    fn spread(&mut self, low: i64, high: i64) -> f64 {
        let power = low + self.below(high.abs_diff(low)) as i64;
        f64::from_bits(((1023 + power) as u64) << 52 | self.bits() >> 12)
    }
}

/// A step with constant values: dry magnitude, viscous torque, velocity, length.
struct Hold {
    dry: f64,
    rate: f64,
    velocity: f64,
    dt: f64,
}

impl Hold {
    /// The dry magnitude may be much smaller than the previous one, with a loaded bristle; one in
    /// eight steps is at rest.
    fn draw(random: &mut Random, stiffness: f64) -> Self {
        let (dry, dt) = (random.spread(-10, 7), random.spread(-17, -3));
        let direction = if random.below(2) == 0 { -1.0 } else { 1.0 };
        // From 9e-13 to 1.05e6.
        let relaxation = random.spread(-40, 20);
        let moves = random.below(8) > 0;
        let velocity = if moves { direction * relaxation * dry / (stiffness * dt) } else { 0.0 };
        let rate = if moves { direction * random.spread(-10, 0) * dry } else { 0.0 };
        Self { dry, rate, velocity, dt }
    }

    /// Rounded to the precision of the step.
    fn rounded<P: Scalar>(&self) -> Self {
        let round = |x: f64| P::from_f64(x).value();
        Self {
            dry: round(self.dry),
            rate: round(self.rate),
            velocity: round(self.velocity),
            dt: round(self.dt),
        }
    }

    /// The energy dissipated over the step from the deflection `z` (J).
    fn dissipated(&self, stiffness: f64, damping: f64, z: f64) -> f64 {
        let speed = self.velocity.abs();
        let relaxation = stiffness * speed / self.dry * self.dt;
        let mean = |y: f64| (-y).phi(1);
        let apart = 1.0 - stiffness * z * self.velocity.sign() / self.dry;
        let (first, second) = (apart * mean(relaxation), apart * apart * mean(2.0 * relaxation));
        let dry = self.dry * (1.0 - 2.0 * first + second);
        let power = speed * (dry + damping * speed * first + self.rate * self.velocity.sign());
        power * self.dt
    }
}

/// The largest imbalance of one step, relative to the largest of the absolute work, the energy
/// stored before and after, and `D |v| dt`; and the least dissipated energy, relative to the same.
fn over_random_steps<P: Scalar<Plain = P> + PartialOrd>(
    seed: u64,
    steps: u32,
    damping: f64,
) -> (f64, f64) {
    let mut random = Random(seed);
    let (mut largest, mut least) = (0.0_f64, 0.0_f64);
    let mut state = BristleState { z: P::zero() };
    let stiffness = P::from_f64(3e4).value();
    let bristle = Bristle::new(P::from_f64(stiffness), P::from_f64(damping));
    let damping = bristle.damping.value();
    for _ in 0..steps {
        let hold = Hold::draw(&mut random, stiffness).rounded::<P>();
        let split =
            Split { coulomb: P::from_f64(hold.dry), rate: P::from_f64(hold.rate), ..Split::zero() };
        let before = state.z.value();
        let step =
            bristle.step(&mut state, &split, P::from_f64(hold.velocity), P::from_f64(hold.dt));
        let work = step.mean_torque.value() * hold.velocity * hold.dt;
        let stored = |z: f64| 0.5 * stiffness * z * z;
        let gain = stored(state.z.value()) - stored(before);
        let dissipated = hold.dissipated(stiffness, damping, before);
        let size = [work.abs(), stored(before), stored(state.z.value())]
            .into_iter()
            .fold(hold.dry * hold.velocity.abs() * hold.dt, f64::max);
        if size > 0.0 {
            largest = largest.max((work - gain - dissipated).abs() / size);
            least = least.min((work - gain) / size);
        }
        assert!(step.mean_torque.value().is_finite());
    }
    (largest, least)
}

#[test]
fn work_is_storage_and_dissipation_in_double_precision() {
    let (largest, least) = over_random_steps::<f64>(7, MANY, 0.0);
    assert!(largest <= 1e-12, "imbalance {largest:e}");
    assert!(least >= -1e-12, "negative dissipation {least:e}");
}

#[test]
fn work_is_storage_and_dissipation_in_single_precision() {
    let (largest, least) = over_random_steps::<f32>(8, MANY, 0.0);
    assert!(largest <= 2e-6, "imbalance {largest:e}");
    assert!(least >= -2e-6, "negative dissipation {least:e}");
}

#[test]
fn work_is_storage_and_dissipation_with_damping() {
    let (double, _) = over_random_steps::<f64>(9, SOME, 0.7);
    assert!(double <= 1e-12, "imbalance {double:e}");
    let (single, _) = over_random_steps::<f32>(10, SOME, 0.7);
    assert!(single <= 2e-6, "imbalance {single:e}");
}

/// Other laws with one deflection and no damping: the dissipated energy is never negative, up to
/// the error of a step that is not exact.
#[test]
fn other_deflections_do_not_generate_energy() {
    let laws: [(&str, &[f64], f64); 3] = [
        ("dahl", &[3e4, 2.0, 1.0], 1e-12),
        ("dahl", &[3e4, 2.0, 2.5], 1e-12),
        ("elastoplastic", &[3e4, 0.0, 0.3, 2.0, 3.0, 0.1, 0.6], 1e-5),
    ];
    for (law, values, slack) in laws {
        let spec = Spec::new(law, []).unwrap();
        let model = spec.with(values).unwrap();
        let stiffness = model.deflection(&Sample::at(1.0)).unwrap().stiffness;
        let mut random = Random(11);
        let mut state = State::default();
        for k in 0..300_000 {
            let hold = Hold::draw(&mut random, stiffness);
            let before = state.bristle.z;
            let step = model.step(&mut state, &Sample::at(hold.velocity), hold.dt);
            let work = step.mean_torque * hold.velocity * hold.dt;
            let stored = |z: f64| 0.5 * stiffness * z * z;
            let gain = stored(state.bristle.z) - stored(before);
            let size = work.abs().max(stored(before)).max(stored(state.bristle.z));
            assert!(work - gain >= -slack * size, "{law} at step {k}: {:e}", (work - gain) / size);
        }
    }
}
