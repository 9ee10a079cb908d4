//! The one door to transcendental functions.
//!
//! Everything goes through `libm`, never through `std`, so that a wheel, a test and a
//! microcontroller compute the same bits. `clippy.toml` bans every other way.

macro_rules! elementary {
    ($float:ident: $($name:ident = $libm:ident),+ $(,)?) => {
        /// Elementary functions on one primitive type.
        pub mod $float {
            $(
                #[doc = concat!("`libm::", stringify!($libm), "`.")]
                #[inline]
                #[must_use]
                pub fn $name(x: $float) -> $float {
                    libm::$libm(x)
                }
            )+

            /// `phi_k(x) = sum_j x^j / (j + k)!`, so `phi_1 = expm1(x) / x` and
            /// `phi_(k+1) = (phi_k - 1/k!) / x`: the weights of an exponential step.
            ///
            /// Near zero the recurrence cancels, so there the series is summed, even and odd
            /// terms apart: neither has to wait for the other.
            #[inline]
            #[must_use]
            pub fn phi(order: u8, x: $float) -> $float {
                if order <= 1 && x != 0.0 {
                    return expm1(x) / x;
                }
                if -0.5 < x && x < 0.5 {
                    let term = |j: usize| match INVERSE_FACTORIALS.get(j + usize::from(order)) {
                        Some(&inverse) => inverse,
                        None => 0.0,
                    };
                    let square = x * x;
                    let (mut even, mut odd) = (term(14), term(15));
                    for j in (0..7).rev() {
                        even = even * square + term(2 * j);
                        odd = odd * square + term(2 * j + 1);
                    }
                    return even + x * odd;
                }
                let mut factorial: $float = 1.0;
                let mut phi = expm1(x) / x;
                for k in 1..order {
                    factorial *= <$float>::from(k);
                    phi = (phi - 1.0 / factorial) / x;
                }
                phi
            }

            /// `1/n!`.
            const INVERSE_FACTORIALS: [$float; 20] = {
                let mut inverse: [$float; 20] = [1.0; 20];
                let mut factorial = 1.0;
                let mut n = 1;
                while n < inverse.len() {
                    factorial *= n as $float;
                    inverse[n] = 1.0 / factorial;
                    n += 1;
                }
                inverse
            };

            /// Sine and cosine.
            #[inline]
            #[must_use]
            pub fn sin_cos(x: $float) -> ($float, $float) {
                elementary!(@sin_cos $float, x)
            }

            /// `x` to the power `p`.
            #[inline]
            #[must_use]
            pub fn powf(x: $float, p: $float) -> $float {
                elementary!(@pow $float, x, p)
            }
        }
    };
    (@sin_cos f64, $x:ident) => { libm::sincos($x) };
    (@sin_cos f32, $x:ident) => { libm::sincosf($x) };
    (@pow f64, $x:ident, $p:ident) => { libm::pow($x, $p) };
    (@pow f32, $x:ident, $p:ident) => { libm::powf($x, $p) };
}

elementary!(f64: exp = exp, expm1 = expm1, ln = log, tanh = tanh, atan = atan, sqrt = sqrt,
    cbrt = cbrt, sin = sin, cos = cos);
elementary!(f32: exp = expf, expm1 = expm1f, ln = logf, tanh = tanhf, atan = atanf, sqrt = sqrtf,
    cbrt = cbrtf, sin = sinf, cos = cosf);
