//! Polynomials by Estrin's scheme.

/// `c0 + c1 x + c2 x^2 + ...`: pairs of neighbours form a polynomial in `x^2`, and so on. The chain
/// of dependent operations has a length of about `log2 n` for `n` coefficients; Horner's scheme has
/// `n`. With brackets around `c0` there is no `c1`: `c0 + c2 x^2 + c3 x^3 + ...`.
macro_rules! estrin {
    ($x:ident; [$first:expr], $($coefficient:expr),+ $(,)?) => {
        estrin!(@pairs $x [$first] $($coefficient),+)
    };
    ($x:ident; $($coefficient:expr),+ $(,)?) => {
        estrin!(@pairs $x [] $($coefficient),+)
    };
    (@pairs $x:ident [] $last:expr) => { $last };
    (@pairs $x:ident [$($joined:expr),*] $even:expr, $odd:expr $(, $rest:expr)*) => {
        estrin!(@pairs $x [$($joined,)* $even + $odd * $x] $($rest),*)
    };
    (@pairs $x:ident [$only:expr]) => { $only };
    (@pairs $x:ident [$($joined:expr),+] $last:expr) => {
        estrin!(@pairs $x [$($joined,)+ $last])
    };
    (@pairs $x:ident [$($joined:expr),+]) => {{
        let square = $x * $x;
        estrin!(@pairs square [] $($joined),+)
    }};
}

/// The polynomials of a format: each as a function, and its coefficients as a constant.
macro_rules! polynomials {
    ($(
        $name:ident = $constant:ident($x:ident $(, $([$without_next:ident])? $($first:ident)?)?):
        $($coefficient:expr),+ $(,)?;
    )+) => {$(
        const $constant: &'static [Self] = &[$($coefficient),+];

        #[inline(always)]
        fn $name($($($without_next: Self,)? $($first: Self,)?)? $x: Self) -> Self {
            estrin!($x; $($([$without_next],)? $($first,)?)? $($coefficient),+)
        }
    )+};
}

pub(super) use {estrin, polynomials};
