//! Gradients against central differences, and values that must stay finite.
#![cfg(feature = "std")]

use crate::common::{self, every_model, motion, values};
use stribeck::batch::{self, BatchError, Channels, Columns, TimeStep};
use stribeck::{Dual, Real, Spec};

#[test]
fn gradient_is_the_derivative_of_every_model() {
    let motion = motion(250);
    let mut smooth = motion.columns();
    smooth.smooth.velocity = &motion.acceleration;
    smooth.smooth.load_torque = Some(&motion.temperature);
    for columns in [motion.columns(), smooth] {
        let mut specs = every_model();
        // A lag changes friction that depends on temperature: side by side, and with a state.
        for own in [&["temperature_dry"][..], &["stribeck", "frictional_lag", "temperature_dry"]] {
            let effects = own.iter().chain(&["thermometer_lag"]).copied();
            specs.push(Spec::new("coulomb", effects).unwrap());
        }
        for spec in specs {
            let values = values(&spec);
            let (torque, jacobian) = batch::gradient(&spec, &values, &columns, None).unwrap();
            assert_eq!(torque, batch::torque(&spec, &values, &columns).unwrap(), "{spec}");
            for (j, info) in spec.parameters().enumerate() {
                let step = 1e-6 * values[j].abs().max(1e-3);
                let at = |sign: f64| {
                    let mut moved = values.clone();
                    moved[j] += sign * step;
                    batch::torque(&spec, &moved, &columns).unwrap()
                };
                let (above, below) = (at(1.0), at(-1.0));
                let column: Vec<f64> =
                    jacobian.iter().skip(j).step_by(values.len()).copied().collect();
                let size = column.iter().fold(1e-3_f64, |m, x| m.max(x.abs()));
                for (i, slope) in column.iter().enumerate() {
                    let difference = (above[i] - below[i]) / (2.0 * step);
                    assert!(
                        (slope - difference).abs() < 2e-5 * size,
                        "{spec}: {} at row {i}: {slope} but differences give {difference}",
                        info.name
                    );
                }
            }
        }
    }
}

#[test]
fn zero_delay_changes_nothing_and_has_the_mean_slope() {
    let motion = motion(120);
    let columns = motion.columns();
    let spec = Spec::new("coulomb", ["delay"]).unwrap();
    let plain = Spec::new("coulomb", []).unwrap();
    let (torque, jacobian) = batch::gradient(&spec, &[2.0, 3.0, 0.0], &columns, None).unwrap();
    assert_eq!(torque, batch::torque(&plain, &[2.0, 3.0], &columns).unwrap());
    let whole: Vec<f64> = torque.iter().zip(&motion.load_torque).map(|(f, l)| f + l).collect();
    let v = &motion.velocity;
    let reverses = |i: usize| v[i - 1] * v[i] < 0.0 || v[i] * v[i + 1] < 0.0;
    for i in (1..119).filter(|&i| !reverses(i)) {
        let slope = (whole[i + 1] - whole[i - 1]) / (2.0 * motion.dt);
        common::close(jacobian[3 * i + 2], -slope, 1e-9);
    }
}

#[test]
fn delayed_dry_friction_jumps_where_the_velocity_is_zero() {
    let velocity = [-3.0, -1.0, 3.0, 4.0];
    let channels = Channels { velocity: &velocity, ..Channels::default() };
    let columns = Columns { dt: TimeStep::Uniform(1.0), channels, ..Columns::default() };
    let spec = Spec::new("coulomb", ["delay"]).unwrap();
    // The velocity is zero at 1.25: friction of 2 N m changes its sign from 1.0 to 1.5.
    for (delay, friction, slope) in
        [(0.9, -1.2, -8.0), (0.75, 0.0, -8.0), (0.45, 2.0, 0.0), (1.1, -2.0, 0.0), (-0.4, 2.0, 0.0)]
    {
        let (torque, jacobian) =
            batch::gradient(&spec, &[0.0, 2.0, delay], &columns, None).unwrap();
        common::close(torque[2], friction, 1e-12);
        common::close(jacobian[3 * 2 + 2], slope, 1e-12);
    }
}

#[test]
fn delay_of_integer_samples_shifts_within_a_segment() {
    let motion = motion(60);
    let mut dt = vec![motion.dt; 60];
    (dt[0], dt[30]) = (f64::NAN, 0.0);
    let mut columns = motion.columns();
    columns.dt = TimeStep::Each(&dt);
    columns.shift_load = false;
    let plain = Spec::new("coulomb", []).unwrap();
    let before = batch::torque(&plain, &[2.0, 3.0], &columns).unwrap();
    let spec = Spec::new("coulomb", ["delay"]).unwrap();
    for shift in [-2_i32, 3] {
        let tau = f64::from(shift) * motion.dt;
        let after = batch::torque(&spec, &[2.0, 3.0, tau], &columns).unwrap();
        for i in 0..60_i32 {
            let (first, last) = if i < 30 { (0, 29) } else { (30, 59) };
            let from = (i - shift).clamp(first, last) as usize;
            assert!((after[i as usize] - before[from]).abs() < 1e-9, "row {i}");
        }
    }
}

#[test]
fn a_time_gap_restarts_the_state() {
    let motion = motion(80);
    let mut dt = vec![motion.dt; 80];
    (dt[0], dt[40]) = (0.0, f64::NAN);
    let mut columns = motion.columns();
    columns.dt = TimeStep::Each(&dt);
    let spec = Spec::new("lugre", []).unwrap();
    let whole = batch::torque(&spec, &values(&spec), &columns).unwrap();
    columns.channels.velocity = &motion.velocity[40..];
    columns.dt = TimeStep::Each(&dt[40..]);
    assert_eq!(whole[40..], batch::torque(&spec, &values(&spec), &columns).unwrap());
}

#[test]
fn an_infinite_step_starts_a_segment_in_sliding() {
    let motion = motion(60);
    let mut dt = vec![motion.dt; 60];
    (dt[0], dt[30]) = (f64::INFINITY, f64::INFINITY);
    let mut columns = motion.columns();
    columns.dt = TimeStep::Each(&dt);
    for law in ["lugre", "dahl", "bliman_sorine", "leuven", "gms"] {
        let spec = Spec::new(law, []).unwrap();
        let (torque, jacobian) = batch::gradient(&spec, &values(&spec), &columns, None).unwrap();
        let parts = batch::split(&spec, &values(&spec), &columns).unwrap();
        common::close(
            torque[30],
            parts.dry[30] * motion.velocity[30].signum() + parts.rate[30],
            1e-9,
        );
        // The first sample is at rest: relaxed.
        assert_eq!((motion.velocity[0], torque[0]), (0.0, 0.0), "{law}");
        assert!(jacobian.iter().all(|x| x.is_finite()));
    }
}

#[test]
fn nothing_is_ever_nan() {
    let speeds = [0.0, -0.0, 1e-308, 1e-12, 1e-3, 0.5, 1e3, 1e12];
    let velocity: Vec<f64> = speeds.iter().flat_map(|&v| [v, -v]).collect();
    let many = |x: f64| vec![x; velocity.len()];
    let motion = motion(velocity.len());
    for spec in every_model() {
        for pick in 0..3 {
            // At the lower bounds, the upper ones (or beyond, for exponents), and the start.
            let values: Vec<f64> = spec
                .parameters()
                .map(|p| match (pick, p.name.contains("stribeck_exponent")) {
                    (0, _) => p.lower,
                    (1, true) => 1887.0,
                    (1, false) => p.upper,
                    _ => p.start,
                })
                .collect();
            for load in [0.0, -20.0] {
                let (load, temperature) = (many(load), many(-40.0));
                let mut columns = motion.columns();
                columns.channels.velocity = &velocity;
                columns.channels.load_torque = Some(&load);
                columns.channels.temperature = Some(&temperature);
                let (torque, jacobian) = batch::gradient(&spec, &values, &columns, None).unwrap();
                assert!(torque.iter().all(|x| !x.is_nan()), "{spec} at {values:?}: {torque:?}");
                for (k, x) in jacobian.iter().enumerate() {
                    let (row, column) = (k / values.len(), k % values.len());
                    let name = spec.parameters().nth(column).unwrap().name;
                    assert!(!x.is_nan(), "{spec}: {name} at v = {}", velocity[row]);
                }
            }
        }
    }
}

#[test]
fn split_adds_up_to_the_static_torque() {
    let motion = motion(50);
    let spec = Spec::new("bittencourt_a", ["load", "offset", "direction", "gravity"]).unwrap();
    let (values, columns) = (values(&spec), motion.columns());
    let torque = batch::torque(&spec, &values, &columns).unwrap();
    let parts = batch::split(&spec, &values, &columns).unwrap();
    for (i, v) in motion.velocity.iter().enumerate() {
        let sign = f64::from(i8::from(*v > 0.0) - i8::from(*v < 0.0));
        common::close(torque[i], parts.dry[i] * sign + parts.rate[i] + parts.additive[i], 1e-14);
    }
}

/// Equal bits, so that a fit may omit parameters without changing its path.
#[test]
fn selected_columns_equal_those_of_the_full_gradient() {
    let motion = motion(80);
    let columns = motion.columns();
    let mut specs = every_model();
    for both in [["delay", "presliding"], ["delay", "load"]] {
        specs.push(Spec::new("bittencourt_a", both).unwrap());
    }
    for spec in specs {
        let values = values(&spec);
        let p = values.len();
        let (torque, full) = batch::gradient(&spec, &values, &columns, None).unwrap();
        let odd: Vec<usize> = (0..p).rev().filter(|i| i % 2 == 1).collect();
        let picks = (0..p).map(|i| vec![i]).chain([vec![], odd, (0..p).rev().collect()]);
        for wanted in picks {
            let (same, part) = batch::gradient(&spec, &values, &columns, Some(&wanted)).unwrap();
            assert_eq!(torque, same, "{spec} by {wanted:?}");
            let expected = full.chunks(p).flat_map(|row| wanted.iter().map(|&i| row[i].to_bits()));
            assert!(part.iter().map(|x| x.to_bits()).eq(expected), "{spec} by {wanted:?}");
        }
    }
}

#[test]
fn selected_parameters_exist_and_are_unique() {
    let motion = motion(3);
    let spec = Spec::new("coulomb", []).unwrap();
    let refused = |wanted: &[usize]| {
        batch::gradient(&spec, &[1.0, 2.0], &motion.columns(), Some(wanted)).unwrap_err()
    };
    assert_eq!(refused(&[1, 2]), BatchError::Wanted { index: 2, parameters: 2 });
    assert_eq!(refused(&[1, 0, 1]), BatchError::WantedTwice(1));
}

/// The same bits, in memory that is not zero before; of the right length alone.
#[test]
fn results_go_into_memory_of_the_caller() {
    let motion = motion(60);
    let columns = motion.columns();
    for spec in every_model() {
        let values = values(&spec);
        let (torque, slopes) = batch::gradient(&spec, &values, &columns, None).unwrap();
        let single = batch::torque_single(&spec, &values, &columns).unwrap();
        let wanted: Vec<usize> = (0..values.len()).collect();
        let mut own = vec![f64::NAN; 60];
        let mut own_slopes = vec![f64::NAN; slopes.len()];
        batch::torque_into(&spec, &values, &columns, &mut own).unwrap();
        assert_eq!(own, torque, "{spec}");
        batch::torque_single_into(&spec, &values, &columns, &mut own).unwrap();
        assert_eq!(own, single, "{spec}");
        let into = |torque: &mut [f64], slopes: &mut [f64]| {
            batch::gradient_into(&spec, &values, &columns, &wanted, torque, slopes)
        };
        into(&mut own, &mut own_slopes).unwrap();
        assert_eq!((own.as_slice(), &own_slopes), (torque.as_slice(), &slopes), "{spec}");
        let expected = slopes.len();
        let short = BatchError::Output { length: expected - 1, expected };
        assert_eq!(into(&mut own, &mut own_slopes[1..]), Err(short));
        let short = BatchError::Output { length: 59, expected: 60 };
        assert_eq!(into(&mut own[1..], &mut own_slopes), Err(short));
        assert_eq!(batch::torque_into(&spec, &values, &columns, &mut own[1..]), Err(short));
    }
}

/// Functions of one number with their derivatives, against difference quotients of the values.
#[test]
fn derivatives_of_functions_are_difference_quotients() {
    type Slope = Dual<f64, 1>;
    /// Compares a function from its lowest argument on.
    macro_rules! compare {
        ($($name:literal from $low:literal: |$x:ident, $of:ident| $body:expr;)*) => { $({
            fn function<S: Real>($x: S) -> S {
                let $of = <S::Plain as Real>::from_f64;
                let _ = &$of;
                $body
            }
            for k in 0..60 {
                // No kink, and no argument on the border between two formulas.
                let x = $low + 0.1031 * f64::from(k);
                let h = 1e-3 * x.abs().clamp(0.05, 1.0);
                let quotient = |h: f64| (function(x + h) - function(x - h)) / (2.0 * h);
                let expected = (4.0 * quotient(0.5 * h) - quotient(h)) / 3.0;
                let found = function(Slope::variable(x, 0));
                let value = function(x);
                let size = value.abs().max(1.0);
                assert!((found.value - value).abs() <= 1e-14 * size, "{} at {x}", $name);
                let error = (found.derivative[0] - expected).abs();
                assert!(error < 1e-8 * expected.abs().max(1.0), "{} at {x}: {error}", $name);
            }
        })* };
    }
    compare! {
        "exp" from -3.0: |x, of| x.exp();
        "expm1" from -3.0: |x, of| x.expm1();
        "ln" from 0.05: |x, of| x.ln();
        "sqrt" from 0.05: |x, of| x.sqrt();
        "cbrt" from 0.05: |x, of| x.cbrt();
        "sin" from -3.0: |x, of| x.sin();
        "cos" from -3.0: |x, of| x.cos();
        "sin and cos" from -3.0: |x, of| { let (sin, cos) = x.sin_cos(); sin + cos.scale(of(0.3)) };
        "tanh" from -3.0: |x, of| x.tanh();
        "atan" from -3.0: |x, of| x.atan();
        "abs" from -3.0: |x, of| x.abs();
        "phi_1" from -3.0: |x, of| x.phi(1);
        "phi_2" from -3.0: |x, of| x.phi(2);
        "power" from 0.05: |x, of| x.powf(x.scale(of(0.7)));
        "power of a constant" from -3.0: |x, of| x.exp_with_base(of(0.3));
        "reciprocal" from 0.05: |x, of| x.reciprocal_times(of(2.5));
        "quotient" from 0.05: |x, of| (x * x - x) / (x + x * x.shift(of(1.5)));
        "sums" from -3.0: |x, of| {
            let mut sum = x.shift(of(0.5));
            sum.add_scaled(&(x * x), of(1.5));
            sum.add_linear_combination([&x, &(x * x * x)], [of(0.25), of(-0.75)]);
            sum += x;
            -sum
        };
    }
}
