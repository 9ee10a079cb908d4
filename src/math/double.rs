//! Constants and polynomials of double precision.
//!
//! `tests/elementary/coefficients.py` computes the coefficients.

// Coefficients are written with all digits that identify the float; the rounded ln 2 is intended.
#![allow(clippy::approx_constant, clippy::excessive_precision)]

use super::format::Format;
use super::polynomial::{estrin, polynomials};

impl Format for f64 {
    const EXP_RANGE: (Self, Self) = (-746.0, 710.0);
    const EXPM1_RANGE: (Self, Self) = (-40.0, 710.0);
    const EXP2_RANGE: Self = 1100.0;
    const EXP2_NORMAL: Self = 1020.0;
    const EXPM1_LINEAR: Self = 5.551115123125783e-17;
    // Powers of two: cheap to compare with.
    const EXP_USUAL: Self = 512.0;
    const EXP_FAR: Self = 1024.0;
    const EXPM1_USUAL: Self = 64.0;
    const PHASE_USUAL: Self = 0.75;
    const TANH_ONE: Self = 20.0;
    const LARGE_EXPONENT: Self = 1e20;
    const LARGEST_PHASE: Self = 1.6e6;

    const LOG2_E: Self = 1.4426950408889634;
    const LN_2: [Self; 2] = [0.6931471806019545, -4.2009150726810846e-11];
    const LOG2_SCALE: [Self; 2] = [0.9617967009544373, -7.028461650952758e-09];
    const FRAC_2_PI: Self = 0.6366197723675814;
    const PI_HALF: [Self; 4] =
        [1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21, 8.4784276603689e-32];
    const PI_HALF_PAIR: [Self; 2] = [1.5707963267948966, 6.123233995736766e-17];

    const PHI_PAIRS: usize = 8;

    fn inverse_factorial(n: usize) -> Self {
        INVERSE_FACTORIALS.get(n).copied().unwrap_or(0.0)
    }

    polynomials! {
        exp_beyond = EXP_BEYOND(r, [first]):
            0.5000000000000012,
            0.166666666666667,
            0.041666666666515424,
            0.008333333333307186,
            0.0013888888947014629,
            0.00019841269917418965,
            2.4801489943565084e-05,
            2.7557216273628184e-06,
            2.763127985027585e-07,
            2.511786842023446e-08;

        expm1_beyond = EXPM1_BEYOND(r, [first]):
            0.5,
            0.1666666666666667,
            0.041666666666666685,
            0.008333333333326134,
            0.0013888888888874391,
            0.00019841269874821857,
            2.4801587347354315e-05,
            2.755725539884026e-06,
            2.75572529010907e-07,
            2.510521750304957e-08,
            2.092159246374393e-09;

        exp2_series = EXP2_SERIES(f):
            0.6931471805599453,
            0.24022650695910133,
            0.05550410866482174,
            0.009618129107593304,
            0.0013333558146378921,
            0.00015403530458117548,
            1.5252733867632962e-05,
            1.321543479660229e-06,
            1.0178046429437528e-07,
            7.073863882821923e-09,
            4.4573912782735057e-10;

        log_beyond = LOG_BEYOND(z, first):
            0.6666666666666734,
            0.39999999999413965,
            0.2857142874256129,
            0.22222198553916228,
            0.18183565399028034,
            0.15314021353175536,
            0.14796258652536134;

        log_tail = LOG_TAIL(z):
            0.5999999999999996,
            0.42857142857167685,
            0.33333333326300674,
            0.2727272830596766,
            0.23076835272559837,
            0.2000447743879413,
            0.17512201067986602,
            0.17983742864421887;

        atan_series = ATAN_SERIES(z):
            -0.333333333333332,
            0.19999999999953996,
            -0.14285714280239575,
            0.11111110785672305,
            -0.09090897822564546,
            0.07692061381968684,
            -0.06663117397558105,
            0.058479866042361967,
            -0.05039742523452163,
            0.03807564582985294,
            -0.017919289335346308;

        sin_series = SIN_SERIES(z):
            -0.16666666666666632,
            0.008333333333322413,
            -0.00019841269829807957,
            2.75573136919588e-06,
            -2.5050758120523338e-08,
            1.589679591390133e-10;

        cos_beyond = COS_BEYOND(z, [first]):
            0.0416666666666666,
            -0.0013888888888874125,
            2.480158728948228e-05,
            -2.7557314352354947e-07,
            2.0875723275799333e-09,
            -1.1359647923399437e-11;
    }
}

const INVERSE_FACTORIALS: [f64; 20] = {
    let mut inverse: [f64; 20] = [1.0; 20];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < inverse.len() {
        factorial *= n as f64;
        inverse[n] = 1.0 / factorial;
        n += 1;
    }
    inverse
};
