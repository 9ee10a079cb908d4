//! Random inputs of property tests: the same in every run unless `PROPTEST_RNG_SEED` is set.

use std::cell::Cell;

use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// Settings of a property with this many inputs.
pub fn cases(count: u32) -> ProptestConfig {
    let usual = ProptestConfig::default();
    let rng_seed = match usual.rng_seed {
        RngSeed::Random => RngSeed::Fixed(1),
        given @ RngSeed::Fixed(_) => given,
    };
    ProptestConfig {
        cases: count,
        rng_seed,
        failure_persistence: None,
        max_global_rejects: 1 << 20,
        ..usual
    }
}

thread_local! {
    /// Number of runners that this test has made: each draws other inputs.
    static RUNNERS: Cell<u64> = const { Cell::new(0) };
}

/// A source of random inputs.
pub fn runner(count: u32) -> TestRunner {
    let usual = cases(count);
    let made = RUNNERS.replace(RUNNERS.get() + 1);
    let RngSeed::Fixed(seed) = usual.rng_seed else { return TestRunner::new(usual) };
    TestRunner::new(ProptestConfig { rng_seed: RngSeed::Fixed(seed + made), ..usual })
}

/// Checks a property with this many inputs; the panic names the simplest counterexample found.
pub fn hold<S: Strategy>(
    count: u32,
    inputs: &S,
    property: impl Fn(S::Value) -> Result<(), TestCaseError>,
) {
    if let Err(error) = runner(count).run(inputs, property) {
        panic!("{error}");
    }
}

/// From `2^low` to `2^high`, uniform over the powers of two.
pub fn decades(low: i32, high: i32) -> impl Strategy<Value = f64> {
    (low..high, 1.0..2.0)
        .prop_map(|(power, share)| share * f64::from_bits(((1023 + power) as u64) << 52))
}

/// Like [`decades`], with both signs; one in eight is zero.
pub fn spread(low: i32, high: i32) -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => Just(0.0),
        4 => decades(low, high),
        3 => decades(low, high).prop_map(|x| -x),
    ]
}
