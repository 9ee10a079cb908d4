//! The elementary functions in vectorised loops.

use std::hint::black_box;

use pulp::Arch;
use stribeck::math;

use crate::{Kernel, Work};

const ELEMENTS: usize = 4096;

macro_rules! kernels {
    ($($name:literal: $low:expr, $high:expr, $function:expr;)+) => {
        pub const KERNELS: &[Kernel] = &[$(
            Kernel { name: $name, rows: ELEMENTS, prepare: || packed!($low, $high, $function) },
        )+];
    };
}

/// The function over numbers from low to high, in an order that branch prediction cannot learn.
macro_rules! packed {
    ($low:expr, $high:expr, $function:expr) => {{
        let turn = |i: usize| (i * 7919 % ELEMENTS) as f64 / ELEMENTS as f64;
        let arguments: Vec<f64> = (0..ELEMENTS).map(|i| $low + ($high - $low) * turn(i)).collect();
        let mut values = vec![0.0; ELEMENTS];
        let work: Work = Box::new(move || {
            let (arguments, values) = (black_box(&arguments[..]), black_box(&mut values[..]));
            Arch::new().dispatch(
                #[inline(always)]
                || {
                    for (value, &argument) in values.iter_mut().zip(arguments) {
                        *value = $function(argument);
                    }
                },
            );
        });
        work
    }};
}

kernels! {
    "exp": -20.0, 5.0, math::f64::exp;
    "expm1": -20.0, 1.0, math::f64::expm1;
    "ln": 0.01, 9.0, math::f64::ln;
    "tanh": -5.0, 5.0, math::f64::tanh;
    "atan": -5.0, 5.0, math::f64::atan;
    "powf": 0.01, 9.0, |x| math::f64::powf(x, 1.37);
    "sin and cos": -5.0, 5.0, |x| {
        let (sin, cos) = math::f64::sin_cos_fast(x);
        sin + cos
    };
}
