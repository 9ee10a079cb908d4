//! Proofs of passivity: certificates against random motions, and counterexamples that generate
//! energy.

#![cfg(feature = "std")]

use std::cell::Cell;

use crate::common;
use crate::common::random::{cases, hold, runner};
use proptest::array::uniform2;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::{option, prop_assert, proptest};
use stribeck::catalog::LawId;
use stribeck::passivity::{
    Condition, Hold, Margin, PassivityError, Point, Side, Verdict, check, requirements, work,
};
use stribeck::{Channel, Composed, Real, Sample, Spec, State};

const BUDGET: usize = 400_000;

/// s0, s1, s2, Fc, Fs, vs, alpha of Canudas de Wit et al. 1995.
const LUGRE_1995: [f64; 7] = [1e5, 316.227_766_016_837_95, 0.4, 1.0, 1.5, 1e-3, 2.0];

/// A point of the box; half of the speeds are uniform over decades.
#[allow(clippy::disallowed_methods)]
fn point(sides: &[Side]) -> impl Strategy<Value = Point> + use<> {
    let sides = sides.to_vec();
    (vec(0.0..=1.0, sides.len()), option::of(-6.0..0.0)).prop_map(move |(shares, decade)| {
        let mut point = Sample::at(0.0);
        for (side, share) in sides.iter().zip(shares) {
            let share: f64 = share;
            let mut x = side.lower + share * (side.upper - side.lower);
            if let (Channel::Velocity, Some(decade)) = (side.channel, decade) {
                x = (x * 10_f64.powf(decade)).clamp(side.lower, side.upper);
            }
            match side.channel {
                Channel::Velocity => point.velocity = x,
                Channel::Position => point.position = x,
                Channel::Acceleration => point.acceleration = x,
                Channel::Temperature => point.temperature = x,
                Channel::LoadTorque => point.load_torque = x,
                Channel::LoadTorqueCurvature => point.load_torque_curvature = x,
                Channel::TemperatureRate => point.temperature_rate = x,
                Channel::MotorTorque => point.motor_torque = x,
                Channel::ExternalTorque => point.external_torque = x,
                Channel::Time => point.time = x,
            }
        }
        point
    })
}

fn side(channel: Channel, lower: f64, upper: f64) -> Side {
    Side { channel, lower, upper }
}

fn speed(limit: f64) -> Vec<Side> {
    vec![side(Channel::Velocity, -limit, limit)]
}

/// A range for every channel.
fn wide() -> Vec<Side> {
    vec![
        side(Channel::Velocity, -0.9, 0.8),
        side(Channel::Position, -0.4, 0.6),
        side(Channel::Acceleration, -2.0, 2.0),
        side(Channel::Temperature, 22.0, 38.0),
        side(Channel::LoadTorque, -6.0, 5.0),
        side(Channel::LoadTorqueCurvature, -3.0, 3.0),
        side(Channel::TemperatureRate, -0.1, 0.1),
        side(Channel::MotorTorque, -7.0, 7.0),
        side(Channel::ExternalTorque, -5.0, 6.0),
        side(Channel::Time, 0.0, 2.0),
    ]
}

fn made(spec: &str) -> Spec {
    let (law, effects) = spec.split_once('+').unwrap_or((spec, ""));
    Spec::new(law, effects.split('+').filter(|effect| !effect.is_empty())).unwrap()
}

fn verdict(spec: &str, values: &[f64], sides: &[Side]) -> Verdict {
    check(&made(spec), values, sides, BUDGET).unwrap()
}

fn margin(verdict: &Verdict, condition: Condition) -> Margin {
    *verdict.margins.iter().find(|margin| margin.condition == condition).unwrap()
}

/// Checks that the counterexample generates energy and ends in its initial state.
fn breaks(model: &Composed<f64>, verdict: &Verdict) {
    let example =
        verdict.counterexample.as_ref().expect("a model that is not passive has a counterexample");
    let (work, end) = work(model, example.deflection, &example.holds);
    assert!(work < 0.0, "{verdict:?}");
    assert_eq!(work, example.work);
    if let Some(start) = example.deflection {
        assert!((end - start).abs() <= 1e-9 * start.abs().max(end.abs()), "{start} {end}");
    }
}

/// Every law, alone and with effects, static or in steady sliding: no sample contradicts a proof,
/// and each counterexample generates energy.
#[test]
fn no_sample_contradicts_a_certificate() {
    let sides = wide();
    let (mut proved, mut broken) = (0, 0);
    for spec in common::every_model() {
        let values = common::values(&spec);
        let model = spec.with(&values[..]).unwrap();
        let found = match check(&spec, &values, &sides, BUDGET / 20) {
            Ok(found) => found,
            Err(PassivityError::NoBristle(point, _)) => {
                assert!(model.split(&point).dry() <= 0.0, "{spec}");
                continue;
            }
            Err(error) => panic!("{spec}: {error}"),
        };
        match found.passive {
            Some(true) => {
                proved += 1;
                hold(1_000, &point(&sides), |point| {
                    let split = model.split(&point);
                    let along = if model.has_state() {
                        split.dry() + (split.rate + split.additive) * point.velocity.sign()
                    } else {
                        split.torque(point.velocity.sign()) * point.velocity.sign()
                    };
                    prop_assert!(along >= found.margins[0].lower - 1e-12, "{spec} {point:?}");
                    Ok(())
                });
            }
            Some(false) => {
                broken += 1;
                breaks(&model, &found);
            }
            None => assert_eq!(found.counterexample, None),
        }
    }
    assert!(proved >= 60 && broken >= 3, "{proved} proved, {broken} broken");
}

/// Static laws with parameters of any sign and magnitude: nearly all are decided, and none wrongly.
#[test]
fn static_laws_with_any_parameters_are_decided() {
    let sides = wide();
    let [proved, broken, open] = [const { Cell::new(0) }; 3];
    let add = |count: &Cell<u32>| count.set(count.get() + 1);
    for law in LawId::ALL {
        let spec = Spec::new(law.info().id, []).unwrap();
        if spec.has_state() {
            continue;
        }
        let usual = common::values(&spec);
        hold(10, &vec(-0.5..1.5, usual.len()), |scales| {
            let values: Vec<_> = usual.iter().zip(scales).map(|(x, scale)| x * scale).collect();
            let Ok(model) = spec.with(&values[..]) else { return Ok(()) };
            let found = check(&spec, &values, &sides, BUDGET / 10).unwrap();
            match found.passive {
                Some(true) => {
                    add(&proved);
                    hold(1_000, &point(&sides), |point| {
                        let power = model.static_torque(&point) * point.velocity;
                        prop_assert!(power >= -1e-12, "{spec} {values:?} {point:?}");
                        Ok(())
                    });
                }
                Some(false) => {
                    add(&broken);
                    breaks(&model, &found);
                }
                None => add(&open),
            }
            Ok(())
        });
    }
    let [proved, broken, open] = [proved, broken, open].map(Cell::into_inner);
    eprintln!("{proved} proved, {broken} broken, {open} not decided");
    assert!(proved > 50 && broken > 50 && open * 10 < proved + broken);
}

#[test]
fn the_margin_is_the_least_friction() {
    let found = verdict("coulomb", &[0.5, 2.0], &speed(3.0));
    assert_eq!((found.passive, found.condition), (Some(true), Condition::Sliding));
    let sliding = margin(&found, Condition::Sliding);
    assert!(sliding.lower <= 2.0 && sliding.lower > 1.99, "{sliding:?}");
}

#[test]
fn friction_that_drives_the_motion_is_found() {
    // a1 v + a2 + a3/(1 + exp(-a4 (v + a5))): the offset drives slow motion.
    let gaz = [0.2, 0.1, 1.0, 20.0, 0.0];
    let found = verdict("gaz_a", &gaz, &speed(1.0));
    assert_eq!(found.passive, Some(false));
    breaks(&made("gaz_a").with(&gaz[..]).unwrap(), &found);
    let centred = verdict("gaz_a", &[0.2, -0.5, 1.0, 20.0, 0.0], &speed(1.0));
    assert_eq!(centred.passive, Some(true));
    // 2.2 - 3 v^2 + v^3 falls below zero between 1.06 and 2.7.
    let cubic = [2.2, 0.0, -3.0, 1.0];
    assert_eq!(verdict("hao_a", &cubic, &speed(1.0)).passive, Some(true));
    let found = verdict("hao_a", &cubic, &speed(3.0));
    assert_eq!(found.passive, Some(false));
    breaks(&made("hao_a").with(&cubic[..]).unwrap(), &found);
}

#[test]
fn the_1995_example_is_passive_up_to_its_limit_and_not_above() {
    let model = made("lugre").with(&LUGRE_1995[..]).unwrap();
    for limit in [0.01, 0.03, 0.0375] {
        let found = verdict("lugre", &LUGRE_1995, &speed(limit));
        assert_eq!(found.passive, Some(true), "{limit}: {found:?}");
    }
    for limit in [0.0385, 0.05, 1.0] {
        let found = verdict("lugre", &LUGRE_1995, &speed(limit));
        assert_eq!((found.passive, found.condition), (Some(false), Condition::Cycle));
        breaks(&model, &found);
    }
}

/// Property 1 of Tadese et al. 2021, and a case where it is too strict: with constant dry friction
/// the bristle never leaves `|x| <= 1`, and any damping is passive.
#[test]
fn property_1_is_sufficient_and_needlessly_strict() {
    let kind = |damping: f64| [1e3, damping, 0.1, 1.0, 1.0, 0.1, 2.0];
    let mild = verdict("lugre", &kind(3.9), &speed(1.0));
    assert_eq!(mild.passive, Some(true));
    assert_eq!(mild.condition, Condition::Resistance);
    assert!(margin(&mild, Condition::Damping).lower >= 0.0);
    let strong = verdict("lugre", &kind(50.0), &speed(1.0));
    assert!(margin(&strong, Condition::Damping).upper.unwrap() < 0.0);
    assert_eq!((strong.passive, strong.condition), (Some(true), Condition::Storage));
    // Falling dry friction: the exact condition still holds where 4 D/|v| does not.
    let found = verdict("lugre", &LUGRE_1995, &speed(0.03));
    assert!(margin(&found, Condition::Damping).upper.unwrap() < 0.0);
    assert_eq!((found.passive, found.condition), (Some(true), Condition::Cycle));
}

proptest! {
    #![proptest_config(cases(80))]

    /// Barabanov and Ortega's `s2 > s1 (Fs - Fc)/Fc` is sufficient over any box.
    #[test]
    fn known_passive_models_are_certified_and_random_cycles_agree(
        coulomb in 0.5..3.0,
        height in 0.0..2.0,
        damping in 0.1..100.0,
        velocity in 0.01..0.3,
        limit in 0.05..3.0,
    ) {
        let viscous = damping * height / coulomb * 1.05 + 0.01;
        let values = [1e4, damping, viscous, coulomb, coulomb + height, velocity, 2.0];
        let sides = speed(limit);
        let found = verdict("lugre", &values, &sides);
        prop_assert_eq!(found.passive, Some(true), "{:?}", found);
        let model = made("lugre").with(&values[..]).unwrap();
        hold(500, &cycle(&sides), |cycle| {
            let work = cycle.work(&model);
            prop_assert!(work.is_none_or(|work| work >= -1e-15), "{work:?}");
            Ok(())
        });
    }

    /// Models that a cycle inside the box proves not passive: found by random cycles and by the check.
    #[test]
    fn models_violated_by_a_random_cycle_are_not_passive(
        coulomb in 0.5..3.0,
        damping in 10.0..500.0,
        height in 0.3..2.0,
        velocity in 0.001..0.05,
        limit in 0.1..1.0,
    ) {
        let values = [1e5, damping, 0.01, coulomb, coulomb + height, velocity, 2.0];
        let sides = speed(limit);
        let model = made("lugre").with(&values[..]).unwrap();
        let (cycles, mut runner) = (cycle(&sides), runner(1));
        let breaks_here = (0..2_000).any(|_| {
            let cycle = cycles.new_tree(&mut runner).unwrap().current();
            cycle.work(&model).is_some_and(|work| work < -1e-9)
        });
        prop_assume!(breaks_here);
        let found = verdict("lugre", &values, &sides);
        prop_assert_eq!(found.passive, Some(false), "{:?}", found);
        breaks(&model, &found);
    }
}

/// A proved model violates no requirement, and a model that violates one is not proved.
#[test]
fn requirements_agree_with_certificates() {
    let [met, missed] = [const { Cell::new(0) }; 2];
    let models = (0.5..3.0, 0.0..2.0, 0.1..300.0, 0.0..2.0, 0.05..1.0);
    hold(60, &models, |(coulomb, height, damping, viscous, limit)| {
        let values = [1e4, damping, viscous, coulomb, coulomb + height, 0.02, 2.0];
        let sides = speed(limit);
        let (spec, found) = (made("lugre"), verdict("lugre", &values, &sides));
        let asked = requirements(&spec, &values, &sides).unwrap();
        let model = spec.with(&values[..]).unwrap();
        let least = asked.iter().map(|r| r.margin(&model)).fold(f64::INFINITY, f64::min);
        match found.passive {
            Some(true) => {
                met.set(met.get() + 1);
                prop_assert_eq!(found.open, None);
                prop_assert!(least >= -1e-12, "{values:?} {least}");
            }
            Some(false) => {
                missed.set(missed.get() + 1);
                let open = found.open.expect("a violated requirement is returned");
                prop_assert!(open.margin(&model) < 0.0, "{values:?} {open:?}");
            }
            None => prop_assert!(least > -1e-9),
        }
        Ok(())
    });
    let (met, missed) = (met.get(), missed.get());
    assert!(met >= 10 && missed >= 10, "{met} met, {missed} missed");
}

#[test]
fn gradients_of_requirements_equal_those_of_their_margins() {
    let sides = wide();
    for name in ["lugre", "tadese_full", "dahl", "bittencourt_b", "hao_a"] {
        let spec = made(name);
        let values = common::values(&spec);
        for asked in requirements(&spec, &values, &sides).unwrap() {
            let (margin, slopes) = asked.gradient(&spec, &values).unwrap();
            assert_eq!(margin, asked.margin(&spec.with(&values[..]).unwrap()));
            for (k, slope) in slopes.iter().enumerate() {
                let step = 1e-6 * values[k].abs().max(1e-6);
                let at = |by: f64| {
                    let mut moved = values.clone();
                    moved[k] += by;
                    asked.margin(&spec.with(&moved[..]).unwrap())
                };
                let difference = (at(step) - at(-step)) / (2.0 * step);
                let size = slope.abs().max(difference.abs()) + margin.abs() / values[k].abs();
                assert!((slope - difference).abs() <= 1e-4 * size, "{name} {asked:?} {k}");
            }
        }
    }
}

/// A cycle of a bristle between two points and two forces, as shares of its strength.
#[derive(Clone, Debug)]
struct Cycle {
    points: [Point; 2],
    forces: [f64; 2],
}

fn cycle(sides: &[Side]) -> impl Strategy<Value = Cycle> + use<> {
    (point(sides), point(sides), uniform2(-1.0..1.0))
        .prop_map(|(up, down, forces)| Cycle { points: [up, down], forces })
}

impl Cycle {
    /// Its work, if it closes.
    #[allow(clippy::disallowed_methods)]
    fn work(&self, model: &Composed<f64>) -> Option<f64> {
        let stiffness = model.deflection(&self.points[0]).unwrap().stiffness;
        let strongest = model.split(&Sample::at(1e-9)).dry();
        let ends = self.forces.map(|share| share * strongest / stiffness);
        let mut holds = Vec::new();
        for (k, point) in self.points.into_iter().enumerate() {
            // z tends to its end at the rate r, at constant velocity.
            let rate = stiffness * point.velocity.abs() / model.split(&point).dry();
            let end = point.velocity / rate;
            let (from, to) = (ends[k], ends[1 - k]);
            let duration = ((end - from) / (end - to)).ln() / rate;
            if !(duration.is_finite() && duration > 0.0) {
                return None;
            }
            holds.push(Hold { point, duration });
        }
        let (work, end) = work(model, Some(ends[0]), &holds);
        // The energy left in the bristle due to rounding.
        let left = stiffness * end.abs().max(ends[0].abs()) * (end - ends[0]).abs();
        Some(work + left)
    }
}

#[test]
fn other_single_deflections() {
    let dahl = verdict("dahl", &[1e4, 2.0, 1.5], &speed(1.0));
    assert_eq!((dahl.passive, dahl.condition), (Some(true), Condition::Storage));
    let bristle = verdict("coulomb+presliding", &[0.4, 1.0, 1e4, 10.0], &speed(0.3));
    assert_eq!(bristle.passive, Some(true));
    // The smoothed sign prevents the bristle from unloading in a slow reversal.
    let indri = [1e4, 0.1, 1.0, 0.1, 1e3, 1.0, 0.2, 1.0, 0.3, 0.0];
    let mut sides = speed(1.0);
    sides.push(side(Channel::Acceleration, -1.0, 1.0));
    let found = verdict("indri_b", &indri, &sides);
    assert_eq!(found.passive, Some(false), "{found:?}");
    breaks(&made("indri_b").with(&indri[..]).unwrap(), &found);
}

/// For each certified law with a single deflection: from a relaxed state, random motions within the
/// box never extract energy, and where the storage function is that of the spring, the work is at
/// least the stored energy.
#[test]
fn random_motions_agree_with_certificates() {
    let sides = wide();
    let laws = ["lugre", "tadese_t", "tadese_full", "xiao", "dahl", "elastoplastic"];
    let mut certified = 0;
    for name in laws {
        let spec = Spec::new(name, []).unwrap();
        let values = common::values(&spec);
        let model = spec.with(&values[..]).unwrap();
        let found = check(&spec, &values, &sides, BUDGET).unwrap();
        if found.passive != Some(true) {
            breaks(&model, &found);
            continue;
        }
        certified += 1;
        hold(500, &vec((point(&sides), 0.0..0.02), 40), |motion| {
            let (mut state, mut work, mut effort) = (State::default(), 0.0, 0.0);
            for (point, duration) in motion {
                let step = model.step(&mut state, &point, duration);
                let taken = step.mean_torque * point.velocity * duration;
                work += taken;
                effort += taken.abs();
            }
            let stiffness = model.deflection(&Sample::at(1.0)).unwrap().stiffness;
            let spring = 0.5 * stiffness * state.deflection() * state.deflection();
            let stored = if found.condition == Condition::Cycle { 0.0 } else { spring };
            // The error of the elastoplastic step is up to 6e-6 of the dry friction.
            prop_assert!(work - stored >= -2e-5 * effort, "{name}: {work} {stored}");
            Ok(())
        });
    }
    assert!(certified >= 4, "{certified}");
}

#[test]
fn undecided_models_are_neither_passive_nor_not() {
    for law in [LawId::BlimanSorine, LawId::Leuven, LawId::Gms] {
        let spec = Spec::new(law.info().id, []).unwrap();
        let found = check(&spec, &common::values(&spec), &speed(1.0), BUDGET).unwrap();
        assert_eq!((found.passive, found.condition), (None, Condition::Unknown), "{spec}");
        assert_eq!(found.counterexample, None);
    }
    // Too few evaluations to decide.
    let found = check(&made("lugre"), &LUGRE_1995, &speed(0.0375), 2_000).unwrap();
    assert_eq!(found.passive, None);
}

#[test]
fn elements_of_constant_strength_are_passive() {
    let spec = made("gms:2");
    let names: Vec<_> = spec.parameters().map(|p| p.name).collect();
    let mut values = common::values(&spec);
    let height = names.iter().position(|name| *name == "stribeck_height").unwrap();
    values[height] = 0.0;
    let found = check(&spec, &values, &speed(1.0), BUDGET).unwrap();
    assert_eq!((found.passive, found.condition), (Some(true), Condition::Elements));
}

#[test]
fn invalid_boxes_are_refused() {
    let refused = |spec: &str, values: &[f64], sides: &[Side]| {
        check(&made(spec), values, sides, BUDGET).unwrap_err().to_string()
    };
    assert_eq!(refused("coulomb", &[0.5, 2.0], &[]), "the box gives no range for velocity");
    let spec = made("li");
    let mut sides = wide();
    sides[3] = side(Channel::Temperature, -5.0, 5.0);
    assert_eq!(
        refused("li", &common::values(&spec), &sides),
        "the box contains 0 degC, where the law is singular"
    );
    // An empty box would prove everything: friction here generates energy at every speed.
    let driving = [-5.0, 2.0];
    for (lower, upper) in [(2.0, -2.0), (f64::NAN, 1.0), (0.0, f64::NAN), (0.0, f64::INFINITY)] {
        let sentence = refused("coulomb", &driving, &[side(Channel::Velocity, lower, upper)]);
        assert!(sentence.ends_with("is not two finite numbers in order"), "{sentence}");
    }
    for (lower, upper) in [(0.0, 0.0), (-1e-40, 1e-40)] {
        let sentence = refused("coulomb", &driving, &[side(Channel::Velocity, lower, upper)]);
        assert_eq!(sentence, "the box contains no motion");
    }
    let twice = [speed(1.0), speed(0.1)].concat();
    assert_eq!(refused("coulomb", &driving, &twice), "the box gives two ranges for velocity");
    // A channel that the law does not read is checked too.
    let mut sides = speed(1.0);
    sides.push(side(Channel::Temperature, 30.0, 20.0));
    assert!(refused("coulomb", &driving, &sides).starts_with("the range 30 to 20 of temperature"));
    let weak = refused("lugre", &[1e4, 1.0, 0.1, 1.0, -0.5, 0.1, 2.0], &speed(1.0));
    assert!(weak.starts_with("a bristle needs dry friction above zero"), "{weak}");
}

/// A law that branches on the sizes of its channels: nothing is proved, not even a margin.
#[test]
fn nothing_is_claimed_of_a_law_that_intervals_cannot_follow() {
    let spec = made("bam_m6");
    let found = check(&spec, &common::values(&spec), &wide(), BUDGET).unwrap();
    assert_eq!((found.passive, found.condition), (None, Condition::Unknown));
    assert!(found.margins.iter().all(|margin| margin.lower == f64::NEG_INFINITY));
}

#[test]
fn a_counterexample_leaves_an_ordinary_state() {
    let model = made("lugre").with(&LUGRE_1995[..]).unwrap();
    let found = verdict("lugre", &LUGRE_1995, &speed(0.05));
    let example = found.counterexample.unwrap();
    let mut state = State::with_deflection(example.deflection.unwrap());
    let mut energy = 0.0;
    for _ in 0..10 {
        for hold in &example.holds {
            let step = model.step(&mut state, &hold.point, hold.duration);
            energy += step.mean_torque * hold.point.velocity * hold.duration;
        }
    }
    assert!((energy - 10.0 * example.work).abs() < 1e-6 * energy.abs(), "{energy}");
}
