//! Models and motions used by several tests.
#![allow(dead_code)]

pub mod random;

use stribeck::Spec;
use stribeck::catalog::{EffectId, LawId};

/// Laws that are combined with each single effect: static, with a bristle, with many states.
const WITH_EACH_EFFECT: [&str; 3] = ["coulomb", "lugre", "gms"];

/// Every law alone and with all effects it can have; some laws with each single effect.
pub fn every_model() -> Vec<Spec> {
    let mut specs = Vec::new();
    for law in LawId::ALL {
        let law = law.info();
        let free: Vec<&str> = EffectId::ALL
            .iter()
            .map(|effect| effect.info().id)
            .filter(|id| !law.captures.contains(id))
            .collect();
        specs.push(Spec::new(law.id, []).unwrap());
        if WITH_EACH_EFFECT.contains(&law.id) {
            specs.extend(free.iter().map(|&id| Spec::new(law.id, [id]).unwrap()));
        }
        specs.push(Spec::new(law.id, free).unwrap());
    }
    for spec in &mut specs {
        spec.set_constant("reference_temperature", 28.0).unwrap();
        spec.set_constant("reference_load", 4.0).unwrap();
        spec.set_constant("reference_velocity", 0.7).unwrap();
        spec.set_constant("position_length", 2.5).unwrap();
        spec.set_constant("ripple_period", 0.21).unwrap();
        spec.set_constant("duration", 2.2).unwrap();
        spec.set_constant("reference_torque", 80.0).unwrap();
    }
    specs
}

/// Plausible values, chosen so that no derivative is zero by accident.
pub fn values(spec: &Spec) -> Vec<f64> {
    spec.parameters()
        .enumerate()
        .map(|(i, p)| match p.name {
            "bristle_stiffness" | "presliding_stiffness" => 900.0,
            "bristle_damping" | "presliding_damping" => 1.3,
            "coulomb_friction" => 4.0,
            "static_friction" => 6.5,
            "delay" => 0.0037,
            "root_friction_inverse_cube" => 9000.0,
            "power_exponent_slope" => 0.003,
            "power_exponent_square" => 2e-5,
            name if name.starts_with("position_") => 0.05 * (1.0 + i as f64 % 3.0),
            _ => p.start + 0.01 * (1.0 + i as f64 / 10.0),
        })
        .collect()
}

/// A motion with reversals, rest and all channels.
pub struct Motion {
    pub dt: f64,
    pub velocity: Vec<f64>,
    pub position: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub temperature: Vec<f64>,
    pub load_torque: Vec<f64>,
    pub load_torque_curvature: Vec<f64>,
    pub temperature_rate: Vec<f64>,
    pub motor_torque: Vec<f64>,
    pub external_torque: Vec<f64>,
    pub time: Vec<f64>,
}

#[allow(clippy::disallowed_methods)]
pub fn motion(rows: usize) -> Motion {
    let dt = 0.01;
    let time = |i: usize| i as f64 * dt;
    let rests = |i: usize| i % 100 < 7;
    let column = |f: &dyn Fn(usize) -> f64| (0..rows).map(f).collect::<Vec<f64>>();
    Motion {
        dt,
        velocity: column(&|i| if rests(i) { 0.0 } else { 0.8 * (3.1 * time(i)).sin() }),
        position: column(&|i| 0.3 - 0.26 * (3.1 * time(i)).cos()),
        acceleration: column(&|i| 2.5 * (3.1 * time(i)).cos()),
        temperature: column(&|i| 25.0 + 2.0 * time(i)),
        load_torque: column(&|i| 6.0 * (1.7 * time(i)).cos()),
        load_torque_curvature: column(&|i| -6.0 * 1.7 * 1.7 * (1.7 * time(i)).cos()),
        temperature_rate: column(&|i| 0.2 * (0.6 * time(i)).sin()),
        motor_torque: column(&|i| 7.0 * (1.9 * time(i)).cos()),
        external_torque: column(&|i| -5.0 * (1.7 * time(i)).cos()),
        time: column(&time),
    }
}

#[cfg(feature = "std")]
impl Motion {
    pub fn columns(&self) -> stribeck::batch::Columns<'_> {
        use stribeck::batch::{Channels, Columns, TimeStep};
        Columns {
            dt: TimeStep::Uniform(self.dt),
            channels: Channels {
                velocity: &self.velocity,
                position: Some(&self.position),
                acceleration: Some(&self.acceleration),
                temperature: Some(&self.temperature),
                load_torque: Some(&self.load_torque),
                load_torque_curvature: Some(&self.load_torque_curvature),
                temperature_rate: Some(&self.temperature_rate),
                motor_torque: Some(&self.motor_torque),
                external_torque: Some(&self.external_torque),
                time: Some(&self.time),
            },
            ..Columns::default()
        }
    }
}

pub fn close(a: f64, b: f64, relative: f64) {
    let size = a.abs().max(b.abs()).max(1e-300);
    assert!((a - b).abs() <= relative * size, "{a} and {b} differ by {:e}", (a - b).abs() / size);
}
