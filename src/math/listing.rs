//! The constants of a format by name, for code generated in other languages.

use super::format::Format;

/// Calls `each` with the name of every constant and coefficient list, and its values.
pub fn constants<F: Format>(mut each: impl FnMut(&'static str, &[F])) {
    each("exp_range", &[F::EXP_RANGE.0, F::EXP_RANGE.1]);
    each("expm1_range", &[F::EXPM1_RANGE.0, F::EXPM1_RANGE.1]);
    each("exp2_range", &[F::EXP2_RANGE]);
    each("expm1_linear", &[F::EXPM1_LINEAR]);
    each("tanh_one", &[F::TANH_ONE]);
    each("large_exponent", &[F::LARGE_EXPONENT]);
    each("largest_phase", &[F::LARGEST_PHASE]);
    each("log2_e", &[F::LOG2_E]);
    each("ln_2", &F::LN_2);
    each("log2_scale", &F::LOG2_SCALE);
    each("frac_2_pi", &[F::FRAC_2_PI]);
    each("pi_half", &F::PI_HALF);
    each("pi_half_pair", &F::PI_HALF_PAIR);
    each("exp_beyond", F::EXP_BEYOND);
    each("expm1_beyond", F::EXPM1_BEYOND);
    each("exp2_series", F::EXP2_SERIES);
    each("log_beyond", F::LOG_BEYOND);
    each("log_tail", F::LOG_TAIL);
    each("atan_series", F::ATAN_SERIES);
    each("sin_series", F::SIN_SERIES);
    each("cos_beyond", F::COS_BEYOND);
}
