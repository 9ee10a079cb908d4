//! Transcendental functions with the same bits on every machine.
//!
//! They use only `+ - * /`, comparisons and integer operations on bits, in a fixed order, so that a
//! desktop, a microcontroller and every vector unit compute the same bits. `clippy.toml` bans the
//! functions of `std` and `libm` elsewhere. There is no fused multiply-add, and single precision
//! never computes in double.
//!
//! Only [`sin_cos`](f64::sin_cos), [`sin`](f64::sin), [`cos`](f64::cos) and [`phi`](f64::phi) of
//! order 3 and above branch: the compiler vectorises a loop over a slice with any other. For sines
//! in such a loop use [`sin_cos_fast`](f64::sin_cos_fast), and recompute with `sin_cos` where
//! [`needs_exact_reduction`](f64::needs_exact_reduction) is true: the bits are the same.
//!
//! Some functions also come in two halves, with the same bits: two loops over a block keep more
//! independent operations in flight than one.
//!
//! | file | content |
//! |---|---|
//! | `exponential`, `phi`, `logarithm`, `power`, `hyperbolic`, `arctangent`, `trigonometric` | the functions, generic over both formats |
//! | `branching` | some of them with branches, for one number at a time |
//! | `double`, `single`, `format` | constants and minimax polynomials of each format |
//! | `phase` | reduction of large arguments of sine and cosine |
//! | `root` | square roots, correctly rounded |
//! | `cube_root` | cube roots in loops |
//! | `bits` | signs, powers of two and integers in the bits of a float |
//! | `polynomial` | Estrin's scheme |
//! | `listing` | all constants by name |
//!
//! Errors are below 1 unit in the last place for `exp`, `ln`, `sin` and `cos`, 1.3 for `expm1`,
//! `tanh` and `atan`, 1.7 for `phi_1`, 1.9 for `powf` and 4 for `phi_2`, over the whole range
//! (`tests/math.rs`).

mod arctangent;
mod bits;
mod branching;
#[cfg(feature = "std")]
mod cube_root;
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
        /// Elementary functions of one primitive type.
        pub mod $float {
            use super::{
                arctangent, exponential, hyperbolic, listing, logarithm, phi, power, root,
                trigonometric,
            };

            /// Calls `each` with the name and value of every constant and coefficient list of these
            /// functions, for code generated in other languages.
            pub fn constants(each: impl FnMut(&'static str, &[$float])) {
                listing::constants(each);
            }

            elementary!(@ "`e^x`.", exp(x: $float) -> $float, exponential::exp(x));
            elementary!(@ "The first half of [`exp`]: a power of two, and the rest in two parts.",
                exp_reduced(x: $float) -> ($float, ($float, $float)), exponential::exp_reduced(x));
            elementary!(@ "The second half of [`exp`].",
                exp_of_reduced(n: $float, rest: ($float, $float)) -> $float,
                exponential::exp_of_reduced(n, rest));
            elementary!(@ "Whether [`exp_of_reduced`] is [`usual_exp_of_reduced`], from the argument of [`exp`].",
                is_usual_exp(x: $float) -> bool, exponential::is_usual_exp(x));
            elementary!(@ "[`exp_of_reduced`] where [`is_usual_exp`].",
                usual_exp_of_reduced(n: $float, rest: ($float, $float)) -> $float,
                exponential::usual_exp_of_reduced(n, rest));
            elementary!(@ "`e^x - 1`.", expm1(x: $float) -> $float, exponential::expm1(x));
            elementary!(@ "The first half of [`expm1`]: a power of two, and the rest in two parts.",
                expm1_reduced(x: $float) -> ($float, ($float, $float)),
                exponential::expm1_reduced(x));
            elementary!(@ "The second half of [`expm1`].",
                expm1_of_reduced(x: $float, n: $float, rest: ($float, $float)) -> $float,
                exponential::expm1_of_reduced(x, n, rest));
            elementary!(@ "`phi_k(x) = sum_j x^j / (j + k)!`, the weights of an exponential integrator.",
                phi(order: u8, x: $float) -> $float, phi::phi(order, x));
            elementary!(@ "Natural logarithm.", ln(x: $float) -> $float, logarithm::ln(x));
            elementary!(@ "`x` to the power `p`; of a negative `x` integer powers only.",
                powf(x: $float, p: $float) -> $float, power::powf(x, p));
            elementary!(@ "Binary logarithm of a normal, positive number in two parts, for [`powf_fast`].",
                log2_fast(x: $float) -> ($float, $float), power::log2_fast(x));
            elementary!(@ "The first half of [`log2_fast`]: the exponent, and a quotient in two parts.",
                log2_quotient(x: $float) -> ($float, ($float, $float)), power::log2_quotient(x));
            elementary!(@ "The second half of [`log2_fast`].",
                log2_of_quotient(k: $float, quotient: ($float, $float)) -> ($float, $float),
                logarithm::log2_of_quotient(k, quotient));
            elementary!(@ "The power from the [logarithm](log2_fast), or NaN where [`powf`] must be used.",
                powf_fast(x: $float, logarithm: ($float, $float), p: $float) -> $float,
                power::powf_fast(x, logarithm, p));
            elementary!(@ "The first half of [`powf_fast`]: the power of two as an integer and a fraction.",
                exponent_fast(logarithm: ($float, $float), p: $float) -> ($float, $float),
                power::exponent_fast(logarithm, p));
            elementary!(@ "The second half of [`powf_fast`].",
                powf_of_exponent(x: $float, exponent: ($float, $float), p: $float) -> $float,
                power::powf_of_exponent(x, exponent, p));
            elementary!(@ "Whether [`powf_of_exponent`] is [`usual_power`], from the integer.",
                is_usual_power(x: $float, n: $float) -> bool, power::is_usual_power(x, n));
            elementary!(@ "[`powf_of_exponent`] where [`is_usual_power`].",
                usual_power(exponent: ($float, $float)) -> $float, power::usual_power(exponent));
            elementary!(@ "The power for an exponent of 0, 1 or 2, which [`powf_fast`] does not support; else `value`.",
                power_without_logarithm(value: $float, x: $float, p: $float) -> $float,
                power::without_logarithm(value, x, p));
            elementary!(@ "Whether [`powf_fast`] supports this exponent.",
                is_plain_exponent(p: $float) -> bool, power::is_plain_exponent(p));
            elementary!(@ "Hyperbolic tangent.", tanh(x: $float) -> $float, hyperbolic::tanh(x));
            elementary!(@ "Arc tangent.", atan(x: $float) -> $float, arctangent::atan(x));
            elementary!(@ "The first half of [`tanh`]: a power of two, and the rest in two parts.",
                tanh_reduced(x: $float) -> ($float, ($float, $float)), hyperbolic::tanh_reduced(x));
            elementary!(@ "The second half of [`tanh`].",
                tanh_of_reduced(x: $float, n: $float, rest: ($float, $float)) -> $float,
                hyperbolic::tanh_of_reduced(x, n, rest));
            elementary!(@ "Square root.", sqrt(x: $float) -> $float, root::$sqrt(x));
            elementary!(@ "Cube root, negative for negative `x`.", cbrt(x: $float) -> $float, libm::$cbrt(x));
            elementary!(@ "Sine.", sin(x: $float) -> $float, sin_cos(x).0);
            elementary!(@ "Cosine.", cos(x: $float) -> $float, sin_cos(x).1);
            elementary!(@ "Sine and cosine.", sin_cos(x: $float) -> ($float, $float),
                trigonometric::sin_cos(x));
            elementary!(@ "Sine and cosine without a branch, where [`needs_exact_reduction`] is false.",
                sin_cos_fast(x: $float) -> ($float, $float), trigonometric::sin_cos_fast(x));
            /// The same functions with branches, for one number at a time: fewer operations, equal
            /// bits.
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
                needs_exact_reduction(x: $float) -> bool, trigonometric::needs_exact_reduction(x));
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

/// Cube roots in loops over many numbers.
#[cfg(feature = "std")]
pub(crate) use cube_root::cbrt_fast;
elementary!(f32: sqrtf, cbrtf);
