//! Elementary functions against values at 50 digits (`tests/elementary/references.py`), at special
//! points, and in vectorised loops.

use std::collections::BTreeMap;

use stribeck::math;

/// The largest error of each function, in units in the last place.
const BOUNDS: [(&str, f64); 11] = [
    ("exp", 1.0),
    ("expm1", 1.3),
    ("phi_1", 1.7),
    ("phi_2", 4.0),
    ("phi_3", 6.0),
    ("ln", 1.0),
    ("tanh", 1.3),
    ("atan", 1.3),
    ("sin", 1.0),
    ("cos", 1.0),
    ("powf", 1.9),
];

fn bound(function: &str) -> f64 {
    BOUNDS.iter().find(|(name, _)| *name == function).expect("a bound for each function").1
}

/// A function of one number, and a loop over many with the widest vector registers.
macro_rules! loops {
    ($name:ident: $function:expr) => {
        (stringify!($name), $function, |values| {
            fn plain<T: Copy>(values: &mut [T], function: impl Fn(T) -> T) {
                for x in values {
                    *x = function(*x);
                }
            }
            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2")]
            fn wide<T: Copy>(values: &mut [T], function: impl Fn(T) -> T) {
                plain(values, function);
            }
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor supports it.
                return unsafe { wide(values, $function) };
            }
            plain(values, $function);
        })
    };
}

macro_rules! format {
    ($float:ident, $whole:ident, $signed:ident) => {
        mod $float {
            use super::math::$float as own;

            pub fn value(function: &str, x: $float, p: $float) -> $float {
                match function {
                    "exp" => own::exp(x),
                    "expm1" => own::expm1(x),
                    "phi_1" => own::phi(1, x),
                    "phi_2" => own::phi(2, x),
                    "phi_3" => own::phi(3, x),
                    "ln" => own::ln(x),
                    "tanh" => own::tanh(x),
                    "atan" => own::atan(x),
                    "sin" => own::sin(x),
                    "cos" => own::cos(x),
                    "powf" => own::powf(x, p),
                    _ => panic!("no function {function}"),
                }
            }

            /// Errors in units in the last place, from a row of the references.
            pub fn error(function: &str, arguments: &str, nearest: &str, above: f64) -> f64 {
                let number = |bits: &str| {
                    $float::from_bits($whole::from_str_radix(bits, 16).expect("hexadecimal bits"))
                };
                let mut arguments = arguments.split(' ').map(number);
                let x = arguments.next().expect("an argument");
                let value = value(function, x, arguments.next().unwrap_or_default());
                let nearest = number(nearest);
                assert_eq!(
                    value.is_sign_negative(),
                    nearest.is_sign_negative(),
                    "{function} {x:e}"
                );
                let steps = value.to_bits() as $signed - nearest.to_bits() as $signed;
                (steps as f64 - above).abs()
            }

            fn same(value: $float, expected: $float) -> bool {
                value.to_bits() == expected.to_bits() || value.is_nan() && expected.is_nan()
            }

            #[test]
            fn special_points() {
                let inf = $float::INFINITY;
                let (largest, smallest) = ($float::MAX, $float::from_bits(1));
                let check = |value: $float, expected: $float, name: &str| {
                    assert!(same(value, expected), "{name}: {value:e}, not {expected:e}");
                };
                check(own::exp(0.0), 1.0, "exp 0");
                check(own::exp(-0.0), 1.0, "exp -0");
                check(own::exp(inf), inf, "exp inf");
                check(own::exp(largest), inf, "exp max");
                check(own::exp(-inf), 0.0, "exp -inf");
                check(own::exp(-largest), 0.0, "exp -max");
                check(own::expm1(inf), inf, "expm1 inf");
                check(own::expm1(largest), inf, "expm1 max");
                check(own::expm1(-inf), -1.0, "expm1 -inf");
                check(own::phi(1, 0.0), 1.0, "phi_1 0");
                check(own::phi(2, 0.0), 0.5, "phi_2 0");
                check(own::phi(2, smallest), 0.5, "phi_2 of the smallest");
                check(own::phi(1, -inf), 0.0, "phi_1 -inf");
                check(own::phi(1, inf), inf, "phi_1 inf");
                check(own::phi(2, inf), inf, "phi_2 inf");
                check(own::ln(0.0), -inf, "ln 0");
                check(own::ln(-0.0), -inf, "ln -0");
                check(own::ln(1.0), 0.0, "ln 1");
                check(own::ln(inf), inf, "ln inf");
                check(own::ln(-1.0), $float::NAN, "ln -1");
                check(own::ln(-inf), $float::NAN, "ln -inf");
                check(own::tanh(inf), 1.0, "tanh inf");
                check(own::tanh(-largest), -1.0, "tanh -max");
                check(own::atan(inf), (0.5 * std::f64::consts::PI) as $float, "atan inf");
                check(own::sin(inf), $float::NAN, "sin inf");
                check(own::cos(-inf), $float::NAN, "cos -inf");
                check(own::cos(0.0), 1.0, "cos 0");
                for x in [0.0, -0.0, smallest, -smallest, $float::MIN_POSITIVE] {
                    check(own::expm1(x), x, "expm1");
                    check(own::tanh(x), x, "tanh");
                    check(own::atan(x), x, "atan");
                    check(own::sin(x), x, "sin");
                }
                for order in 0..4 {
                    check(own::phi(order, $float::NAN), $float::NAN, "phi NaN");
                }
                for name in super::BOUNDS.map(|(name, _)| name) {
                    check(value(name, $float::NAN, 0.3), $float::NAN, name);
                }
            }

            #[test]
            fn powers_at_special_points() {
                let inf = $float::INFINITY;
                let nan = $float::NAN;
                let expected = [
                    (0.0, 0.5, 0.0),
                    (0.0, -0.5, inf),
                    (-0.0, 3.0, -0.0),
                    (-0.0, -3.0, -inf),
                    (-0.0, 4.0, 0.0),
                    (-0.0, 0.5, 0.0),
                    (0.0, inf, 0.0),
                    (0.0, -inf, inf),
                    (inf, 0.3, inf),
                    (inf, -0.3, 0.0),
                    (-inf, 3.0, -inf),
                    (-inf, 0.5, inf),
                    (-inf, -3.0, -0.0),
                    (-2.0, 3.0, -8.0),
                    (-2.0, 4.0, 16.0),
                    (-2.0, -3.0, -0.125),
                    (-2.0, 0.5, nan),
                    (-1.0, inf, 1.0),
                    (-1.0, $float::MAX, 1.0),
                    (-1.0, -4e15, 1.0),
                    (0.5, inf, 0.0),
                    (0.5, -inf, inf),
                    (2.0, inf, inf),
                    (2.0, $float::MAX, inf),
                    (2.0, $float::MIN, 0.0),
                    (1.0, inf, 1.0),
                    (1.0, nan, 1.0),
                    (nan, 0.0, 1.0),
                    (nan, 1.0, nan),
                    (nan, 2.0, nan),
                    (0.3, nan, nan),
                    (2.0, 10.0, 1024.0),
                    (4.0, 0.5, 2.0),
                ];
                for (x, p, power) in expected {
                    let value = own::powf(x, p);
                    assert!(same(value, power), "{x:e}^{p:e} = {value:e}, not {power:e}");
                }
                for x in [3.7, 1e-30, -5.5, 0.1, 0.0] {
                    assert!(same(own::powf(x, 1.0), x));
                    assert!(same(own::powf(x, 2.0), x * x));
                    assert!(same(own::powf(x, 0.0), 1.0));
                }
            }

            /// Numbers of all magnitudes and signs, many of them of usual magnitude.
            fn arguments() -> Vec<$float> {
                let step = $whole::MAX / 40_009;
                let every_size = (0..40_009).map(|i| $float::from_bits(step * i));
                every_size.chain((0..9001).map(|i| i as $float / 300.0 - 15.0)).collect()
            }

            const LOOPS: [(&str, fn($float) -> $float, fn(&mut [$float])); 9] = [
        loops!(exp: own::exp),
        loops!(expm1: own::expm1),
        loops!(ln: own::ln),
        loops!(tanh: own::tanh),
        loops!(atan: own::atan),
        loops!(power: |x| own::powf(x, 1.37)),
        loops!(phi_2: |x| own::phi(2, x)),
        loops!(sine: |x| own::sin_cos_fast(x).0),
        loops!(cosine: |x| own::sin_cos_fast(x).1),
            ];

            #[test]
            fn loops_compute_the_same_bits() {
                for (name, function, in_a_loop) in LOOPS {
                    let arguments = arguments();
                    let mut values = arguments.clone();
                    in_a_loop(&mut values);
                    for (x, value) in arguments.into_iter().zip(values) {
                        let alone = function(std::hint::black_box(x));
                        assert!(same(value, alone), "{name}({x:e}): {alone:e} or {value:e}");
                    }
                }
            }

            #[test]
            fn branching_changes_no_bits() {
                use own::branching;
                let limits = [64.0, 87.0, 105.0, 128.0, 512.0, 709.0, 746.0, 1024.0];
                let limits = limits.into_iter().flat_map(|x: $float| [x, -x]);
                for x in arguments().into_iter().chain(limits) {
                    let check = |value, expected, name: &str| {
                        assert!(same(value, expected), "{name} {x:e}: {value:e}, not {expected:e}");
                    };
                    check(branching::exp(x), own::exp(x), "exp");
                    check(branching::expm1(x), own::expm1(x), "expm1");
                    let ((sin, cos), both) = (branching::sin_cos(x), own::sin_cos(x));
                    check(sin, both.0, "sin");
                    check(cos, both.1, "cos");
                    for order in 0..4 {
                        check(branching::phi(order, x), own::phi(order, x), "phi");
                    }
                    for p in [0.0, -0.0, 0.5, 1.0, 1.3, -1.7, 2.0, 3.0, 70.0, 1e9, 1e-30] {
                        check(branching::powf(x, p), own::powf(x, p), "powf");
                    }
                    for p in [$float::INFINITY, -$float::INFINITY, $float::NAN, -$float::MAX] {
                        check(branching::powf(x, p), own::powf(x, p), "powf");
                    }
                }
            }

            #[test]
            fn the_fast_sine_is_the_sine() {
                for x in arguments().into_iter().filter(|&x| !own::needs_exact_reduction(x)) {
                    let (sin, cos) = own::sin_cos_fast(x);
                    assert!(same(own::sin(x), sin) && same(own::cos(x), cos), "{x:e}");
                }
            }
        }
    };
}

format!(f64, u64, i64);
format!(f32, u32, i32);

#[test]
fn errors_are_within_their_bounds() {
    let mut worst = BTreeMap::<(&str, &str), f64>::new();
    for row in include_str!("elementary/references.csv").lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let [format, function, arguments, nearest, above] = cells[..] else {
            panic!("five cells: {row}");
        };
        let above = above.parse().expect("a number");
        let error = match format {
            "f64" => f64::error(function, arguments, nearest, above),
            "f32" => f32::error(function, arguments, nearest, above),
            _ => panic!("no format {format}"),
        };
        let largest = worst.entry((format, function)).or_default();
        *largest = largest.max(error);
    }
    assert_eq!(worst.len(), 2 * BOUNDS.len());
    for ((format, function), error) in worst {
        println!("{format} {function}: {error:.3}");
        assert!(error <= bound(function), "{format} {function} has an error of {error} units");
    }
}
