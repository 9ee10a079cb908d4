//! Robots in motion with friction in every joint: against single joints, the planar arm, energy.
// The torques of a test may be of any function.
#![allow(clippy::disallowed_methods)]

use stribeck::joint::{self, Joint, JointStep, Number, Posture, Push, Vector};
use stribeck::robot::{
    Axis, Body, Coupled, Inertial, LinkState, Movement, Moving, Pose, Pushed, Robot, Room,
};
use stribeck::{Composed, Memory, Spec, State};

const DT: f64 = 1e-3;

fn model(id: &str, values: &[f64]) -> Composed<f64> {
    Spec::parse(id).unwrap().with(values).unwrap()
}

/// A robot in motion.
struct Run<P: Number, const N: usize> {
    robot: Robot<P, N>,
    friction: [Composed<P>; N],
    states: [State<P>; N],
    axes: [Axis<P>; N],
    time: P,
}

impl<P: Number, const N: usize> Run<P, N> {
    fn new(robot: Robot<P, N>, friction: [Composed<P>; N], start: [(P, P); N]) -> Self {
        let axes = start.map(|(position, velocity)| Axis::at(position, velocity));
        Self { robot, friction, states: [State::default(); N], axes, time: P::zero() }
    }

    fn step(&mut self, motor: [P; N], dt: P) -> [JointStep<P>; N] {
        let mut numbers = vec![P::zero(); Room::<P>::numbers(N)];
        let mut links = [LinkState::new(); N];
        let mut room = Room { links: &mut links, numbers: &mut numbers };
        let temperature = [P::from_f64(30.0); N];
        let pushed = Pushed { motor: &motor, temperature: &temperature, time: self.time };
        let moving = Moving { tree: self.robot.tree(), friction: &self.friction };
        let mut result = [JointStep::at_rest(); N];
        let (states, axes) = (&mut self.states, &mut self.axes);
        assert!(moving.step(states, axes, &pushed, &mut room, &mut result, dt));
        self.time += dt;
        result
    }
}

/// A link that hangs along -z, and turns about y.
fn pendulum() -> Robot<f64, 1> {
    let inertial = [2.0, 0.0, 0.0, -1.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0];
    Robot {
        bodies: [Body {
            parent: None,
            movement: Movement::Revolute,
            axis: Vector::from([0.0, 1.0, 0.0]),
            placement: Pose::identity(),
            inertial: Inertial::from_parameters(inertial),
            rotor: 0.1,
        }],
        gravity: [0.0, 0.0, -9.81],
        coupling: None,
    }
}

/// Friction with and without memory, with the load, and with what stops and breaks away.
fn laws() -> Vec<(&'static str, Composed<f64>)> {
    vec![
        ("coulomb", model("coulomb", &[0.5, 2.0])),
        ("load", model("coulomb+load", &[0.5, 2.0, 0.1, 1.0])),
        ("lugre", model("lugre", &[2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 1.3])),
        ("dahl", model("dahl", &[1500.0, 2.0, 1.0])),
    ]
}

#[test]
fn a_robot_of_one_joint_moves_as_the_joint_alone() {
    for (name, friction) in laws() {
        let single = Joint::revolute(0.6, 0.0, 9.81);
        let mut run = Run::new(pendulum(), [friction], [(0.3, 1.0)]);
        let (mut state, mut posture) = (State::default(), Posture { position: 0.3, velocity: 1.0 });
        let (mut rests, mut apart) = (0, 0.0_f64);
        for k in 0..4000 {
            let motor = 7.0 * (0.004 * f64::from(k)).sin();
            let push = Push { temperature: 30.0, time: f64::from(k) * DT, ..Push::by_motor(motor) };
            let mut body = single.moving(posture, &push);
            let expected = joint::step(&friction, &mut state, &mut body, DT);
            posture = body.posture;
            let [found] = run.step([motor], DT);
            apart = apart.max((run.axes[0].position - posture.position).abs());
            apart = apart.max((run.axes[0].velocity - posture.velocity).abs());
            apart = apart.max((found.friction - expected.friction).abs());
            rests += u32::from(posture.velocity == 0.0);
        }
        println!("{name}: {apart:e}, {rests} rests");
        assert!(apart < 1e-9, "{name}: {apart:e}");
        let stops = matches!(friction.memory(), Memory::None);
        assert_eq!(rests > 10, stops, "{name}");
    }
}

/// Two links of 0.5 m that swing in a vertical plane.
fn double_pendulum(coupling: Option<Coupled<f64, 2>>) -> Robot<f64, 2> {
    let link = [2.0, 0.0, 0.0, -0.6, 0.25, 0.0, 0.25, 0.0, 0.0, 0.01];
    let bodies = [None, Some(0)].map(|parent| Body {
        parent,
        movement: Movement::Revolute,
        axis: Vector::from([0.0, 1.0, 0.0]),
        placement: Pose {
            translation: Vector::from([0.0, 0.0, if parent.is_none() { 0.0 } else { -0.5 }]),
            ..Pose::identity()
        },
        inertial: Inertial::from_parameters(link),
        rotor: 0.05,
    });
    Robot { bodies, gravity: [0.0, 0.0, -9.81], coupling }
}

/// Kinetic and potential energy of the double pendulum at positions and velocities of its joints.
fn energy(robot: &Robot<f64, 2>, position: [f64; 2], velocity: [f64; 2]) -> f64 {
    let mass = robot.mass_matrix(&position);
    let v = Vector::from(velocity);
    let [first, second] = position;
    // First moments of 0.6 kg m, and the second link's mass on the first.
    let height = -(0.6 + 2.0 * 0.5) * first.cos() - 0.6 * (first + second).cos();
    0.5 * (mass * v).dot(&v) + 9.81 * height
}

const SWINGING: [(f64, f64); 2] = [(1.0, 2.0), (-0.7, -4.0)];

/// The largest change of energy of a double pendulum without friction over two seconds.
fn drift(dt: f64) -> f64 {
    let free = model("coulomb", &[0.0, 0.0]);
    let robot = double_pendulum(None);
    let mut run = Run::new(robot, [free, free], SWINGING);
    let at = |run: &Run<f64, 2>| {
        energy(&robot, run.axes.map(|axis| axis.position), run.axes.map(|axis| axis.velocity))
    };
    let before = at(&run);
    (0..(2.0 / dt) as u32).fold(0.0, |largest: f64, _| {
        run.step([0.0; 2], dt);
        largest.max((at(&run) - before).abs())
    })
}

#[test]
fn energy_stays_within_an_error_of_second_order() {
    let (coarse, fine) = (drift(2e-3), drift(1e-3));
    println!("{coarse:e} {fine:e}");
    assert!(fine < 1e-3, "{fine:e} of some 30 J");
    assert!((3.5..4.5).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}

/// The work of the motors is stored, or done against friction; bristles give theirs back.
#[test]
fn work_of_motors_is_energy_and_friction() {
    let robot = double_pendulum(None);
    let bristles = model("lugre", &[2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 1.3]);
    let stops = model("coulomb+load", &[0.1, 1.0, 0.1, 1.0]);
    let mut run = Run::new(robot, [bristles, stops], [(0.4, 0.0), (0.2, 0.0)]);
    let (mut work, mut lost) = (0.0, 0.0);
    for k in 0..2000 {
        let t = f64::from(k) * DT;
        for step in run.step([12.0 * (3.0 * t).sin(), 4.0 * (5.0 * t).cos()], DT) {
            work += step.motor_work;
            lost += step.friction_work;
        }
    }
    let [q, v] = [run.axes.map(|axis| axis.position), run.axes.map(|axis| axis.velocity)];
    let gained = energy(&robot, q, v) - energy(&robot, [0.4, 0.2], [0.0; 2]);
    println!("work {work}, lost {lost}, gained {gained}");
    assert!(lost > 1.0);
    assert!((work - lost - gained).abs() < 1e-4 * work.abs(), "{work} {lost} {gained}");
}

/// Below the level of breaking away a bristle bends like a spring, and springs back.
#[test]
fn a_loaded_bristle_springs_back() {
    let robot = Robot { gravity: [0.0; 3], ..double_pendulum(None) };
    let bristles = model("lugre", &[2000.0, 30.0, 1.5, 2.0, 2.7, 0.08, 1.3]);
    let mut run = Run::new(robot, [bristles, bristles], [(0.3, 0.0), (0.6, 0.0)]);
    for k in 0..4000 {
        run.step([0.5 * (f64::from(k) * 2e-3).min(1.0), 0.0], DT);
    }
    let bent = run.axes[0].position - 0.3;
    // 0.5 N m on 2000 N m/rad, a little more where the bristle yields.
    assert!((0.9 * 2.5e-4..1.5 * 2.5e-4).contains(&bent), "{bent:e}");
    assert!((run.states[0].deflection() * 2000.0 - 0.5).abs() < 1e-6);
    for k in 0..8000 {
        run.step([0.5 - 0.5 * (f64::from(k) * 1e-3).min(1.0), 0.0], DT);
    }
    let left = run.axes[0].position - 0.3;
    assert!(left.abs() < 0.4 * bent, "{left:e} of {bent:e}");
}

/// Joints hold and break away one by one, and exactly.
#[test]
fn dry_friction_holds_joints() {
    let robot = double_pendulum(None);
    let start = [0.4, 0.3];
    let [first, second] = robot.gravity_torque(&start);
    let holding = |share: f64| {
        let friction = [first, second].map(|held| model("coulomb", &[0.1, share * held.abs()]));
        let mut run = Run::new(robot, friction, start.map(|q| (q, 0.0)));
        for _ in 0..300 {
            run.step([0.0; 2], DT);
        }
        run.axes.map(|axis| axis.position)
    };
    assert_eq!(holding(1.001), start);
    let moved = holding(0.9);
    assert!((moved[0] - start[0]).abs() > 1e-3);
}

/// Coupled motors: the same motion, seen by other coordinates.
#[test]
fn coupled_motors_move_the_joints_of_the_same_robot() {
    let coupled = Coupled::new([[1.0, 0.0], [1.0, 1.0]]).unwrap();
    let robot = double_pendulum(Some(coupled));
    let free = model("coulomb", &[0.0, 0.0]);
    let [(q1, v1), (q2, v2)] = SWINGING;
    let start = [(q1, v1), (q1 + q2, v1 + v2)];
    let mut run = Run::new(robot, [free, free], start);
    let motor = [3.0, -1.0];
    let expected = robot.forward_dynamics(&[q1, q2], &[v1, v2], &[motor[0] + motor[1], motor[1]]);
    let dt = 1e-6;
    run.step(motor, dt);
    let after = run.axes.map(|axis| axis.velocity);
    let [a, b] = expected.unwrap();
    assert!(((after[0] - v1) / dt - a).abs() < 1e-3 * a.abs());
    assert!(((after[1] - v1 - v2) / dt - a - b).abs() < 1e-3 * (a + b).abs());
}

/// In single precision the motion is the same as far as its numbers reach.
#[test]
fn single_precision_follows_double() {
    let values = [2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 1.3];
    let single = Spec::parse("lugre").unwrap().with(&values.map(|x| x as f32)).unwrap();
    let double = model("lugre", &values);
    let robot = pendulum();
    let body = robot.bodies[0];
    let [x, y, z] = [0.0_f32, 0.0, -1.0];
    let narrow = Robot::<f32, 1> {
        bodies: [Body {
            parent: None,
            movement: body.movement,
            axis: Vector::from([0.0, 1.0, 0.0]),
            placement: Pose::identity(),
            inertial: Inertial::from_parameters([2.0, x, y, z, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0]),
            rotor: 0.1,
        }],
        gravity: [0.0, 0.0, -9.81],
        coupling: None,
    };
    let mut wide = Run::new(robot, [double], [(0.3, 1.0)]);
    let mut run = Run::new(narrow, [single], [(0.3, 1.0)]);
    for k in 0..1000 {
        let motor = 5.0 * (0.004 * f64::from(k)).sin();
        wide.step([motor], DT);
        run.step([motor as f32], DT as f32);
    }
    let apart = (f64::from(run.axes[0].position) - wide.axes[0].position).abs();
    assert!(apart < 1e-4, "{apart:e}");
}

/// Friction that grows faster with the load than the load itself stops a joint; energy never grows.
#[test]
fn friction_beyond_the_load_stops_a_joint() {
    let robot = double_pendulum(None);
    let jams = model("coulomb+load", &[0.5, 1.0, 0.5, 2.5]);
    let slides = model("coulomb", &[0.5, 1.0]);
    let mut run = Run::new(robot, [slides, jams], SWINGING);
    let mut before = energy(&robot, [1.0, -0.7], [2.0, -4.0]);
    for _ in 0..3000 {
        let lost: f64 = run.step([0.0; 2], DT).iter().map(|step| step.friction_work).sum();
        let [q, v] = [run.axes.map(|axis| axis.position), run.axes.map(|axis| axis.velocity)];
        let now = energy(&robot, q, v);
        assert!(lost >= -1e-9, "{lost:e}");
        assert!((before - now - lost).abs() < 1e-4, "{before} {now} {lost}");
        before = now;
    }
    assert!(run.axes.iter().any(|axis| axis.velocity == 0.0));
}
