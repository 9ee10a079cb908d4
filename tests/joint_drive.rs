//! Ball screw, trajectories and controller.

use crate::common::close;
use stribeck::joint::{
    BallScrew, Controller, Effort, Fourier, HARMONICS, Profile, Reference, Stroke, Trajectory,
};

/// Table 1 of the gantry robot: 11.25 kg and 1.2298e-5 kg m2 are 23.053 kg with a pitch of 6.41 mm.
#[test]
fn the_gantry_has_its_equivalent_mass() {
    let screw = BallScrew { mass: 11.25, rotor_inertia: 1.2298e-5, pitch: 6.41e-3, gravity: 2.0 };
    close(screw.equivalent_mass(), 23.053, 1e-3);
    close(screw.ratio(), core::f64::consts::TAU / 6.41e-3, 1e-15);
    let joint = screw.joint();
    close(joint.inertia, screw.equivalent_mass(), 1e-15);
    close(joint.gravity.mean(0.7, 0.1), 2.0, 1e-15);
}

fn strokes() -> [Stroke<f64>; 3] {
    let stroke = |profile, dwell| Stroke { from: 0.3, to: -0.9, profile, dwell };
    [
        stroke(Profile::Trapezoid { speed: 0.8, acceleration: 4.0 }, 0.25),
        // Too short to reach the speed limit.
        stroke(Profile::Trapezoid { speed: 8.0, acceleration: 3.0 }, 0.0),
        stroke(Profile::Quintic { duration: 1.7 }, 0.25),
    ]
}

fn series() -> Fourier<f64> {
    let mut series =
        Fourier { centre: 0.4, frequency: 0.9, sine: [0.0; HARMONICS], cosine: [0.0; HARMONICS] };
    series.sine[..3].copy_from_slice(&[0.5, -0.2, 0.1]);
    series.cosine[..2].copy_from_slice(&[0.3, 0.05]);
    series
}

#[test]
fn velocity_and_acceleration_are_derivatives() {
    let trajectories = strokes().map(Trajectory::Stroke);
    let h = 1e-6;
    for trajectory in trajectories.into_iter().chain([Trajectory::Fourier(series())]) {
        for k in 0..4000_u32 {
            let time = f64::from(k) * 1.7e-3 + 1e-4;
            let [before, at, after] = [time - h, time, time + h].map(|t| trajectory.at(t));
            let speed = (after.position - before.position) / (2.0 * h);
            assert!((speed - at.velocity).abs() < 1e-5, "at {time} s");
            // The acceleration of a trapezoid jumps.
            if (after.acceleration - before.acceleration).abs() < 1e-3 {
                let rise = (after.velocity - before.velocity) / (2.0 * h);
                assert!((rise - at.acceleration).abs() < 1e-4, "at {time} s");
            }
        }
    }
}

#[test]
fn strokes_go_back_and_forth_within_their_limits() {
    for stroke in strokes() {
        let trajectory = Trajectory::Stroke(stroke);
        let at = |strokes: f64| trajectory.at(strokes * stroke.duration());
        for (strokes, place) in [(0.0, 0.3), (1.0, -0.9), (2.0, 0.3), (7.0, -0.9)] {
            let reference: Reference<f64> = at(strokes + 1e-9);
            assert!((reference.position - place).abs() < 1e-6, "after {strokes} strokes");
            assert!(reference.velocity.abs() < 1e-6);
        }
        if let Profile::Trapezoid { speed, acceleration } = stroke.profile {
            for k in 0..10_000_u32 {
                let reference = at(f64::from(k) * 3e-4);
                assert!(reference.velocity.abs() <= speed * (1.0 + 1e-12));
                assert!(reference.acceleration.abs() <= acceleration);
                assert!((-0.9..=0.3).contains(&reference.position));
            }
        }
    }
}

const CONTROLLER: Controller<f64> = Controller {
    proportional: 10.0,
    integral: 5.0,
    derivative: 2.0,
    velocity_weight: 0.5,
    limit: 8.0,
};

fn desired(position: f64, velocity: f64) -> Reference<f64> {
    Reference { position, velocity, acceleration: 0.0 }
}

#[test]
fn the_controller_is_a_pid() {
    let mut effort = Effort { integral: 0.3 };
    let torque = CONTROLLER.torque(&mut effort, &desired(0.5, 0.4), (0.2, -0.1), 0.7, 0.01);
    close(torque, 10.0 * 0.3 + 0.3 + 2.0 * (0.5 * 0.4 + 0.1) + 0.7, 1e-15);
    close(effort.integral, 0.3 + 5.0 * 0.3 * 0.01, 1e-15);
}

/// At the limit the integral is held; an error that leads away from the limit counts at once.
#[test]
fn the_integral_does_not_wind_up() {
    let mut effort = Effort { integral: 0.0 };
    for _ in 0..1000 {
        let torque = CONTROLLER.torque(&mut effort, &desired(2.0, 0.0), (0.0, 0.0), 0.0, 0.01);
        assert_eq!(torque, 8.0);
    }
    assert_eq!(effort.integral, 0.0);
    effort.integral = 20.0;
    CONTROLLER.torque(&mut effort, &desired(-0.1, 0.0), (0.0, 0.0), 0.0, 0.01);
    assert!(effort.integral < 20.0);
}
