//! Friction feedforward: missing, invalid and first readings.

use crate::common::random::cases;
use proptest::collection::vec;
use proptest::prelude::*;
use stribeck::law::Lugre;
use stribeck::{Feed, Feedforward, FixedLaw, Friction, Limits, ModelError, Sample, Source, Spec};

const PERIOD: f64 = 2.5e-4;
const LIMITS: Limits<f64> = Limits { torque: 5.0, speed: 6.0, held: 3 };
const LUGRE: Lugre<f64> = Lugre {
    bristle_stiffness: 2000.0,
    bristle_damping: 12.0,
    viscous_friction: 1.5,
    coulomb_friction: 2.0,
    static_friction: 2.7,
    stribeck_velocity: 0.08,
    stribeck_exponent: 2.0,
};
/// The largest deflection, `D/s0`.
const FARTHEST: f64 = 2.7 / 2000.0;

fn joint() -> Feedforward<FixedLaw<Lugre<f64>, f64>, f64> {
    Feedforward::new(FixedLaw::new(LUGRE), PERIOD, LIMITS).unwrap()
}

fn fed(joint: &mut Feedforward<impl Friction<f64>, f64>, velocity: f64) -> Feed<f64> {
    joint.next(Some(&Sample::at(velocity)))
}

#[test]
fn the_first_reading_counts_as_steady_motion() {
    for velocity in [0.0, 1e-3, 0.5, -2.0] {
        let feed = fed(&mut joint(), velocity);
        let model = Spec::new("lugre", []).unwrap();
        let model = model.with(&[2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 2.0]).unwrap();
        let steady = model.static_torque(&Sample::at(velocity));
        assert!((feed.torque - steady).abs() < 1e-12, "{velocity}: {} {steady}", feed.torque);
        assert_eq!(feed.source, Source::Law);
    }
}

#[test]
fn invalid_readings_leave_the_state_unchanged() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let readings = [
        None,
        Some(Sample::at(nan)),
        Some(Sample::at(inf)),
        Some(Sample::at(-inf)),
        Some(Sample::at(6.1)),
        Some(Sample { temperature: nan, ..Sample::at(0.1) }),
        Some(Sample { load_torque: inf, ..Sample::at(0.1) }),
    ];
    for reading in readings {
        let mut joint = joint();
        let last = fed(&mut joint, 0.01);
        let z = joint.state().deflection();
        for _ in 0..LIMITS.held {
            let feed = joint.next(reading.as_ref());
            assert_eq!(feed, Feed { torque: last.torque, source: Source::Last });
            assert_eq!(joint.state().deflection(), z);
        }
        let mut untouched = self::joint();
        fed(&mut untouched, 0.01);
        assert_eq!(fed(&mut joint, -0.02), fed(&mut untouched, -0.02));
    }
}

#[test]
fn after_too_many_the_torque_is_zero_and_the_state_discarded() {
    let mut joint = joint();
    fed(&mut joint, 0.5);
    for _ in 0..LIMITS.held {
        joint.next(None);
    }
    for _ in 0..3 {
        assert_eq!(joint.next(None), Feed { torque: 0.0, source: Source::None });
        assert_eq!(joint.state().deflection(), 0.0);
    }
    assert_eq!(fed(&mut joint, -0.3), fed(&mut self::joint(), -0.3));
}

#[test]
fn without_any_reading_there_is_no_torque() {
    let feed = joint().next(Some(&Sample::at(f64::NAN)));
    assert_eq!(feed, Feed { torque: 0.0, source: Source::None });
}

#[test]
fn torque_is_limited_and_the_state_is_not() {
    let mut joint = joint();
    assert_eq!(fed(&mut joint, 5.0), Feed { torque: 5.0, source: Source::Limit });
    assert_eq!(fed(&mut joint, -6.0).source, Source::Limit);
    let mut wide =
        Feedforward::new(FixedLaw::new(LUGRE), PERIOD, Limits { torque: 1e3, ..LIMITS }).unwrap();
    fed(&mut wide, 5.0);
    fed(&mut wide, -6.0);
    assert_eq!(joint.state().deflection(), wide.state().deflection());
}

/// Any bits, a speed that is possible or a little beyond, or no reading.
fn reading() -> impl Strategy<Value = Option<f64>> {
    prop_oneof![
        1 => any::<u64>().prop_map(|bits| Some(f64::from_bits(bits))),
        2 => (-7.0..7.0).prop_map(Some),
        1 => Just(None),
    ]
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn the_state_stays_bounded_for_any_readings(readings in vec(reading(), 200)) {
        let mut joint = joint();
        for velocity in readings {
            let feed = joint.next(velocity.map(Sample::at).as_ref());
            prop_assert!(feed.torque.abs() <= LIMITS.torque);
            prop_assert!(joint.state().deflection().abs() <= FARTHEST * (1.0 + 1e-12));
        }
    }
}

#[test]
fn feedforward_works_with_laws_and_effects() {
    let model = Spec::new("coulomb", ["stribeck", "presliding"]).unwrap();
    let model = model.with(&[1.5, 2.0, 0.7, 0.08, 2.0, 2000.0, 12.0]).unwrap();
    let mut joint = Feedforward::new(model, PERIOD, LIMITS).unwrap();
    let mut lugre = self::joint();
    for velocity in [0.3, 0.01, -0.2, f64::NAN, -0.1, 0.0] {
        let (one, other) = (fed(&mut joint, velocity), fed(&mut lugre, velocity));
        assert!((one.torque - other.torque).abs() < 1e-12);
        assert_eq!(one.source, other.source);
    }
}

#[test]
fn limits_are_positive_numbers() {
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = Feedforward::new(FixedLaw::new(LUGRE), period, LIMITS).unwrap_err();
        assert!(matches!(refused, ModelError::Constant("period", _)));
    }
    let limits = Limits { torque: f64::NAN, ..LIMITS };
    let refused = Feedforward::new(FixedLaw::new(LUGRE), PERIOD, limits).unwrap_err();
    assert!(refused.to_string().starts_with("constant 'torque limit' cannot be"));
}
