//! The exact bristle step: properties that hold for any stiffness and any step.

use proptest::collection::vec;
use proptest::prop_assert;
use proptest::sample::select;

use super::super::{Bristle, BristleState};
use crate::common::close;
use crate::common::random::hold;
use crate::sample::{Split, StribeckCurve};

fn split(dry: f64) -> Split<f64> {
    Split { coulomb: dry, ..Split::zero() }
}

#[test]
fn two_half_steps_are_one_step() {
    for stiffness in [1.0, 1e3, 1e6] {
        for velocity in [-2.0, 1e-3, 0.4] {
            let bristle = Bristle::new(stiffness, 0.7);
            let (mut once, mut twice) = (BristleState { z: 1e-4 }, BristleState { z: 1e-4 });
            let whole = bristle.step(&mut once, &split(3.0), velocity, 0.02);
            let first = bristle.step(&mut twice, &split(3.0), velocity, 0.01);
            let second = bristle.step(&mut twice, &split(3.0), velocity, 0.01);
            close(once.z, twice.z, 1e-14);
            close(whole.torque, second.torque, 1e-13);
            close(whole.mean_torque, 0.5 * (first.mean_torque + second.mean_torque), 1e-12);
        }
    }
}

#[test]
fn agrees_with_many_small_explicit_steps() {
    let bristle = Bristle::new(500.0, 2.0);
    let (dry, velocity, dt, z0) = (3.0, 0.3_f64, 0.05, -4e-3);
    let n = 400_000;
    let h = dt / f64::from(n);
    // Explicit midpoint rule, error below 1e-12 at this step.
    let rate = |z: f64| velocity - bristle.stiffness * velocity.abs() / dry * z;
    let (mut z, mut area) = (z0, 0.0);
    for _ in 0..n {
        let middle = z + 0.5 * h * rate(z);
        area += h * (bristle.stiffness * middle + bristle.damping * rate(middle));
        z += h * rate(middle);
    }
    let mut state = BristleState { z: z0 };
    let step = bristle.step(&mut state, &split(dry), velocity, dt);
    close(state.z, z, 1e-10);
    close(step.torque, bristle.stiffness * z + bristle.damping * rate(z), 1e-10);
    close(step.mean_torque, area / dt, 1e-9);
}

#[test]
fn deflection_stays_bounded_and_finite() {
    let steps = vec((-4.0..4.0, select(&[0.0, 1e-300, 1e-12, 0.5, 4.0][..])), 100);
    for stiffness in [1.0, 1e5, 1e12] {
        let bristle = Bristle::new(stiffness, 1.0);
        hold(20, &steps, |steps| {
            let mut state = BristleState::default();
            for (velocity, dry) in steps {
                let step = bristle.step(&mut state, &split(dry), velocity, 0.002);
                prop_assert!(state.z.abs() <= 4.0 / stiffness * (1.0 + 1e-12), "{}", state.z);
                prop_assert!(step.torque.is_finite() && step.mean_torque.is_finite());
            }
            Ok(())
        });
    }
}

#[test]
fn rest_keeps_the_deflection() {
    let bristle = Bristle::new(1e4, 5.0);
    let mut state = BristleState { z: 1e-4 };
    for dry in [0.0, 2.0] {
        assert_eq!(bristle.step(&mut state, &split(dry), 0.0, 1.0).torque, 1.0);
        assert_eq!(state.z, 1e-4);
    }
}

#[test]
fn without_a_step_the_state_is_kept() {
    let bristle = Bristle::new(1e4, 5.0);
    let mut state = BristleState { z: 1e-4 };
    let step = bristle.step(&mut state, &split(2.0), 0.1, 0.0);
    assert_eq!(state.z, 1e-4);
    close(step.torque, 1.0 + 5.0 * (0.1 - 1e4 * 0.1 / 2.0 * 1e-4), 1e-14);
}

#[test]
fn work_of_a_cycle_is_never_gained() {
    // With constant velocities and the exact mean torque, stored plus dissipated energy equals the
    // work.
    let bristle = Bristle::new(2e3, 0.5);
    let mut state = BristleState::default();
    let (mut work, dt) = (0.0, 0.004);
    for i in 0..5000_i32 {
        let velocity = f64::from((i % 40) - 20) / 30.0;
        work += bristle.step(&mut state, &split(1.5), velocity, dt).mean_torque * velocity * dt;
        assert!(work >= 0.5 * bristle.stiffness * state.z * state.z - 1e-12);
    }
}

#[test]
fn bristle_approaches_the_static_law() {
    let bristle = Bristle::new(1e4, 30.0);
    let split = Split {
        coulomb: 2.0,
        height: 1.0,
        shape: StribeckCurve { value: 0.25, ..StribeckCurve::constant() },
        rate: -0.3,
        additive: 0.1,
        ..Split::zero()
    };
    let mut state = BristleState::default();
    let step = bristle.step(&mut state, &split, -0.5, 10.0);
    close(step.torque, split.torque(-1.0), 1e-14);
}
