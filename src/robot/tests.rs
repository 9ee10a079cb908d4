//! Consistency of the algorithms with each other; `tests/python/robot` has values of
//! another program.

use super::{Body, Inertial, LinkState, Movement, PARAMETERS, Pose, Tree};
use crate::joint::{Number, Vector};

const N: usize = 5;

/// Deterministic numbers between -1 and 1.
fn numbers(seed: usize) -> impl Iterator<Item = f64> {
    (0..).map(move |k: usize| {
        ((k * 7919 + seed * 104_729 + 13) as f64 * 0.618_033_988_75).fract() * 2.0 - 1.0
    })
}

/// A tree: links 2 and 3 stand on link 1, link 4 on link 2; one joint slides.
fn bodies() -> [Body<f64>; N] {
    let parents = [None, Some(0), Some(1), Some(1), Some(2)];
    core::array::from_fn(|k| {
        let mut draw = numbers(k + 1);
        let mut next = || draw.next().unwrap();
        let axis = Vector::from([next(), next(), next()]);
        let length = crate::math::f64::sqrt(f64::dot(&axis, &axis));
        let turn = Vector::from([0.6, 0.0, 0.8]);
        let placement = Pose {
            rotation: super::pose::about(&turn, next()),
            translation: Vector::from([next(), next(), next()]),
        };
        let centre = [0.2 * next(), 0.2 * next(), 0.2 * next()];
        let mass = 2.0 + next();
        let [x, y, z] = centre;
        let square = |a: f64, b: f64| mass * (a * a + b * b) + 0.05;
        let inertia =
            [square(y, z), -mass * x * y, square(x, z), -mass * x * z, -mass * y * z, square(x, y)];
        let moment = Vector::from(centre) * mass;
        Body {
            parent: parents[k],
            movement: if k == 3 { Movement::Prismatic } else { Movement::Revolute },
            axis: axis / length,
            placement,
            inertial: Inertial { mass, moment, inertia },
            rotor: 0.1 + 0.05 * k as f64,
        }
    })
}

fn parameters(bodies: &[Body<f64>; N]) -> [[f64; PARAMETERS]; N] {
    bodies.map(|body| {
        let Inertial { mass, moment, inertia: [xx, xy, yy, xz, yz, zz] } = body.inertial;
        [mass, moment.x, moment.y, moment.z, xx, xy, yy, xz, yz, zz, body.rotor]
    })
}

fn state(seed: usize) -> [f64; N] {
    let mut draw = numbers(seed);
    core::array::from_fn(|_| 3.0 * draw.next().unwrap())
}

#[test]
fn regressor_times_parameters_is_the_torque() {
    let bodies = bodies();
    let tree = Tree { bodies: &bodies, gravity: [0.3, -0.4, -9.7], coupling: None };
    let (mut states, mut torque) = ([LinkState::new(); N], [0.0; N]);
    let mut matrix = [0.0; N * N * PARAMETERS];
    let values = parameters(&bodies);
    for seed in 10..20 {
        let (q, v, a) = (state(seed), state(seed + 100), state(seed + 200));
        tree.inverse_dynamics(&q, &v, &a, &mut states, &mut torque);
        tree.regressor(&q, &v, &a, &mut states, &mut matrix);
        for (row, torque) in matrix.chunks(N * PARAMETERS).zip(torque) {
            let sum: f64 = row.iter().zip(values.as_flattened()).map(|(y, p)| y * p).sum();
            assert!((sum - torque).abs() < 1e-12 * torque.abs().max(100.0), "{sum} {torque}");
        }
    }
}

#[test]
fn mass_matrix_gravity_and_accelerations_agree_with_inverse_dynamics() {
    let bodies = bodies();
    let tree = Tree { bodies: &bodies, gravity: [0.3, -0.4, -9.7], coupling: None };
    let still = Tree { gravity: [0.0; 3], ..tree };
    let (mut states, mut torque) = ([LinkState::new(); N], [0.0; N]);
    let (mut mass, mut held) = ([0.0; N * N], [0.0; N]);
    for seed in 30..40 {
        let (q, v, a) = (state(seed), state(seed + 100), state(seed + 200));
        tree.mass_matrix(&q, &mut states, &mut mass);
        for k in 0..N {
            let unit = core::array::from_fn::<f64, N, _>(|j| if j == k { 1.0 } else { 0.0 });
            still.inverse_dynamics(&q, &[0.0; N], &unit, &mut states, &mut torque);
            for j in 0..N {
                assert!((mass[j * N + k] - torque[j]).abs() < 1e-11, "{j} {k}");
            }
        }
        tree.gravity_torque(&q, &mut states, &mut held);
        tree.inverse_dynamics(&q, &[0.0; N], &[0.0; N], &mut states, &mut torque);
        assert!(held.iter().zip(torque).all(|(a, b)| (a - b).abs() < 1e-12 * b.abs().max(10.0)));
        tree.inverse_dynamics(&q, &v, &a, &mut states, &mut torque);
        let mut found = [0.0; N];
        assert!(tree.forward_dynamics(&q, &v, &torque, &mut states, &mut mass, &mut found));
        for (found, a) in found.iter().zip(a) {
            assert!((found - a).abs() < 1e-9, "{found} {a}");
        }
    }
}

/// Differences of fourth order are near enough to show a wrong term.
#[test]
fn derivatives_are_the_slopes_of_the_torques() {
    let robot = super::Robot { bodies: bodies(), gravity: [0.3, -0.4, -9.7], coupling: None };
    for seed in 80..90 {
        let (q, v, a) = (state(seed), state(seed + 100), state(seed + 200));
        let [by_position, by_velocity] = robot.inverse_dynamics_derivatives(&q, &v, &a);
        let largest =
            robot.inverse_dynamics(&q, &v, &a).iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        for k in 0..N {
            let at = |x: &[f64; N], h: f64| {
                let mut moved = *x;
                moved[k] += h;
                moved
            };
            let slopes = [
                slope(|h| robot.inverse_dynamics(&at(&q, h), &v, &a)),
                slope(|h| robot.inverse_dynamics(&q, &at(&v, h), &a)),
            ];
            for (matrix, slope) in [&by_position, &by_velocity].into_iter().zip(slopes) {
                for (j, slope) in slope.iter().enumerate() {
                    let error = (matrix[(j, k)] - slope).abs();
                    assert!(error < 1e-8 * largest.max(1.0), "{j} {k}: {} {slope}", matrix[(j, k)]);
                }
            }
        }
    }
}

/// The derivative of torques at 0, by differences of fourth order.
fn slope(torque: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let h = 1e-3;
    let [up, down, far_up, far_down] = [h, -h, 2.0 * h, -2.0 * h].map(torque);
    core::array::from_fn(|j| (8.0 * (up[j] - down[j]) - (far_up[j] - far_down[j])) / (12.0 * h))
}

/// Without gravity and torque, kinetic energy stays: the Coriolis terms do no work.
#[test]
fn power_of_the_torques_is_the_change_of_energy() {
    let bodies = bodies();
    let tree = Tree { bodies: &bodies, gravity: [0.0; 3], coupling: None };
    let (mut states, mut torque, mut mass) = ([LinkState::new(); N], [0.0; N], [0.0; N * N]);
    let (q, v) = (state(50), state(51));
    tree.inverse_dynamics(&q, &v, &[0.0; N], &mut states, &mut torque);
    let power: f64 = torque.iter().zip(v).map(|(t, v)| t * v).sum();
    let mut energy = |h: f64| {
        let at: [f64; N] = core::array::from_fn(|k| q[k] + h * v[k]);
        tree.mass_matrix(&at, &mut states, &mut mass);
        (0..N * N).map(|k| 0.5 * v[k / N] * mass[k] * v[k % N]).sum::<f64>()
    };
    let change = (energy(1e-5) - energy(-1e-5)) / 2e-5;
    assert!((power - change).abs() < 1e-6 * power.abs().max(1.0), "{power} {change}");
}

#[test]
fn a_robot_without_mass_has_no_acceleration() {
    let mut bodies = bodies();
    bodies[4].inertial = Inertial::from_parameters([0.0; 10]);
    bodies[4].rotor = 0.0;
    let robot = super::Robot { bodies, gravity: [0.0; 3], coupling: None };
    assert_eq!(robot.forward_dynamics(&state(1), &state(2), &state(3)), None);
}

/// The bodies in single precision.
fn single(bodies: &[Body<f64>; N]) -> [Body<f32>; N] {
    bodies.map(|body| {
        let [mass, x, y, z, xx, xy, yy, xz, yz, zz, rotor] =
            parameters(&[body; N])[0].map(|x| x as f32);
        Body {
            parent: body.parent,
            movement: body.movement,
            axis: body.axis.map(|x| x as f32),
            placement: Pose {
                rotation: body.placement.rotation.map(|x| x as f32),
                translation: body.placement.translation.map(|x| x as f32),
            },
            inertial: Inertial::from_parameters([mass, x, y, z, xx, xy, yy, xz, yz, zz]),
            rotor,
        }
    })
}

/// Single precision has a relative spacing of 1.2e-7. Motions are exact in it, so that what remains
/// is rounding of the robot's numbers and of the sums along the chain.
#[test]
fn single_precision_is_close_to_double() {
    let bodies = bodies();
    let gravity = [0.3, -0.4, -9.7];
    let double = super::Robot { bodies, gravity, coupling: None };
    let robot = super::Robot {
        bodies: single(&bodies),
        gravity: gravity.map(|x| x as f32),
        coupling: None,
    };
    for seed in 0..200 {
        let [q, v, a] = [seed, seed + 300, seed + 600].map(|seed| state(seed).map(|x| x as f32));
        let wide = |x: [f32; N]| x.map(f64::from);
        let held = [
            (
                double.inverse_dynamics(&wide(q), &wide(v), &wide(a)),
                robot.inverse_dynamics(&q, &v, &a),
            ),
            (double.gravity_torque(&wide(q)), robot.gravity_torque(&q)),
        ];
        for (expected, found) in held {
            let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            for (expected, found) in expected.iter().zip(found) {
                let error = (f64::from(found) - expected).abs();
                assert!(error < 2e-6 * largest, "{found} {expected} {largest}");
            }
        }
    }
}

#[test]
fn feedforward_is_the_rigid_bodies_and_the_friction_under_their_load() {
    use crate::{Interval, Sample, Spec, State};

    let robot = super::Robot { bodies: bodies(), gravity: [0.3, -0.4, -9.7], coupling: None };
    let mut spec = Spec::new("lugre", ["load"]).unwrap();
    spec.set_constant("reference_load", 10.0).unwrap();
    let values = [1e3, 1.0, 0.5, 2.0, 2.5, 0.1, 1.7, 0.2, 1.0, 0.1, 1.2];
    let law = spec.with(&values).unwrap();
    let mut arm = super::ArmFeedforward::new(robot, [law; N]);
    let mut states = [State::default(); N];
    let planned = |seed| {
        let (q, v, a) = (state(seed), state(seed + 100), state(seed + 200));
        core::array::from_fn::<_, N, _>(|k| Sample {
            position: q[k],
            acceleration: a[k],
            ..Sample::at(v[k])
        })
    };
    for seed in 60..80 {
        let planned = planned(seed);
        let load = robot.inverse_dynamics(
            &planned.map(|x| x.position),
            &planned.map(|x| x.velocity),
            &planned.map(|x| x.acceleration),
        );
        let torque = arm.torque(&planned, 1e-3);
        for k in 0..N {
            let sample = Sample { load_torque: load[k], ..planned[k] };
            let friction = law.step_over(&mut states[k], &Interval::constant(sample, 1e-3)).torque;
            assert_eq!(torque[k], load[k] + friction);
            assert!(friction.abs() > 1e-3);
        }
    }
    let again = arm.torque(&planned(60), 1e-3);
    arm.reset();
    assert_ne!(arm.torque(&planned(60), 1e-3), again);
}
