//! The largest factor of a compensator, against the least ratio over a grid of friction models.

use stribeck::passivity::{PassivityError, Side, largest_factor};
use stribeck::{Channel, Sample, Spec};

const SIDES: [Side; 1] = [Side { channel: Channel::Velocity, lower: -1.0, upper: 2.0 }];
const BUDGET: usize = 20_000;

fn spec() -> Spec {
    Spec::new("coulomb", ["stribeck"]).unwrap()
}

/// Viscous, Coulomb, height, velocity and exponent of the Stribeck curve.
const VALUES: [f64; 5] = [0.5, 2.0, 1.0, 0.05, 2.0];

fn within(reach: f64) -> Vec<[f64; 2]> {
    VALUES.iter().map(|x| [x * (1.0 - reach), x * (1.0 + reach)]).collect()
}

#[test]
fn exactly_known_friction_may_be_cancelled_completely() {
    let found =
        largest_factor((&spec(), &VALUES), (&spec(), &within(0.0)), &SIDES, BUDGET).unwrap();
    assert_eq!(found.proved, 1.0);
}

#[test]
fn compensator_values_may_lie_outside_the_bounds() {
    // Another Stribeck velocity, in which the curve is nonlinear.
    let mut other = VALUES;
    other[3] *= 4.0;
    for (cancels, resists) in [(VALUES, other), (other, VALUES)] {
        let points = resists.map(|x| [x, x]);
        let found =
            largest_factor((&spec(), &cancels), (&spec(), &points), &SIDES, BUDGET).unwrap();
        let (cancels, resists) = (spec().with(&cancels).unwrap(), spec().with(&resists).unwrap());
        let ratio = |v: f64| {
            let sample = Sample::at(v);
            resists.static_torque(&sample) / cancels.static_torque(&sample)
        };
        let least = (1..20_000).map(|k| ratio(1e-4 * f64::from(k))).fold(f64::INFINITY, f64::min);
        assert!(found.proved <= least, "{} above {least}", found.proved);
        assert!(found.proved > 0.99 * least, "{} far below {least}", found.proved);
    }
}

#[test]
fn no_friction_within_the_bounds_is_exceeded() {
    let reach = 0.04;
    let found =
        largest_factor((&spec(), &VALUES), (&spec(), &within(reach)), &SIDES, BUDGET).unwrap();
    let nominal = spec().with(&VALUES).unwrap();
    let mut least = f64::INFINITY;
    for corner in 0..32_u32 {
        let sign = |k: usize| if corner >> k & 1 == 1 { 1.0 } else { -1.0 };
        let values: Vec<f64> =
            VALUES.iter().enumerate().map(|(k, x)| x * (1.0 + reach * sign(k))).collect();
        let other = spec().with(&values).unwrap();
        for k in 1..3000 {
            let sample = Sample::at(-1.0 + 1e-3 * f64::from(k) + 1e-7);
            least = least.min(other.static_torque(&sample) / nominal.static_torque(&sample));
        }
    }
    assert!(found.proved <= least, "{} above {least}", found.proved);
    // The bound is also tight.
    assert!(found.proved > least - 0.02, "{} far below {least}", found.proved);
    assert!(found.proved <= found.at_point);
}

/// Bounds or a box that are empty, reversed or not finite would prove anything.
#[test]
fn what_is_no_interval_is_refused() {
    let of = |values: &[f64], bounds: &[[f64; 2]], sides: &[Side]| {
        largest_factor((&spec(), values), (&spec(), bounds), sides, BUDGET)
    };
    for (lower, upper) in [
        (2.0, -2.0),
        (f64::NAN, 1.0),
        (0.0, f64::NAN),
        (0.0, f64::INFINITY),
        (f64::NEG_INFINITY, 0.0),
    ] {
        let mut bounds = within(0.1);
        bounds[1] = [lower, upper];
        let error = of(&VALUES, &bounds, &SIDES).unwrap_err();
        assert!(matches!(error, PassivityError::Bounds(1, _)), "{lower} {upper}: {error}");
        assert!(error.to_string().ends_with("of parameter 2 are not two finite numbers in order"));
        let sides = [Side { channel: Channel::Velocity, lower, upper }];
        let error = of(&VALUES, &within(0.1), &sides).unwrap_err();
        assert!(matches!(error, PassivityError::Range(_)), "{lower} {upper}: {error}");
    }
    let mut values = VALUES;
    values[1] = f64::NAN;
    assert!(matches!(of(&values, &within(0.1), &SIDES), Err(PassivityError::Model(_))));
    let twice = [SIDES[0], SIDES[0]];
    let error = of(&VALUES, &within(0.1), &twice).unwrap_err();
    assert!(matches!(error, PassivityError::Repeated(Channel::Velocity)));
}

#[test]
fn no_factor_is_proved_for_a_law_that_intervals_cannot_follow() {
    let bam = Spec::new("bam_m6", []).unwrap();
    let values: Vec<f64> = bam.parameters().map(|p| p.start).collect();
    let bounds: Vec<_> = values.iter().map(|&x| [x, x]).collect();
    let sides: Vec<_> = [Channel::Velocity, Channel::MotorTorque, Channel::ExternalTorque]
        .map(|channel| Side { channel, lower: -1.0, upper: 1.0 })
        .into();
    let error = largest_factor((&bam, &values), (&bam, &bounds), &sides, BUDGET).unwrap_err();
    assert_eq!(error, PassivityError::Branches);
}

/// Friction that drives the motion where little is cancelled: the ratio there is far below the one
/// over the most that is cancelled.
#[test]
fn no_factor_is_admissible_where_friction_drives() {
    let plain = Spec::new("coulomb", []).unwrap();
    let (cancels, drives) = ([1.0, 1e-3], [[0.0; 2], [-1.0; 2]]);
    let found = largest_factor((&plain, &cancels), (&plain, &drives), &SIDES, BUDGET).unwrap();
    let slowest = cancels[1] + 1e-9;
    assert!(found.proved <= -1.0 / slowest, "{found:?}");
    assert!(found.at_point <= 0.0);
}
