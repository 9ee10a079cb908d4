//! A joint at rest stays at rest: no creep, no chatter, no self-excitation.

use crate::common;
use stribeck::catalog::LawId;
use stribeck::joint::{self, Joint, JointStep, Posture, Push};
use stribeck::{Composed, Memory, Sample, Spec, State};

const DT: f64 = 1e-3;

fn model(id: &str, values: &[f64]) -> Composed<f64> {
    Spec::new(id, []).unwrap().with(values).unwrap()
}

/// Applies a torque for `steps` steps; the result of each step.
fn pushed(
    friction: &Composed<f64>,
    joint: &Joint<f64>,
    start: Posture<f64>,
    steps: u32,
    torque: impl Fn(f64) -> f64,
) -> Vec<(Posture<f64>, JointStep<f64>)> {
    let (mut posture, mut state) = (start, State::default());
    (0..steps)
        .map(|k| {
            let time = f64::from(k) * DT;
            let push = Push { temperature: 30.0, time, ..Push::by_motor(torque(time)) };
            let mut body = joint.moving(posture, &push);
            let result = joint::step(friction, &mut state, &mut body, DT);
            posture = body.posture;
            (posture, result)
        })
        .collect()
}

const AT_REST: Posture<f64> = Posture { position: 0.0, velocity: 0.0 };

/// Every law without memory whose dry friction has the exact sign.
fn with_stiction() -> Vec<Spec> {
    LawId::ALL
        .iter()
        .map(|law| Spec::new(law.info().id, []).unwrap())
        .filter(|spec| {
            let values = common::values(spec);
            let split = spec.with(&values).unwrap().split(&Sample::at(1e-12));
            spec.memory() == Memory::None && split.torque(1.0) - split.torque(-1.0) > 1.0
        })
        .collect()
}

#[test]
fn sixty_seconds_of_load_cause_no_motion() {
    let specs = with_stiction();
    assert!(specs.len() > 10, "{} laws", specs.len());
    for spec in specs {
        let friction = spec.with(&common::values(&spec)).unwrap();
        let level = friction.static_torque(&Sample { temperature: 30.0, ..Sample::at(1e-12) });
        for share in [0.9, -0.9] {
            let steps = pushed(&friction, &Joint::free(0.3), AT_REST, 60_000, |_| share * level);
            let (posture, result) = steps.last().unwrap();
            assert_eq!(*posture, AT_REST, "{spec}");
            assert_eq!(result.friction, share * level, "{spec}");
        }
    }
}

/// With gravity, which depends on the position, and a joint that has to come to rest first.
#[test]
fn a_joint_that_comes_to_rest_stays_where_it_is() {
    let friction = model("bittencourt_a", &[2.0, 1.0, 0.1, 2.0, 0.3]);
    let start = Posture { position: 0.4, velocity: 1.7 };
    let joint = Joint::revolute(0.3, 1.2, 0.8);
    let steps = pushed(&friction, &joint, start, 60_000, |_| 0.5);
    let stop = steps.iter().position(|(posture, _)| posture.velocity == 0.0).unwrap();
    assert!(stop < 2000);
    let stopped = steps[stop].0;
    assert!(steps[stop..].iter().all(|(posture, _)| *posture == stopped));
    // No reversal before the stop: an explicit step would overshoot.
    assert!(steps[..stop].iter().all(|(posture, _)| posture.velocity > 0.0));
}

/// LuGre's example of 1995, loaded up to 80 % of its static friction within a second: the bristle
/// deflects a few micrometres and then stays.
#[test]
fn a_bristle_does_not_creep_under_constant_load() {
    let friction = model("lugre", &[1e5, 316.227_766_016_837_95, 0.4, 1.0, 1.5, 1e-3, 2.0]);
    let steps = pushed(&friction, &Joint::free(1.0), AT_REST, 60_000, |t| 1.2 * t.min(1.0));
    let (settled, at_end) = (steps[1_999].0.position, steps[59_999].0.position);
    assert!(settled > 1e-5 && settled < 5e-5, "{settled}");
    assert!((at_end - settled).abs() < 1e-12, "crept by {}", at_end - settled);
}

/// s0 and s1 of the six joints of Tadese et al. 2021, table 2, with the inertia of a light link:
/// the damping over a step exceeds the inertia, `s1 dt > 2 J`, where an explicit coupling diverges.
#[test]
fn the_joints_of_table_2_do_not_excite_themselves() {
    let table = [
        (16804.0, 270.0),
        (12930.0, 233.0),
        (1820.0, 105.0),
        (1649.0, 81.0),
        (1106.0, 72.0),
        (985.0, 68.0),
    ];
    for (stiffness, damping) in table {
        let coulomb = 0.002 * stiffness;
        let friction = model("lugre", &[stiffness, damping, 0.4, coulomb, coulomb, 0.1, 2.0]);
        let inertia = 0.4 * damping * DT;
        let push = 0.8 * coulomb;
        let steps = pushed(&friction, &Joint::free(inertia), AT_REST, 10_000, |_| push);
        let fastest = steps.iter().map(|(p, _)| p.velocity.abs()).fold(0.0, f64::max);
        // The speed change of one step without friction.
        assert!(fastest < push * DT / inertia);
        let late = &steps[5_000..];
        assert!(late.iter().all(|(posture, _)| posture.velocity.abs() < 1e-9));
        let explicit = explicit_speed(&friction, inertia, push);
        assert!(
            explicit.is_nan() || explicit > 1.0,
            "an explicit coupling comes to rest as well: {explicit}"
        );
    }
}

/// Largest speed in 200 steps with the friction at the previous velocity.
fn explicit_speed(friction: &Composed<f64>, inertia: f64, push: f64) -> f64 {
    let (mut velocity, mut state, mut fastest) = (0.0, State::default(), 0.0_f64);
    for _ in 0..200 {
        let step = friction.step(&mut state, &Sample::at(velocity), DT);
        velocity += DT / inertia * (push - step.mean_torque);
        fastest = fastest.max(velocity.abs());
    }
    fastest
}

/// A torque below the sliding friction: the analytic stop is met to rounding.
#[test]
fn a_stop_within_a_step_is_exact() {
    let friction = model("coulomb", &[0.0, 2.0]);
    let start = Posture { position: 0.0, velocity: 0.123_4 };
    let steps = pushed(&friction, &Joint::free(0.5), start, 100, |_| 0.7);
    let way = 0.5 * 0.5 * 0.123_4 * 0.123_4 / (2.0 - 0.7);
    let end = steps.last().unwrap().0;
    assert!((end.position - way).abs() < 1e-16, "{} instead of {way}", end.position);
    assert_eq!(end.velocity, 0.0);
}
