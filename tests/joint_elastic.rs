//! A motor that drives its load through a spring with backlash.

use stribeck::joint::{
    self, ElasticJoint, ElasticPosture, Joint, JointStep, Posture, Push, Transmission,
};
use stribeck::{Composed, Spec, State};

const DT: f64 = 1e-3;
const AT_REST: Posture<f64> = Posture { position: 0.0, velocity: 0.0 };

fn coulomb(viscous: f64, dry: f64) -> Composed<f64> {
    Spec::new("coulomb", []).unwrap().with(&[viscous, dry]).unwrap()
}

fn joint(stiffness: f64, damping: f64, backlash: f64) -> ElasticJoint<f64> {
    ElasticJoint {
        motor_inertia: 0.2,
        transmission: Transmission { stiffness, damping, backlash },
        load: Joint::free(0.8),
    }
}

fn pushed(
    friction: &Composed<f64>,
    joint: &ElasticJoint<f64>,
    start: ElasticPosture<f64>,
    steps: u32,
    torque: impl Fn(f64) -> f64,
) -> Vec<(ElasticPosture<f64>, JointStep<f64>)> {
    let (mut posture, mut state) = (start, State::default());
    (0..steps)
        .map(|k| {
            let time = f64::from(k) * DT;
            let push = Push { time, ..Push::by_motor(torque(time)) };
            let mut body = joint.moving(posture, &push);
            let result = joint::step(friction, &mut state, &mut body, DT);
            posture = body.posture();
            (posture, result)
        })
        .collect()
}

/// Two inertias on a spring oscillate at `sqrt(k (1/J1 + 1/J2))`.
#[test]
fn it_oscillates_at_its_natural_frequency() {
    let joint = joint(4e3, 0.0, 0.0);
    let start = ElasticPosture { twist: 0.01, ..ElasticPosture::aligned(AT_REST) };
    let steps = pushed(&coulomb(0.0, 0.0), &joint, start, 20_000, |_| 0.0);
    let crossings = steps.windows(2).filter(|p| p[0].0.twist <= 0.0 && p[1].0.twist > 0.0).count();
    #[allow(clippy::disallowed_methods)]
    let frequency = (4e3_f64 * (1.0 / 0.2 + 1.0 / 0.8)).sqrt() / core::f64::consts::TAU;
    assert!((crossings as f64 - 20.0 * frequency).abs() < 2.0, "{crossings}, {frequency} Hz");
    let largest = steps[19_000..].iter().map(|(p, _)| p.twist.abs()).fold(0.0, f64::max);
    assert!((largest - 0.01).abs() < 1e-5, "the amplitude is {largest}");
}

/// With gaps, contacts, gravity and stops: the work of the motor is stored or dissipated.
#[test]
fn energy_balances_through_gaps_and_stops() {
    let mut joint = joint(2e4, 0.0, 0.02);
    joint.load = Joint::revolute(0.8, 2.0, -1.0);
    let friction = coulomb(0.3, 1.5);
    let start = ElasticPosture::aligned(Posture { position: 0.3, velocity: 0.5 });
    #[allow(clippy::disallowed_methods)]
    let steps = pushed(&friction, &joint, start, 20_000, |t| 6.0 * (2.1 * t).sin());
    let mut before = start;
    for (after, result) in steps {
        let (was, is) = (joint.energy(&before, 0.0), joint.energy(&after, 0.0));
        let imbalance = result.motor_work - result.friction_work - (is - was);
        let size = was.abs().max(is.abs()).max(result.motor_work.abs());
        assert!(imbalance.abs() < 1e-12 * size, "{imbalance:e} of {size:e}");
        let twist = after.motor.position - after.load.position;
        assert!((after.twist - twist).abs() < 1e-12);
        before = after;
    }
}

/// A damper only dissipates energy.
#[test]
fn damping_stops_the_oscillation() {
    let joint = joint(4e3, 3.0, 0.01);
    let start = ElasticPosture { twist: 0.03, ..ElasticPosture::aligned(AT_REST) };
    let steps = pushed(&coulomb(0.0, 0.0), &joint, start, 20_000, |_| 0.0);
    let energies: Vec<f64> = steps.iter().map(|(p, _)| joint.energy(p, 0.0)).collect();
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-12)));
    assert!(energies[19_999] < 0.2 * energies[0]);
}

/// The motor crosses the gap before it moves a load without friction.
#[test]
fn the_motor_crosses_the_gap_first() {
    let joint = joint(1e5, 5.0, 0.05);
    let steps = pushed(&coulomb(0.1, 0.5), &joint, ElasticPosture::aligned(AT_REST), 400, |_| 1.0);
    let touch = steps.iter().position(|(p, _)| p.load.velocity != 0.0).unwrap();
    // Half the backlash at (1 - 0.5)/0.2 rad/s2.
    #[allow(clippy::disallowed_methods)]
    let expected = (2.0 * 0.025 / (0.5 / 0.2_f64)).sqrt();
    assert!((touch as f64 * DT - expected).abs() < 3.0 * DT, "after {touch} steps, {expected} s");
    assert!((steps[touch - 1].0.twist - 0.025).abs() < 5e-4);
}

/// Friction at the motor holds a load that hangs on the spring.
#[test]
fn friction_of_the_motor_holds_the_load() {
    let mut joint = joint(1e4, 20.0, 0.0);
    joint.load.gravity.constant = 3.0;
    let steps =
        pushed(&coulomb(0.1, 4.0), &joint, ElasticPosture::aligned(AT_REST), 60_000, |_| 0.0);
    // The load drops into the spring and oscillates, then comes to rest.
    let (settled, end) = (steps[9_999].0, steps[59_999].0);
    assert_eq!(end.motor, Posture { velocity: 0.0, ..settled.motor });
    assert!((end.twist - 3.0 / 1e4).abs() < 1e-12, "twist {}", end.twist);
    assert!(end.load.velocity.abs() < 1e-12);
}

/// An extremely stiff spring gives a rigid joint.
#[test]
fn a_stiff_transmission_is_rigid() {
    let friction = coulomb(0.4, 1.0);
    let torque = |t: f64| if t < 1.0 { 3.0 } else { -2.0 };
    let elastic = joint(1e8, 1e5, 0.0);
    let steps = pushed(&friction, &elastic, ElasticPosture::aligned(AT_REST), 2_000, torque);
    let rigid = Joint::free(1.0);
    let (mut posture, mut state) = (AT_REST, State::default());
    for (k, (apart, _)) in steps.iter().enumerate() {
        let push = Push::by_motor(torque(k as f64 * DT));
        let mut body = rigid.moving(posture, &push);
        joint::step(&friction, &mut state, &mut body, DT);
        posture = body.posture;
        let apart = (apart.load.position - posture.position).abs();
        assert!(apart < 1e-6, "{apart} at step {k}");
    }
}
