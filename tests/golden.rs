//! Laws against values computed with mpmath at 50 digits, from the equations of the papers and not
//! from this code.

// Values with all digits printed by mpmath; a 3.14 among them is not an approximation of pi.
#![allow(clippy::excessive_precision, clippy::approx_constant)]

use crate::common::close;
use stribeck::{Interval, Real, Sample, Spec, State};

fn at(law: &str, effects: &[&str], values: &[f64], sample: &Sample<f64>) -> f64 {
    let spec = Spec::new(law, effects.iter().copied()).unwrap();
    spec.with(values).unwrap().static_torque(sample)
}

#[test]
fn laws_with_published_parameters() {
    // UR5e review, table 7, at 0.3 rad/s; bittencourt_a's vs is negative in print.
    close(at("coulomb", &[], &[12.35, 10.30], &Sample::at(0.3)), 14.005, 1e-15);
    let printed = [-1388.0, 1395.0, -12.62, 1.12, 96.30];
    close(at("bittencourt_a", &[], &printed, &Sample::at(0.3)), 14.877775406978362, 1e-13);
    let gantry = [20.0, 35.0, 0.1, 100.0, 120.0];
    close(at("gantry_map", &[], &gantry, &Sample::at(-0.05)), -37.682011746071073, 1e-15);
}

/// Table 7 of the UR5e review, at -0.3 rad/s, 34 degC and a load of -20 N m that drives the joint.
#[rustfmt::skip]
const REVIEW: &[(&str, &[f64], f64)] = &[
    ("clochiatti", &[12.03, 10.84, 10.79], -14.399000000000000),
    ("dong", &[10.45, 13.61, 16.34, 3.24, 16.34], -16.667933221348183),
    ("gaz_a", &[10.54, -13.55, 26.89, 25.37, 0.02], -16.689910818867375),
    ("gaz_b", &[71.87, 1.79, 0.01], -9.4445928489910893),
    ("grotjahn_a", &[5.58, 3.14, 15.92], -15.471372565308139),
    ("grotjahn_b", &[10.13, 3.01, 7.24, 22.65], -16.363669808496888),
    ("hao_a", &[8.06, 22.66, -7.26, 1.24], -14.23808),
    ("indri_a", &[6.03, 4.06, 899.76, 13.04, -0.98, 15.59], -15.419408659308404),
    ("makkar", &[7.07, 0.84, -17.93, 4.04, 88486.0, 8.37], -15.365559412367266),
    ("shao", &[10.25, 14.12, 33.75], -16.310060466866063),
    ("wolf", &[306.24, -4.3, 44.35, 0.89, 18.29, 0.1], -15.533408480652411),
    ("zhou", &[19.33, 0.58, -379.32, 264.32, 366.69, 5.5], -15.115285451188581),
    ("bittencourt_b", &[-5.26, -0.04, 0.43, -3.72, 1887.0, 15.83, -0.07, -38.75, 77.72, 10.93, 169.3, 6.95], -19.650216872697092),
    ("hao_b", &[8.16, 40.32, -25.34, 6.92, -0.02], -13.62168),
    ("iskandar", &[0.05, 0.63, 1.77, -0.04, 8.11, -0.7, 0.01, 21.16, 0.19, -0.01, 0.18, 0.01, -0.0001], -9.9958720474690941),
    ("li", &[-0.18, -0.82, 6.99, 0.06, 16.77, -0.06, 0.001, -0.008], -10.730813987360355),
    ("madsen", &[6.36, 0.44, 2.99, -0.28, 40.68, 50.39, -30.75, 7.57], -15.27500292913228),
    ("nevmerzhitskiy", &[4.26, -0.01, 20.4, -87.4, 309.89], -11.433540173105389),
    ("simoni", &[10.09, 49.89, -31.35, 8.57, 0.81, -0.01], -15.38981965),
];

#[test]
fn static_laws_of_the_review() {
    let sample =
        Sample { temperature: 34.0, load_torque: -20.0, motor_torque: 15.0, ..Sample::at(-0.3) };
    for &(law, values, expected) in REVIEW {
        let mut spec = Spec::new(law, []).unwrap();
        spec.set_constant("base_temperature", 21.5).unwrap();
        spec.set_constant("smoothing_velocity", 0.01).unwrap();
        let model = spec.with(values).unwrap();
        close(model.static_torque(&sample), expected, 2e-14);
        close(model.static_torque(&Sample { velocity: 0.0, ..sample }), at_rest(law), 2e-14);
    }
}

/// Friction at `v = 0`: zero except for the two laws with a constant.
fn at_rest(law: &str) -> f64 {
    match law {
        "gaz_a" => 3.2346513139685619,
        "li" => -0.18,
        _ => 0.0,
    }
}

/// Indri et al., table 1, joint 1: forward, then backward.
const DIRECT_DRIVE: &[f64] = &[
    40.854, -32.454, -31.233, -0.76, -0.262, 0.19, 0.17, -46.473, 53.873, 55.738, -0.293, 0.177,
    0.14, 0.15,
];

/// Coulomb, static, viscous, Stribeck velocity for each pair of signs.
const FOUR: &[f64] =
    &[4.0, 6.0, 1.0, 0.2, 3.5, 5.0, 1.1, 0.3, 4.2, 6.5, 0.9, 0.25, 3.2, 5.5, 1.2, 0.15];

/// Values of the parameters (M0 and M* as published), velocity, acceleration, torque.
#[rustfmt::skip]
const OTHERS: &[(&str, &[f64], f64, f64, f64)] = &[
    ("m0", &[0.049, 0.0844, 0.0005, 6.5, 1.3], 8.0, 1.0, 0.075775675606618726),
    ("m1", &[0.0304, 0.0232, 0.035, 0.128, 9.07, 0.0004], -8.0, 1.0, -0.071950148527865416),
    ("m_star", &[0.0304, 0.0232, 0.128, 9.07, -0.0244, 0.00169, -25.0, 1.0, 0.000129, 0.00131, 21.0], 8.0, 1.0, 0.084150062969560809),
    ("indri_static", DIRECT_DRIVE, 0.4, 1.0, 8.2916581113626806),
    ("indri_static", DIRECT_DRIVE, -0.1, 1.0, -6.9901644446731213),
    ("karahan_karci", FOUR, 0.2, 1.0, 4.9357588823428846),
    ("karahan_karci", FOUR, 0.2, -1.0, 4.6817705826449319),
    ("karahan_karci", FOUR, -0.2, -1.0, -5.5927725752990117),
    ("karahan_karci", FOUR, -0.2, 1.0, -3.828730625433952),
];

#[test]
fn static_laws_of_the_other_papers() {
    for &(law, values, velocity, acceleration, expected) in OTHERS {
        let sample =
            Sample { acceleration, temperature: 40.0, load_torque: -0.3, ..Sample::at(velocity) };
        close(at(law, &[], values, &sample), expected, 2e-14);
    }
    // Steady motion counts as accelerating, in both directions.
    let steady = |velocity| at("karahan_karci", &[], FOUR, &Sample::at(velocity));
    close(steady(0.2), 4.9357588823428846, 1e-15);
    close(steady(-0.2), -5.5927725752990117, 1e-15);
}

/// The servo laws where the external torque drives the motor, and the reverse.
#[test]
fn servo_laws_with_opposing_torques() {
    #[rustfmt::skip]
    let expected: [(&str, &[f64], [f64; 2]); 6] = [
        ("bam_m1", &[1.3, 0.4], [-1.36, 1.4]),
        ("bam_m2", &[1.3, 0.7, 0.2, 1.6, 0.4], [-1.7324044763966807, 1.5676707186051123]),
        ("bam_m3", &[1.3, 0.15, 0.4], [-2.08, 1.955]),
        ("bam_m4", &[1.3, 0.7, 0.15, 0.08, 0.2, 1.6, 0.4], [-2.6566949320200026, 2.1935714796152741]),
        ("bam_m5", &[1.3, 0.7, 0.12, 0.21, 0.05, 0.09, 0.2, 1.6, 0.4], [-2.6363904715906297, 2.3049366540371938]),
        ("bam_m6", &[1.3, 0.7, 0.12, 0.21, 0.05, 0.09, 0.011, 0.017, 0.2, 1.6, 0.4], [-2.6656933838191, 2.3087308028696295]),
    ];
    let samples = [(-0.15, 3.0, -1.8), (0.25, -1.2, 2.5)];
    for (law, values, torques) in expected {
        for ((velocity, external_torque, motor_torque), torque) in samples.into_iter().zip(torques)
        {
            let sample = Sample { external_torque, motor_torque, ..Sample::at(velocity) };
            close(at(law, &[], values, &sample), torque, 2e-14);
        }
    }
}

/// `s2 = s20 + s2T T` and `s3 = s30 + s3T T`: at one temperature a slope is a shift.
#[test]
fn slopes_with_temperature_shift_their_parameters() {
    let spec = Spec::new("tadese_full", []).unwrap();
    let names: Vec<&str> = spec.parameters().map(|p| p.name).collect();
    let mut values = vec![50.0, 2.0, 0.1, 5.0, 4.0];
    values.extend([3.0, -0.02, 0.5, 0.01, 2.5, -0.01, 0.7, 0.02]);
    values.extend([0.3, 2.0, 0.1, 0.05, 0.01, -0.2, 3.0, -0.1, -0.02, 0.01]);
    values.extend([-0.3, 1.0, -0.1, 0.06, 0.01, 0.2, 4.0, 0.1, -0.03, 0.01]);
    let temperature = 31.0;
    let mut shifted = values.clone();
    for (i, name) in names.iter().enumerate().filter(|(_, name)| name.contains("_slope")) {
        let base = names.iter().position(|other| *other == name.replace("_slope", "")).unwrap();
        shifted[base] += values[i] * temperature;
        shifted[i] = 0.0;
    }
    for velocity in [-0.4, -0.02, 0.02, 0.4] {
        let sample = Sample { temperature, load_torque: 2.0, ..Sample::at(velocity) };
        let expected = at("tadese_full", &[], &shifted, &sample);
        close(at("tadese_full", &[], &values, &sample), expected, 1e-14);
        let warmer = Sample { temperature: 50.0, ..sample };
        assert!((at("tadese_full", &[], &values, &warmer) - expected).abs() > 1e-3);
    }
}

#[test]
fn static_amplitude_of_lugre_is_the_total() {
    let lugre = [1e5, 0.0, 0.0, 1.0, 1.5, 0.1, 2.0];
    close(at("lugre", &[], &lugre, &Sample::at(1e-9)), 1.5, 1e-15);
    let bittencourt = [1.0, 1.5, 0.1, 2.0, 0.0];
    close(at("bittencourt_a", &[], &bittencourt, &Sample::at(1e-9)), 2.5, 1e-8);
}

#[test]
fn all_static_effects_combined() {
    let sample = Sample {
        velocity: -0.25,
        position: 0.9,
        acceleration: 1.3,
        temperature: 40.0,
        load_torque: -7.5,
        load_torque_curvature: 0.0,
        temperature_rate: 0.0,
        motor_torque: 0.0,
        external_torque: 0.0,
        time: 0.0,
    };
    let effects = [
        "gravity",
        "inertia",
        "temperature_viscous",
        "nonlinear_viscous",
        "direction",
        "load",
        "temperature_dry",
        "stribeck",
    ];
    let values = [
        2.0, 5.0, // viscous, Coulomb
        3.0, 0.1, 1.5, // Stribeck
        0.05, 1.3, 0.02, 1.4, // load
        0.4, 0.3, // direction
        0.01, 0.02, 0.03, 0.05, 0.3, // temperature of the dry part
        1.5, 0.7, 2.0, // nonlinear viscous
        0.02, 0.03, // temperature of the viscous part
        0.8, 1.1, -0.6, // inertia, gravity
    ];
    close(at("coulomb", &effects, &values, &sample), -4.970168779576607, 1e-14);
}

/// Viscous and Coulomb friction with `effects` at one sample under load, without cancellation.
fn at_one_sample(effects: &[&str], values: &[f64]) -> f64 {
    let mut spec = Spec::new("coulomb", effects.iter().copied()).unwrap();
    for (name, value) in [
        ("position_start", -0.4),
        ("position_length", 2.5),
        ("ripple_period", 0.21),
        ("duration", 80.0),
        ("reference_torque", 9.0),
    ] {
        spec.set_constant(name, value).unwrap();
    }
    let sample = Sample {
        position: 0.9,
        load_torque: -7.5,
        load_torque_curvature: 11.0,
        temperature_rate: 0.1,
        time: 31.0,
        ..Sample::at(-0.25)
    };
    let values: Vec<f64> = [2.0, 5.0].iter().chain(values).copied().collect();
    spec.with(&values).unwrap().static_torque(&sample)
}

#[test]
fn effects_of_time_and_position() {
    close(at_one_sample(&["drift"], &[-0.3, 2.5]), -4.4861106787337049, 1e-15);
    close(at_one_sample(&["drift"], &[-0.3, 0.0]), -4.91875, 1e-15);
    close(at_one_sample(&["spring"], &[0.8, 0.3, -0.5]), -5.58736, 1e-15);
    let ripple = [0.6, -0.4, 0.2, 0.1, 0.37];
    close(at_one_sample(&["ripple"], &ripple), -5.7834234052076721, 1e-14);
}

#[test]
fn elasticity_follows_the_second_derivative_of_the_load() {
    close(at_one_sample(&["elasticity"], &[0.004]), -5.456, 1e-15);
    close(at_one_sample(&["elasticity"], &[-0.03]), -5.83, 1e-15);
}

#[test]
fn friction_follows_the_contacts_where_the_thermometer_lags() {
    let effects = ["temperature_dry", "temperature_viscous", "thermometer_lag"];
    let values = [2.0, 5.0, 0.01, 0.02, 0.03, 0.04, 12.0];
    let shown = Sample { temperature: 40.0, temperature_rate: 0.25, ..Sample::at(-0.25) };
    let contacts = Sample { temperature: 43.0, ..Sample::at(-0.25) };
    let lagging = Spec::new("coulomb", effects).unwrap().with(&values).unwrap();
    let exact = Spec::new("coulomb", effects[..2].iter().copied()).unwrap();
    let exact = exact.with(&values[..6]).unwrap();
    assert_eq!(lagging.static_torque(&shown), exact.static_torque(&contacts));
    let (mut one, mut other) = (State::default(), State::default());
    assert_eq!(
        lagging.step(&mut one, &shown, 0.01).torque,
        exact.step(&mut other, &contacts, 0.01).torque
    );
    assert_eq!(
        lagging.step_over(&mut one, &Interval::constant(shown, 0.01)).torque,
        exact.step_over(&mut other, &Interval::constant(contacts, 0.01)).torque
    );
    assert_ne!(lagging.static_torque(&shown), exact.static_torque(&shown));
}

#[test]
fn effects_of_the_whole_torque() {
    close(at_one_sample(&["gain"], &[0.08]), -6.54, 1e-15);
    close(at_one_sample(&["saturation"], &[0.15, 2.3]), -10.043039888108621, 1e-15);
    close(at_one_sample(&["warm_up"], &[-0.03, 0.4, 3.0]), -5.2541376803641215, 1e-15);
    let effects = ["gain", "saturation", "ripple", "spring", "drift"];
    let values = [
        -0.3, 2.5, // drift
        0.8, 0.3, -0.5, // spring
        0.6, -0.4, 0.2, 0.1, 0.37, // ripple
        0.15, 2.3,  // saturation
        0.08, // gain
    ];
    close(at_one_sample(&effects, &values), -9.9955403653316986, 1e-14);
}

#[test]
fn channel_effects_apply_to_a_bristle_as_to_a_static_law() {
    let values = [2.0, 5.0, 900.0, 1.5, 0.15, 2.3, 0.08];
    let mut spec = Spec::new("coulomb", ["presliding", "saturation", "gain"]).unwrap();
    spec.set_constant("reference_torque", 9.0).unwrap();
    let sample = Sample { load_torque: -7.5, ..Sample::at(-0.25) };
    let mut state = State::default();
    let step = spec.with(&values).unwrap().step(&mut state, &sample, 10.0);
    let acting = -5.5;
    let measured = at_one_sample(&["saturation", "gain"], &[0.15, 2.3, 0.08]);
    close(step.torque, measured, 1e-14);
    // The bristle deflects by 5/900 first, with its damping: the work is that of the real friction.
    assert!((step.mean_torque - acting).abs() < 0.02, "{}", step.mean_torque);
}

#[test]
fn position_over_a_stroke_and_over_a_period() {
    let values: Vec<f64> =
        [0.0, 0.0].into_iter().chain((1..=8).map(|j| f64::from(j) / 10.0)).collect();
    let sample = Sample { position: 0.37, ..Sample::at(1.0) };
    for (periodic, expected) in [(0.0, 0.16176663163036918), (1.0, 0.40697646000051008)] {
        let mut spec = Spec::new("coulomb", ["position"]).unwrap();
        spec.set_constant("position_start", 0.1).unwrap();
        spec.set_constant("position_length", 0.8).unwrap();
        spec.set_constant("position_periodic", periodic).unwrap();
        close(spec.with(&values).unwrap().static_torque(&sample), expected, 1e-13);
    }
}

#[test]
fn temperature_factor_at_and_near_zero_curvature() {
    let sample = Sample { temperature: 40.0, ..Sample::at(1.0) };
    let factor = |k| at("coulomb", &["temperature_dry"], &[0.0, 1.0, 0.02, k], &sample);
    close(factor(0.03), 0.75841876774784886, 1e-15);
    close(factor(1e-9), 0.70000000224999999, 1e-15);
    close(factor(0.0), 0.7, 1e-15);
}

#[test]
fn weights_of_an_exponential_integrator() {
    let expected = [
        (-0.5, [0.78693868057473315, 0.42612263885053369, 0.14775472229893261]),
        (-1e-8, [0.99999999500000002, 0.49999999833333334, 0.16666666625]),
        (-3.0, [0.31673764387737869, 0.22775411870754044, 0.090748627097486521]),
        (-40.0, [0.025, 0.024375, 0.011890625]),
        (0.3, [1.1661960252533437, 0.55398675084447893, 0.17995583614826311]),
    ];
    for (x, phi) in expected {
        for (order, phi) in (1..).zip(phi) {
            close(Real::phi(x, order), phi, 2e-15);
        }
    }
    assert_eq!(Real::phi(f64::NEG_INFINITY, 1), 0.0);
}

#[test]
fn lugre_of_the_1995_paper() {
    // s0 = 1e5, s1 = 316.2, s2 = 0.4, Fc = 1, Fs = 1.5, vs = 1e-3, constant 1 mm/s for 5 ms.
    let spec = Spec::new("lugre", []).unwrap();
    let model = spec.with(&[1e5, 316.2, 0.4, 1.0, 1.5, 1e-3, 2.0]).unwrap();
    let mut state = State::with_deflection(2e-6);
    let step = model.step(&mut state, &Sample::at(1e-3), 5e-3);
    close(step.torque, 0.71160483134668455, 1e-14);
    close(step.mean_torque, 0.59611178951080239, 1e-14);
}
