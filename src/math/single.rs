//! Constants and polynomials of single precision.
//!
//! `tests/elementary/coefficients.py` computes the coefficients.

// Coefficients are written with all digits that identify the float; the rounded ln 2 is intended.
#![allow(clippy::approx_constant, clippy::excessive_precision)]

use super::format::Format;
use super::polynomial::{estrin, polynomials};

impl Format for f32 {
    const EXP_RANGE: (Self, Self) = (-105.0, 89.0);
    const EXPM1_RANGE: (Self, Self) = (-20.0, 89.0);
    const EXP2_RANGE: Self = 200.0;
    const EXP2_NORMAL: Self = 124.0;
    const EXPM1_LINEAR: Self = 7.450580596923828e-9;
    // Powers of two: cheap to compare with.
    const EXP_USUAL: Self = 64.0;
    const EXP_FAR: Self = 128.0;
    const EXPM1_USUAL: Self = 32.0;
    const PHASE_USUAL: Self = 0.75;
    const TANH_ONE: Self = 10.0;
    const LARGE_EXPONENT: Self = 1e10;
    const LARGEST_PHASE: Self = 3000.0;

    const LOG2_E: Self = 1.442695;
    const LN_2: [Self; 2] = [0.69314575, 1.4286068e-06];
    const LOG2_SCALE: [Self; 2] = [0.96191406, -0.000117368574];
    const FRAC_2_PI: Self = 0.63661975;
    const PI_HALF: [Self; 4] = [1.5708008, -4.454516e-06, 6.0765615e-11, 5.390303e-15];
    const PI_HALF_PAIR: [Self; 2] = [1.5707964, -4.371139e-08];

    const PHI_PAIRS: usize = 4;

    fn inverse_factorial(n: usize) -> Self {
        INVERSE_FACTORIALS.get(n).copied().unwrap_or(0.0)
    }

    polynomials! {
        exp_beyond = EXP_BEYOND(r, [first]):
            0.5,
            0.16666518,
            0.041666206,
            0.00836889,
            0.0013950492;

        expm1_beyond = EXPM1_BEYOND(r, [first]):
            0.5,
            0.16666667,
            0.041666467,
            0.008333286,
            0.0013933652,
            0.00019907588;

        exp2_series = EXP2_SERIES(f):
            0.6931472,
            0.2402265,
            0.05550328,
            0.009618004,
            0.0013400282,
            0.00015476315;

        log_beyond = LOG_BEYOND(z, first):
            0.66666776,
            0.39977533,
            0.29871997;

        log_tail = LOG_TAIL(z):
            0.6000023,
            0.42820686,
            0.3512823;

        atan_series = ATAN_SERIES(z):
            -0.33333316,
            0.19998488,
            -0.14243828,
            0.10595831,
            -0.060830005;

        sin_series = SIN_SERIES(z):
            -0.16666655,
            0.008332178,
            -0.00019517235;

        cos_beyond = COS_BEYOND(z, [first]):
            0.041666646,
            -0.0013887367,
            2.443838e-05;
    }
}

const INVERSE_FACTORIALS: [f32; 20] = {
    let mut inverse: [f32; 20] = [1.0; 20];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < inverse.len() {
        factorial *= n as f32;
        inverse[n] = 1.0 / factorial;
        n += 1;
    }
    inverse
};
