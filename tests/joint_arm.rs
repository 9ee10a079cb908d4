//! A planar arm with two joints, with friction in both.

use stribeck::joint::{ArmPosture, ArmPush, JointStep, PlanarArm};
use stribeck::{Composed, Spec, State};

const DT: f64 = 1e-3;

/// Nominal parameters of Indri et al., eq 15, with a first link of 0.35 m.
const ARM: PlanarArm<f64> =
    PlanarArm { inertia_1: 3.689, inertia_2: 0.275, moment_x: 0.35 * 0.97, moment_y: 0.35 * 0.1 };

fn model(id: &str, values: &[f64]) -> Composed<f64> {
    Spec::new(id, []).unwrap().with(values).unwrap()
}

fn moved(
    friction: [&Composed<f64>; 2],
    start: ArmPosture<f64>,
    steps: u32,
    torque: impl Fn(f64) -> [f64; 2],
) -> Vec<(ArmPosture<f64>, [JointStep<f64>; 2])> {
    let (mut posture, mut states) = (start, [State::default(); 2]);
    (0..steps)
        .map(|k| {
            let time = f64::from(k) * DT;
            let push = ArmPush { motor: torque(time), temperature: [30.0; 2], time };
            let result = ARM.step(friction, &mut states, &mut posture, &push, DT);
            (posture, result)
        })
        .collect()
}

const SWINGING: ArmPosture<f64> = ArmPosture { position: [0.2, -0.4], velocity: [1.5, -4.0] };

/// Without friction and motors, energy and angular momentum about the base are constant.
#[test]
fn a_free_arm_keeps_energy_and_angular_momentum() {
    let free = model("coulomb", &[0.0, 0.0]);
    let steps = moved([&free; 2], SWINGING, 20_000, |_| [0.0; 2]);
    let momentum = |p: &ArmPosture<f64>| {
        let [own, across, _] = ARM.inertia(p.position[1]);
        own * p.velocity[0] + across * p.velocity[1]
    };
    for (posture, _) in &steps {
        let energy = ARM.energy(posture) / ARM.energy(&SWINGING) - 1.0;
        assert!(energy.abs() < 1e-11, "energy changes by {energy:e}");
        let turning = momentum(posture) / momentum(&SWINGING) - 1.0;
        assert!(turning.abs() < 1e-11, "angular momentum changes by {turning:e}");
    }
    // The arm moves: the second joint makes full turns.
    assert!(steps.last().unwrap().0.position[1].abs() > 10.0);
}

/// In the limit of short steps the velocities change by the accelerations of forward dynamics.
#[test]
fn short_steps_follow_the_forward_dynamics() {
    let free = model("coulomb", &[0.0, 0.0]);
    for (second, velocity) in [(-0.4, [1.5, -4.0]), (2.0, [-2.0, 0.7]), (0.0, [0.0, 0.0])] {
        let start = ArmPosture { position: [0.3, second], velocity };
        let torque = [3.0, -1.2];
        let expected = ARM.acceleration(&start, torque).unwrap();
        let (dt, mut posture) = (1e-6, start);
        let push = ArmPush { motor: torque, temperature: [30.0; 2], time: 0.0 };
        ARM.step([&free; 2], &mut [State::default(); 2], &mut posture, &push, dt);
        for (joint, expected) in expected.into_iter().enumerate() {
            let taken = (posture.velocity[joint] - start.velocity[joint]) / dt;
            assert!((taken - expected).abs() < 1e-4 * expected.abs(), "{taken} {expected}");
        }
    }
}

#[test]
fn an_impossible_arm_has_no_acceleration() {
    let arm = PlanarArm { inertia_2: 0.01, ..ARM };
    assert_eq!(arm.acceleration(&SWINGING, [0.0; 2]), None);
}

#[test]
fn motor_work_is_stored_or_dissipated() {
    let frictions = [
        [model("coulomb", &[0.8, 5.0]), model("coulomb", &[0.2, 1.0])],
        [
            model("bittencourt_a", &[4.0, 2.0, 0.1, 2.0, 0.8]),
            model("lugre", &[900.0, 1.0, 0.2, 0.8, 1.2, 0.1, 2.0]),
        ],
    ];
    for [first, second] in &frictions {
        let mut before = SWINGING;
        #[allow(clippy::disallowed_methods)]
        let torque = |t: f64| [9.0 * (2.0 * t).sin(), 2.5 * (5.0 * t).cos()];
        for (after, result) in moved([first, second], SWINGING, 10_000, torque) {
            let (was, is) = (ARM.energy(&before), ARM.energy(&after));
            let given: f64 = result.iter().map(|t| t.motor_work).sum();
            let lost: f64 = result.iter().map(|t| t.friction_work).sum();
            let size = was.max(is).max(given.abs()).max(lost.abs());
            let imbalance = (given - lost - (is - was)).abs() / size;
            assert!(imbalance < 1e-11, "imbalance {imbalance:e}");
            before = after;
        }
    }
}

/// Dry friction in both joints: the arm comes to rest, one joint after the other, and stays at rest
/// for a minute.
#[test]
fn both_joints_stop_and_stay() {
    let friction = [model("coulomb", &[0.8, 5.0]), model("coulomb", &[0.2, 1.0])];
    let steps = moved([&friction[0], &friction[1]], SWINGING, 60_000, |_| [3.0, -0.6]);
    let still = |joint: usize| {
        steps.iter().position(|(posture, _)| posture.velocity[joint] == 0.0).unwrap()
    };
    assert_ne!(still(0), still(1));
    let end = steps[59_999].0;
    assert_eq!(end.velocity, [0.0; 2]);
    assert_eq!(end, steps[10_000].0);
    // Friction never generated energy.
    assert!(
        steps.iter().flat_map(|(_, result)| result).all(|result| result.friction_work >= -1e-15)
    );
}

/// A torque that overcomes friction in the first joint only moves it, and the second one sticks.
#[test]
fn friction_holds_a_joint_against_the_motion_of_the_other() {
    let friction = [model("coulomb", &[0.8, 1.0]), model("coulomb", &[0.2, 4.0])];
    let start = ArmPosture { position: [0.0; 2], velocity: [0.0; 2] };
    let steps = moved([&friction[0], &friction[1]], start, 1_000, |_| [3.0, 0.0]);
    let (end, result) = steps[999];
    assert!(end.velocity[0] > 0.2);
    assert_eq!(end.position[1], 0.0);
    // Its friction balances the torque due to the acceleration of the first joint.
    assert!(result[1].friction < -0.1, "{}", result[1].friction);
}
