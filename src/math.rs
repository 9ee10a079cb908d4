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
            /// Near zero the recurrence cancels, so there the series is summed.
            #[inline]
            #[must_use]
            pub fn phi(order: u8, x: $float) -> $float {
                if order <= 1 && x != 0.0 {
                    return expm1(x) / x;
                }
                let mut factorial: $float = 1.0;
                if -0.5 < x && x < 0.5 {
                    let mut sum: $float = 1.0;
                    let mut j: u8 = 14;
                    while j > 0 {
                        sum = 1.0 + sum * (x * (1.0 / <$float>::from(j + order)));
                        j -= 1;
                    }
                    for k in 2..=order {
                        factorial *= <$float>::from(k);
                    }
                    return sum / factorial;
                }
                let mut phi = expm1(x) / x;
                for k in 1..order {
                    factorial *= <$float>::from(k);
                    phi = (phi - 1.0 / factorial) / x;
                }
                phi
            }

            /// `x` to the power `p`.
            #[inline]
            #[must_use]
            pub fn powf(x: $float, p: $float) -> $float {
                elementary!(@pow $float, x, p)
            }
        }
    };
    (@pow f64, $x:ident, $p:ident) => { libm::pow($x, $p) };
    (@pow f32, $x:ident, $p:ident) => { libm::powf($x, $p) };
}

elementary!(f64: exp = exp, expm1 = expm1, ln = log, tanh = tanh, atan = atan, sqrt = sqrt,
    cbrt = cbrt, sin = sin, cos = cos);
elementary!(f32: exp = expf, expm1 = expm1f, ln = logf, tanh = tanhf, atan = atanf, sqrt = sqrtf,
    cbrt = cbrtf, sin = sinf, cos = cosf);
