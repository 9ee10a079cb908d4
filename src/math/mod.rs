//! The one door to transcendental functions.
//!
//! They are written in `+ - * /`, comparisons and whole-number operations on bits, in one order, so
//! that a wheel, a test, a microcontroller and every vector unit compute the same bits. `clippy.toml`
//! bans every other way; a fused multiply-add is used nowhere, and single precision never computes
//! in double.
//!
//! No function but [`sin_cos`](f64::sin_cos), [`sin`](f64::sin), [`cos`](f64::cos) and
//! [`phi`](f64::phi) of order 3 and more has a branch: a loop over a slice becomes packed code. For
//! sines in such a loop take [`sin_cos_fast`](f64::sin_cos_fast) and mend what
//! [`needs_care`](f64::needs_care) with `sin_cos`: the bits are the same.
//!
//! | file | what is there |
//! |---|---|
//! | `exponential`, `phi`, `logarithm`, `power`, `hyperbolic`, `arctangent`, `trigonometric` | the functions, once for both formats |
//! | `branching` | some of them again for one number at a time |
//! | `double`, `single`, `format` | constants and minimax polynomials of a format |
//! | `phase` | quarter turns in a large phase |
//! | `root` | square roots, as IEEE 754 has them |
//! | `bits` | powers of two, whole numbers and signs |
//! | `polynomial` | Estrin's scheme |
//! | `listing` | all constants by name |
//!
//! Errors are below 1 unit in the last place for `exp`, `ln`, `sin` and `cos`, 1.3 for `expm1`,
//! `tanh` and `atan`, 1.7 for `phi_1`, 1.9 for `powf` and 4 for `phi_2`, over the whole range
//! (`tests/math.rs`).

mod arctangent;
mod bits;
mod branching;
mod double;
mod exponential;
mod format;
mod hyperbolic;
mod listing;
mod logarithm;
mod phase;
mod phi;
mod polynomial;
mod power;
mod root;
mod single;
mod trigonometric;

macro_rules! elementary {
    ($float:ident: $sqrt:ident, $cbrt:ident) => {
        /// Elementary functions on one primitive type.
        pub mod $float {
            use super::{
                arctangent, exponential, hyperbolic, listing, logarithm, phi, power, root,
                trigonometric,
            };

            /// Each constant behind these functions, and each polynomial's coefficients, by name:
            /// for programs in other languages.
            pub fn constants(each: impl FnMut(&'static str, &[$float])) {
                listing::constants(each);
            }

            elementary!(@ "`e^x`.", exp(x: $float) -> $float, exponential::exp(x));
            elementary!(@ "`e^x - 1`.", expm1(x: $float) -> $float, exponential::expm1(x));
            elementary!(@ "`phi_k(x) = sum_j x^j / (j + k)!`, the weights of an exponential step.",
                phi(order: u8, x: $float) -> $float, phi::phi(order, x));
            elementary!(@ "Natural logarithm.", ln(x: $float) -> $float, logarithm::ln(x));
            elementary!(@ "`x` to the power `p`; of a negative `x` only whole ones.",
                powf(x: $float, p: $float) -> $float, power::powf(x, p));
            elementary!(@ "Binary logarithm of a normal, positive number in two parts: half of a power.",
                log2_fast(x: $float) -> ($float, $float), power::log2_fast(x));
            elementary!(@ "The power from the [logarithm](log2_fast), or NaN where [`powf`] is to be asked.",
                powf_fast(x: $float, logarithm: ($float, $float), p: $float) -> $float,
                power::powf_fast(x, logarithm, p));
            elementary!(@ "The power by an exponent of 0, 1 or 2, which [`powf_fast`] does not take; else `value`.",
                power_without_logarithm(value: $float, x: $float, p: $float) -> $float,
                power::without_logarithm(value, x, p));
            elementary!(@ "Whether [`powf_fast`] takes this exponent.",
                is_plain_exponent(p: $float) -> bool, power::is_plain_exponent(p));
            elementary!(@ "Hyperbolic tangent.", tanh(x: $float) -> $float, hyperbolic::tanh(x));
            elementary!(@ "Arc tangent.", atan(x: $float) -> $float, arctangent::atan(x));
            elementary!(@ "Square root.", sqrt(x: $float) -> $float, root::$sqrt(x));
            elementary!(@ "Real, odd cube root.", cbrt(x: $float) -> $float, libm::$cbrt(x));
            elementary!(@ "Sine.", sin(x: $float) -> $float, sin_cos(x).0);
            elementary!(@ "Cosine.", cos(x: $float) -> $float, sin_cos(x).1);
            elementary!(@ "Sine and cosine.", sin_cos(x: $float) -> ($float, $float),
                trigonometric::sin_cos(x));
            elementary!(@ "Sine and cosine without a branch, where `x` does not [need care](needs_care).",
                sin_cos_fast(x: $float) -> ($float, $float), trigonometric::sin_cos_fast(x));
            /// The same functions for one number at a time, by branches: fewer operations, equal bits.
            pub mod branching {
                use super::super::branching;

                elementary!(@ "`e^x`.", exp(x: $float) -> $float, branching::exp(x));
                elementary!(@ "`e^x - 1`.", expm1(x: $float) -> $float, branching::expm1(x));
                elementary!(@ "`phi_k(x)`.",
                    phi(order: u8, x: $float) -> $float, branching::phi(order, x));
                elementary!(@ "`x` to the power `p`.",
                    powf(x: $float, p: $float) -> $float, branching::powf(x, p));
                elementary!(@ "Sine and cosine.", sin_cos(x: $float) -> ($float, $float),
                    branching::sin_cos(x));
            }

            elementary!(@ "Whether `x` is too large for [`sin_cos_fast`].",
                needs_care(x: $float) -> bool, trigonometric::needs_care(x));
        }
    };
    (@ $doc:literal, $name:ident($($x:ident: $from:ty),+) -> $to:ty, $value:expr) => {
        #[doc = $doc]
        #[inline(always)]
        #[must_use]
        pub fn $name($($x: $from),+) -> $to {
            $value
        }
    };
}

elementary!(f64: sqrt, cbrt);
elementary!(f32: sqrtf, cbrtf);
