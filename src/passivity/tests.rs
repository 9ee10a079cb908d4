//! Every law on boxes contains the law at points, whatever it branches on.

use std::vec::Vec;

use proptest::prelude::*;

use super::branches;
use super::cycles::{Outcome, Reach, examine};
use super::enclosure::Enclosure;
use super::friction::{Bristled, sliding};
use super::region::{Region, Side, at, faster_than, halves, pieces};
use super::{replay, spread};
use crate::catalog::LawId;
use crate::common;
use crate::common::random::hold;
use crate::composed::{Composed, Spec};
use crate::sample::Sample;
use crate::scalar::Real;
use crate::table::Channel;

const MOST: f64 = 8.0;

/// Ends of a side, as powers of ten and signs, and the place of a point between them.
fn side() -> impl Strategy<Value = (f64, f64, f64)> {
    let end = || {
        prop_oneof![
            -MOST..MOST,
            (-32.0..1.0, any::<bool>()).prop_map(|(power, negative)| {
                let size = Real::powf(10.0_f64, power);
                if negative { -size } else { size }
            })
        ]
    };
    (end(), end(), 0.0..=1.0)
}

/// Friction along the motion and what the proofs for bristles are made of, as (bounds, value).
fn quantities(
    bounded: &Composed<Enclosure>,
    exact: &Composed<f64>,
    region: &Region,
    point: &Sample<f64>,
) -> Vec<(Enclosure, f64)> {
    let mut all = [(sliding(bounded, region), sliding(exact, point))].to_vec();
    let pair = Bristled::of(bounded, region).zip(Bristled::of(exact, point));
    if let Some((whole, at)) = pair {
        all.extend([
            (whole.dry, at.dry),
            (whole.resistance, at.resistance),
            (whole.drag, at.drag),
            (whole.strength(), at.strength()),
        ]);
    }
    all
}

fn contains_its_points(spec: &Spec, values: &[f64]) {
    let numbers: Vec<_> = values.iter().map(|&x| Enclosure::point(x)).collect();
    let (bounded, exact) = (spec.with(&numbers).unwrap(), spec.with(values).unwrap());
    hold(20, &proptest::array::uniform10(side()), |ends| {
        let sides: Vec<_> = Channel::ALL
            .into_iter()
            .zip(ends)
            .map(|(channel, (a, b, _))| Side { channel, lower: a.min(b), upper: a.max(b) })
            .collect();
        for region in pieces(&sides) {
            let inside = |channel: Channel| {
                let (at, share) = (region.channel(channel), ends[channel as usize].2);
                let mixed = at.lower + share * (at.upper - at.lower);
                // Half of the points are uniform over decades.
                let decades = at.lower * Real::powf((at.upper / at.lower).abs(), share);
                let one = if share > 0.5 && decades.is_finite() { decades } else { mixed };
                one.clamp(at.lower, at.upper)
            };
            let point = Sample {
                velocity: inside(Channel::Velocity),
                position: inside(Channel::Position),
                acceleration: inside(Channel::Acceleration),
                temperature: inside(Channel::Temperature),
                load_torque: inside(Channel::LoadTorque),
                load_torque_curvature: inside(Channel::LoadTorqueCurvature),
                temperature_rate: inside(Channel::TemperatureRate),
                motor_torque: inside(Channel::MotorTorque),
                external_torque: inside(Channel::ExternalTorque),
                time: inside(Channel::Time),
            };
            for (k, (whole, at)) in
                quantities(&bounded, &exact, &region, &point).into_iter().enumerate()
            {
                // Where the law overflows at the point it has no value there.
                let contained = !at.is_finite() || whole.lower <= at && at <= whole.upper;
                prop_assert!(contained, "{spec} {k}: {whole:?} {at:e} {region:?} {point:?}");
            }
        }
        Ok(())
    });
}

#[test]
fn laws_on_boxes_contain_laws_at_points() {
    let mut checked = 0;
    for spec in common::every_model().into_iter().filter(|spec| !branches(spec)) {
        contains_its_points(&spec, &common::values(&spec));
        checked += 1;
    }
    assert!(checked > 2 * LawId::ALL.len() - 4, "{checked}");
}

/// With a damping that rests on the ratio of acceleration to speed.
#[test]
fn a_ratio_that_is_capped_is_contained() {
    let spec = Spec::new("indri_b", []).unwrap();
    let mut values = common::values(&spec);
    for (value, parameter) in values.iter_mut().zip(spec.parameters()) {
        match parameter.name {
            "damping_torque" => *value = 5.0,
            "acceleration_weight" => *value = 0.1,
            _ => {}
        }
    }
    contains_its_points(&spec, &values);
}

fn velocities(lower: f64, upper: f64) -> Vec<Region> {
    pieces(&[
        Side { channel: Channel::Velocity, lower, upper },
        Side { channel: Channel::Temperature, lower: 20.0, upper: 40.0 },
    ])
}

#[test]
fn only_the_faster_parts_of_regions_are_kept() {
    let kept = |speed: f64| -> Vec<_> {
        let fast = faster_than(&velocities(-2.0, 3.0), speed);
        fast.iter().map(|region| (region.velocity.lower, region.velocity.upper)).collect()
    };
    assert_eq!(kept(0.5), [(-2.0, -0.5), (0.5, 3.0)]);
    assert_eq!(kept(2.5), [(2.5, 3.0)], "no speed backward is so fast");
    assert_eq!(kept(4.0), []);
}

/// The points that guide a passive fit lie in their region, reach its ends and are not few.
#[test]
fn spread_points_reach_the_ends_of_their_region() {
    let channels = [Channel::Velocity, Channel::Temperature];
    for region in velocities(-1e-3, 3.0) {
        let points = spread::points(&region, &channels);
        assert!(points.len() >= 40, "{}", points.len());
        for channel in channels {
            let side = region.channel(channel);
            let all: Vec<_> = points.iter().map(|point| point.channel(channel)).collect();
            assert!(all.iter().all(|&x| side.lower <= x && x <= side.upper), "{channel:?}");
            assert!(all.contains(&side.lower) && all.contains(&side.upper), "{channel:?}");
        }
    }
}

/// Where a law gives the sign a width, steady sliding bends the bristle by the smoothed sign only.
#[test]
fn a_smoothed_sign_weakens_a_bristle_near_rest() {
    let mut smoothed = 0;
    for spec in common::every_model() {
        let Ok(model) = spec.with(&common::values(&spec)) else { continue };
        let part = |velocity| {
            let bristled = Bristled::of(&model, &Sample::at(velocity))?;
            Some(bristled.strength() / bristled.dry)
        };
        let (Some(slow), Some(fast)) = (part(1e-6), part(1e3)) else { continue };
        assert!((0.0..=1.0).contains(&slow), "{spec}: {slow}");
        assert!((fast - 1.0).abs() < 1e-5, "{spec}: {fast}");
        smoothed += usize::from(slow < 0.5);
    }
    assert!(smoothed > 0, "a law of the catalog smooths its sign");
}

/// s0, s1, s2, Fc, Fs, vs, alpha of Canudas de Wit et al. 1995, and the bounds of its numbers.
fn lugre() -> (Composed<f64>, Composed<Enclosure>) {
    let values = [1e5, 316.227_766_016_837_95, 0.4, 1.0, 1.5, 1e-3, 2.0];
    let spec = Spec::new("lugre", []).unwrap();
    let numbers = values.map(Enclosure::point);
    (spec.with(&values[..]).unwrap(), spec.with(&numbers[..]).unwrap())
}

/// `f^2/D + s1 v (1 - f/D) + s2 v`, beyond the increase of `f^2/(2 s0)`.
#[test]
fn dissipation_of_a_bristle_is_that_of_its_equations() {
    let (exact, bounded) = lugre();
    for speed in [1e-4, 0.002, 0.7] {
        let point = Sample::at(speed);
        let known = Bristled::of(&exact, &point).unwrap();
        let found = Bristled::of(&bounded, &at(&point)).unwrap();
        for force in [-1.2, -0.3, 0.4, 1.1] {
            let x = force / known.dry;
            let expected = force * x + 316.227_766_016_837_95 * speed * (1.0 - x) + 0.4 * speed;
            let bounds = found.dissipated(Enclosure::point(force));
            let slack = 1e-12 * (1.0 + expected.abs());
            assert!((bounds.lower - expected).abs() < slack, "{speed} {force}: {bounds:?}");
            assert!((bounds.upper - expected).abs() < slack, "{speed} {force}: {bounds:?}");
        }
    }
}

/// A cycle around a force that is only approached has no size.
#[test]
fn a_cycle_lies_strictly_inside_the_forces_that_are_reached() {
    let (_, bounded) = lugre();
    let regions = pieces(&[Side { channel: Channel::Velocity, lower: -1.0, upper: 1.0 }]);
    let active = |outer, inner| {
        let reach = Reach { outer, inner };
        match examine(&bounded, &regions, &[Channel::Velocity], reach, 20_000) {
            Outcome::Active { force, .. } => Some(force),
            _ => None,
        }
    };
    let whole = [-1.5, 1.5];
    let force = active(whole, whole).expect("the damping is too strong");
    let (below, above) = (force - 0.0625, force + 0.0625);
    assert_eq!(active([below, above], [below, above]), Some(force));
    let higher = active([below, above], [force, above]).expect("it is not that force alone");
    assert!(force < higher && higher < above, "{force} {higher}");
    assert_ne!(active([below, above], [below, force]), Some(force));
}

/// Between ends of one sign that differ by more than a factor of four, a cut is geometric.
#[test]
fn regions_are_cut_at_their_midpoints() {
    let cut = |lower: f64, upper: f64| {
        let mut region = Region::at(Enclosure::point(0.0));
        region.temperature = Enclosure { lower, upper };
        let [low, high] = halves(&region, Channel::Temperature).unwrap();
        assert_eq!((low.temperature.lower, high.temperature.upper), (lower, upper));
        assert_eq!(low.temperature.upper, high.temperature.lower);
        low.temperature.upper
    };
    for (lower, upper, expected) in [
        (1.0, 3.0, 2.0),
        (2.0, 6.0, 4.0),
        (1.0, 16.0, 4.0),
        (0.0625, 4.0, 0.5),
        (-16.0, -1.0, -4.0),
        (-3.0, -1.0, -2.0),
        (0.0, 16.0, 8.0),
        (-16.0, 0.0, -8.0),
        (-1.0, 16.0, 7.5),
    ] {
        assert_eq!(cut(lower, upper), expected, "{lower} {upper}");
    }
    let mut region = Region::at(Enclosure::point(0.0));
    region.temperature = Enclosure { lower: 1.0, upper: 1.0_f64.next_up() };
    assert!(halves(&region, Channel::Temperature).is_none());
}

/// With negative damping the fastest motion of the box in its own direction generates most energy.
#[test]
fn steady_sliding_is_replayed_at_the_speed_of_its_direction() {
    let spec = Spec::new("coulomb", []).unwrap();
    let values: Vec<_> = spec
        .parameters()
        .map(|parameter| if parameter.name == "coulomb_friction" { 0.1 } else { -1.0 })
        .collect();
    let model = spec.with(&values[..]).unwrap();
    for (velocity, fastest) in [(0.5, 4.0), (-0.5, -1.0)] {
        let found = replay::sliding(&model, &Sample::at(velocity), [-1.0, 4.0]);
        let held = found.holds[0].point.velocity;
        assert_eq!(held, fastest);
        let expected = held.abs() * (0.1 - held.abs());
        assert!((found.work - expected).abs() < 1e-12, "{}", found.work);
    }
}
