//! One joint under position control at 4 kHz, as on a microcontroller: read the sensor, compute
//! friction feedforward, apply the torque. The sensor drops out now and then; the joint is
//! simulated.
//!
//! cargo run --example control_loop

use stribeck::prelude::*;

const PERIOD: f32 = 2.5e-4;

/// Identified on a test bench (`stribeck fit --model lugre`).
const FRICTION: law::Lugre<f32> = law::Lugre {
    bristle_stiffness: 2000.0,
    bristle_damping: 4.0,
    viscous_friction: 1.5,
    coulomb_friction: 2.0,
    static_friction: 2.7,
    stribeck_velocity: 0.08,
    stribeck_exponent: 2.0,
};

const LIMITS: Limits<f32> = Limits { torque: 8.0, speed: 6.0, held: 8 };

/// Simulates encoder, motor and mechanics.
struct Joint {
    position: f32,
    velocity: f32,
    friction: FixedLaw<law::Lugre<f32>, f32>,
    state: State<f32>,
}

impl Joint {
    const INERTIA: f32 = 0.2;

    /// The reading of the encoder, unless it drops out.
    fn read(&self, k: u32) -> Option<Sample<f32>> {
        let broken = k % 5000 > 4980;
        (!broken).then(|| Sample { position: self.position, ..Sample::at(self.velocity) })
    }

    fn drive(&mut self, torque: f32) {
        let friction = self.friction.torque(&mut self.state, &Sample::at(self.velocity), PERIOD);
        self.velocity += PERIOD * (torque - friction) / Self::INERTIA;
        self.position += PERIOD * self.velocity;
    }
}

/// A slow oscillation: position and velocity.
fn desired(k: u32) -> (f32, f32) {
    let time = k as f32 * PERIOD;
    let (sin, cos) = math::f32::sin_cos(time);
    (0.3 * (1.0 - cos), 0.3 * sin)
}

/// The root mean square error of position (rad), and the number of torques without a reading.
fn track(compensate: bool) -> Result<(f32, u32), ModelError<'static>> {
    let mut friction = Feedforward::new(FixedLaw::new(FRICTION), PERIOD, LIMITS)?;
    let mut joint = Joint {
        position: 0.0,
        velocity: 0.0,
        friction: FixedLaw::new(FRICTION),
        state: State::default(),
    };
    let (mut last, mut squares, mut bridged) = (Sample::at(0.0), 0.0, 0);
    const STEPS: u32 = 40_000;
    for k in 0..STEPS {
        // Read the sensor.
        let (position, velocity) = desired(k);
        let reading = joint.read(k);
        last = reading.unwrap_or(last);
        // Friction at the desired velocity: sensor noise is not fed back.
        let wanted = reading.map(|read| Sample { velocity, ..read });
        let feed = friction.next(wanted.as_ref());
        bridged += u32::from(matches!(feed.source, Source::Last | Source::None));
        // Apply the torque.
        let feedback = 60.0 * (position - last.position) + 4.0 * (velocity - last.velocity);
        joint.drive(feedback + if compensate { feed.torque } else { 0.0 });
        squares += (position - joint.position) * (position - joint.position);
    }
    Ok((math::f32::sqrt(squares / STEPS as f32), bridged))
}

fn main() -> Result<(), ModelError<'static>> {
    let (without, _) = track(false)?;
    let (with, bridged) = track(true)?;
    println!("tracking error without feedforward  {:.2} mrad", 1e3 * without);
    println!("                with feedforward     {:.2} mrad", 1e3 * with);
    println!("samples without a reading            {bridged}");
    assert!(with < 0.5 * without, "the feedforward helps");
    Ok(())
}
