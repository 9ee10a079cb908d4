//! Laws whose friction depends on the motor torque, with the motor torque from the balance
//! `tm = tl + tf(te, tm, v)`.
#![cfg(feature = "std")]

use crate::common::{Motion, close, motion};
use stribeck::Spec;
use stribeck::batch::{self, BatchError, Channels, Columns};

const LAWS: [&str; 6] = ["bam_m1", "bam_m2", "bam_m3", "bam_m4", "bam_m5", "bam_m6"];

/// Plausible values by symbol.
fn values(spec: &Spec) -> Vec<f64> {
    spec.parameters()
        .map(|p| match p.symbol {
            "Kc" => 0.4,
            "Ks" => 0.3,
            "Kl" => 0.13,
            "Kls" => 0.07,
            "Ke" => 0.11,
            "Km" => 0.17,
            "Kes" => 0.06,
            "Kms" => 0.09,
            "Kqe" => 0.012,
            "Kqm" => 0.015,
            "vs" => 0.2,
            "alpha" => 1.2,
            "Kv" => 0.6,
            "J" => 0.9,
            "gc" => 1.3,
            "gs" => -3.1,
            "a2" => 0.5,
            "a3" => 0.2,
            _ => p.start + 0.02,
        })
        .collect()
}

/// The input of a fit: the motion without the motor torque.
fn unbalanced(motion: &Motion) -> Columns<'_> {
    let mut columns = motion.columns();
    columns.channels.motor_torque = None;
    columns
}

fn added(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

#[test]
fn the_solution_balances_the_formula() {
    let motion = motion(400);
    for law in LAWS {
        let spec = Spec::new(law, []).unwrap();
        let torque = batch::torque(&spec, &values(&spec), &unbalanced(&motion)).unwrap();
        let motor = added(&motion.load_torque, &torque);
        let mut columns = motion.columns();
        columns.channels.motor_torque = Some(&motor);
        let explicit = batch::torque(&spec, &values(&spec), &columns).unwrap();
        for (i, (solved, explicit)) in torque.iter().zip(&explicit).enumerate() {
            assert!((solved - explicit).abs() < 1e-13, "{law} row {i}: {solved}, {explicit}");
        }
    }
}

/// Raising a load, `tm = tl (1 + Kl)/(1 - Kl)`; lowering it, `tl (1 - Kl)/(1 + Kl)`.
#[test]
fn load_dependent_friction_is_an_efficiency() {
    let spec = Spec::new("bam_m3", []).unwrap();
    let columns = Columns {
        channels: Channels {
            velocity: &[0.5, -0.5],
            load_torque: Some(&[3.0, 3.0]),
            external_torque: Some(&[-3.0, -3.0]),
            ..Channels::default()
        },
        ..Columns::default()
    };
    let torque = batch::torque(&spec, &[0.0, 0.2, 0.0], &columns).unwrap();
    close(3.0 + torque[0], 3.0 * 1.2 / 0.8, 1e-14);
    close(3.0 + torque[1], 3.0 * 0.8 / 1.2, 1e-14);
}

#[test]
fn gradient_is_that_of_the_implicit_function() {
    let motion = motion(300);
    for law in ["bam_m1", "bam_m2", "bam_m3", "bam_m4", "bam_m5", "bam_m6", "clochiatti"] {
        for effects in [&[][..], &["temperature_dry", "offset"], &["inertia", "gravity"]] {
            let spec = Spec::new(law, effects.iter().copied()).unwrap();
            let mut columns = unbalanced(&motion);
            if effects.contains(&"gravity") {
                columns.channels.load_torque = None;
                columns.channels.external_torque = None;
            }
            assert_slopes(&spec, &columns);
        }
    }
}

fn assert_slopes(spec: &Spec, columns: &Columns<'_>) {
    let values = values(spec);
    let (torque, jacobian) = batch::gradient(spec, &values, columns, None).unwrap();
    assert_eq!(torque, batch::torque(spec, &values, columns).unwrap(), "{spec}");
    for (j, info) in spec.parameters().enumerate() {
        let step = 1e-7 * values[j].abs().max(1e-2);
        let at = |sign: f64| {
            let mut moved = values.clone();
            moved[j] += sign * step;
            batch::torque(spec, &moved, columns).unwrap()
        };
        let (above, below) = (at(1.0), at(-1.0));
        for (i, slope) in jacobian.iter().skip(j).step_by(values.len()).enumerate() {
            let difference = (above[i] - below[i]) / (2.0 * step);
            assert!(
                (slope - difference).abs() < 2e-6 * (1.0 + difference.abs()),
                "{spec}: {} at row {i}: {slope} but differences give {difference}",
                info.name
            );
        }
    }
}

/// Where friction drops as the motor torque reaches the external torque, no torque may balance
/// exactly: the motor torque stays at the drop.
#[test]
fn the_motor_torque_stays_where_friction_jumps() {
    let spec = Spec::new("bam_m6", []).unwrap();
    // Kqm tm^2 below |tm| = |te| = 2 and zero above, at the low-speed end of the Stribeck curve.
    let values = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 1.0, 1.0, 0.0];
    let columns = Columns {
        channels: Channels {
            velocity: &[1e-9],
            load_torque: Some(&[1.8]),
            external_torque: Some(&[-2.0]),
            ..Channels::default()
        },
        ..Columns::default()
    };
    let (torque, jacobian) = batch::gradient(&spec, &values, &columns, None).unwrap();
    close(torque[0], 0.2, 1e-12);
    assert!(jacobian.iter().all(|&slope| slope == 0.0));
}

#[test]
fn a_self_locking_joint_has_no_motor_torque() {
    let spec = Spec::new("bam_m3", []).unwrap();
    let columns = Columns {
        channels: Channels {
            velocity: &[0.5, 0.5],
            load_torque: Some(&[0.0, 3.0]),
            external_torque: Some(&[0.0, -3.0]),
            ..Channels::default()
        },
        ..Columns::default()
    };
    let refused = batch::torque(&spec, &[0.0, 1.2, 0.0], &columns).unwrap_err();
    assert_eq!(refused, BatchError::SelfLocking { row: 1 });
    // A search must be able to pass through: finite, and continuous where the solution ends.
    let search = |share| batch::gradient(&spec, &[0.0, share, 0.0], &columns, None).unwrap();
    let (torque, jacobian) = search(1.2);
    assert!(torque.iter().chain(&jacobian).all(|x| x.is_finite()));
    close(search(0.99 - 1e-9).0[1], search(0.99 + 1e-9).0[1], 1e-6);
}

#[test]
fn a_search_never_gets_nan() {
    let speeds = [0.0, -0.0, 1e-308, 1e-12, 0.5, -0.5, 1e3, -1e12];
    let loads = [0.0, -0.0, 1e-300, -3.0, 3.0, 1e9];
    let velocity: Vec<f64> = speeds.iter().flat_map(|&v| loads.map(|_| v)).collect();
    let load: Vec<f64> = speeds.iter().flat_map(|_| loads).collect();
    for external in [0.0, -3.0, 3.0, 1e-12] {
        let external = vec![external; velocity.len()];
        let columns = Columns {
            channels: Channels {
                velocity: &velocity,
                load_torque: Some(&load),
                external_torque: Some(&external),
                ..Channels::default()
            },
            ..Columns::default()
        };
        for law in LAWS.into_iter().chain(["clochiatti"]) {
            let spec = Spec::new(law, []).unwrap();
            let bounds =
                |upper: bool| spec.parameters().map(move |p| if upper { p.upper } else { p.lower });
            for values in [bounds(false).collect::<Vec<_>>(), bounds(true).collect(), values(&spec)]
            {
                let (torque, jacobian) = batch::gradient(&spec, &values, &columns, None).unwrap();
                let nan = torque.iter().chain(&jacobian).position(|x| x.is_nan());
                assert_eq!(nan, None, "{law} at {values:?}");
            }
        }
    }
}

#[test]
fn missing_loads_are_reported() {
    let motion = motion(5);
    let refused = |law, effects: &[&'static str], columns: &Columns<'_>| {
        let spec = Spec::new(law, effects.iter().copied()).unwrap();
        batch::torque(&spec, &values(&spec), columns).unwrap_err().to_string()
    };
    let mut columns = unbalanced(&motion);
    // With memory the balance of a sample depends on the samples before.
    assert_eq!(
        refused("bam_m3", &["presliding"], &columns),
        "the model needs the column 'motor_torque'"
    );
    let short = [1.0];
    columns.channels.load_torque = Some(&short);
    assert!(refused("bam_m3", &[], &columns).contains("'load_torque' has 1 rows"));
    columns.channels.load_torque = None;
    assert_eq!(refused("bam_m3", &[], &columns), "the model needs the column 'motor_torque'");
    columns.channels.load_torque = Some(&motion.load_torque);
    columns.channels.external_torque = None;
    assert_eq!(refused("bam_m3", &[], &columns), "the model needs the column 'external_torque'");
}
