//! Combinations of laws and effects, and errors.

use crate::common::{self, every_model};
use stribeck::catalog::ParameterInfo;
use stribeck::catalog::{EffectId, LawId};
use stribeck::{Dual, ModelError, Sample, Spec, State};

fn names(spec: &Spec) -> Vec<&'static str> {
    spec.parameters().map(|p| p.name).collect()
}

#[test]
fn order_of_effects_does_not_matter() {
    let a = Spec::new("coulomb", ["load", "presliding", "stribeck"]).unwrap();
    let b = Spec::new("coulomb", ["stribeck", "load", "presliding"]).unwrap();
    assert_eq!(a, b);
    assert_eq!(a.to_string(), "coulomb+stribeck+load+presliding");
}

#[test]
fn parameters_depend_on_the_other_effects() {
    let with =
        |law, effects: &[&'static str]| names(&Spec::new(law, effects.iter().copied()).unwrap());
    let has = |law, effects, name| with(law, effects).contains(&name);
    assert!(!has("coulomb", &["load"], "load_stribeck"));
    assert!(has("coulomb", &["load", "stribeck"], "load_stribeck"));
    assert!(has("lugre", &["load"], "load_stribeck"));
    assert!(has("coulomb", &["direction"], "direction_coulomb"));
    assert!(!has("coulomb", &["direction", "offset"], "direction_coulomb"));
    assert_eq!(
        with("coulomb", &["offset", "direction"]),
        ["viscous_friction", "coulomb_friction", "direction_viscous", "offset"]
    );
}

#[test]
fn errors_state_what_and_why() {
    let refused = |law, effects: &[&'static str]| {
        Spec::new(law, effects.iter().copied()).unwrap_err().to_string()
    };
    let laws: Vec<&str> = LawId::ALL.iter().map(|law| law.info().id).collect();
    assert_eq!(
        refused("lugr", &[]),
        format!("law 'lugr' is unknown; laws are {}", laws.join(", "))
    );
    assert!(refused("lugre", &["stribek"]).starts_with("effect 'stribek' is unknown; effects are"));
    assert_eq!(
        refused("lugre", &["presliding"]),
        "law 'lugre' already has the effect 'presliding'"
    );
    assert_eq!(
        refused("gantry_map", &["direction"]),
        "law 'gantry_map' already has the effect 'direction'"
    );
    assert_eq!(refused("coulomb", &["load", "load"]), "effect 'load' is named twice");
    let spec = Spec::new("lugre", []).unwrap();
    let with = |values: &[f64]| spec.with(values).unwrap_err().to_string();
    assert_eq!(with(&[1.0]), "the model has 7 parameters but 1 values were given");
    let good = [1e4, 1.0, 0.4, 1.0, 1.5, 0.01, 2.0];
    for (i, bad, name) in [
        (0, 0.0, "bristle_stiffness"),
        (3, f64::NAN, "coulomb_friction"),
        (5, 0.0, "stribeck_velocity"),
        (6, f64::INFINITY, "stribeck_exponent"),
    ] {
        let mut values = good;
        values[i] = bad;
        assert!(with(&values).contains(name));
    }
    let mut spec = Spec::new("coulomb", ["load"]).unwrap();
    assert!(spec.set_constant("reference_load", 0.0).is_err());
    assert!(spec.set_constant("reference_lod", 1.0).is_err());
}

#[test]
fn laws_without_direction_are_odd() {
    for spec in common::every_model() {
        let even = [
            "direction",
            "quadrant",
            "offset",
            "inertia",
            "gravity",
            "spring",
            "ripple",
            "backlash",
            "elasticity",
            "saturation",
            "gain",
            "delay",
            "warm_up",
        ];
        if even.iter().any(|id| spec.has(id)) {
            continue;
        }
        let model = spec.with(&common::values(&spec)).unwrap();
        let (mut forward, mut backward) = (State::default(), State::default());
        for v in [0.3, 0.01, 0.0, -0.2, 0.9] {
            let sample = |v| Sample { temperature: 33.0, load_torque: -3.0, ..Sample::at(v) };
            let there = model.step(&mut forward, &sample(v), 0.01).torque;
            let back = model.step(&mut backward, &sample(-v), 0.01).torque;
            assert_eq!(there, -back, "{spec}");
        }
    }
}

/// `is_linear` means that the torque is an affine function of the parameter.
#[test]
fn linear_parameters_have_no_second_derivative() {
    type Second = Dual<Dual<f64, 1>, 1>;
    for spec in common::every_model() {
        let values = common::values(&spec);
        for (j, info) in spec.parameters().enumerate() {
            let twice: Vec<Second> = values
                .iter()
                .enumerate()
                .map(|(i, &x)| {
                    let index = usize::from(i != j);
                    Dual::variable(Dual::variable(x, index), index)
                })
                .collect();
            let model = spec.with(&twice).unwrap();
            let constant = Dual::<f64, 1>::constant;
            let mut state = State::default();
            let mut curved = false;
            for v in [0.02, 0.1, -0.03] {
                let mut sample = Sample::at(constant(v));
                sample.temperature = constant(41.0);
                sample.load_torque = constant(5.0);
                let torque = model.step(&mut state, &sample, constant(0.01)).torque;
                curved |= torque.derivative[0].derivative[0].abs() > 1e-10;
            }
            assert!(!(curved && spec.is_linear(info)), "{spec}: {}", info.name);
        }
    }
}

#[test]
fn tables_are_sound() {
    let check = |row: &ParameterInfo| {
        assert!(row.lower < row.upper && row.lower <= row.start && row.start <= row.upper);
        assert!(row.description.ends_with('.') && !row.description.starts_with(' '));
    };
    for effect in EffectId::ALL {
        let info = effect.info();
        info.parameters.iter().for_each(check);
        assert_eq!(stribeck::catalog::effect(info.id), Some(*effect));
        assert!(info.parameters.iter().all(|p| p.name.starts_with(info.id)));
    }
    for law in LawId::ALL {
        law.info().parameters.iter().for_each(check);
    }
    for spec in common::every_model() {
        let mut names = names(&spec);
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), spec.parameter_count(), "{spec}");
    }
}

#[test]
fn a_model_parses_its_display_form() {
    for spec in every_model() {
        let read = Spec::parse(&spec.to_string()).unwrap();
        assert_eq!(read.to_string(), spec.to_string());
    }
    assert_eq!(Spec::parse("gms:8").unwrap().to_string(), "gms:8");
    for unknown in ["", "+load", "gms:", "gms:0", "gms:17", "lugre:2", "colomb"] {
        assert!(matches!(Spec::parse(unknown), Err(ModelError::UnknownLaw(_))), "{unknown}");
    }
    assert_eq!(Spec::parse("coulomb+").unwrap_err(), ModelError::UnknownEffect(""));
}

#[test]
fn single_precision_agrees_with_double() {
    for spec in common::every_model() {
        let values = common::values(&spec);
        let single: Vec<f32> = values.iter().map(|&x| x as f32).collect();
        let (model, model32) = (spec.with(&values).unwrap(), spec.with(&single).unwrap());
        let (mut state, mut state32) = (State::default(), State::default());
        for v in [0.3, -0.02, 0.0, 0.7] {
            let sample = Sample { temperature: 31.0, load_torque: 2.0, ..Sample::at(v) };
            let sample32 = Sample { temperature: 31.0, load_torque: 2.0, ..Sample::at(v as f32) };
            let torque = model.step(&mut state, &sample, 0.01).torque;
            let torque32 = f64::from(model32.step(&mut state32, &sample32, 0.01).torque);
            assert!((torque - torque32).abs() < 3e-5 * (1.0 + torque.abs()), "{spec}: {torque}");
        }
    }
}
