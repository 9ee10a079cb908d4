//! Square roots: rounded correctly, as IEEE 754 demands, and so the same bits by any of these ways.

macro_rules! square_root {
    ($(#[$doc:meta] $name:ident($float:ident) without_std $other:path;)+) => {$(
        #[$doc]
        #[inline(always)]
        #[must_use]
        pub fn $name(x: $float) -> $float {
            // The compiler's own is an instruction of the kind that the loop around it is made of.
            #[cfg(feature = "std")]
            #[allow(clippy::disallowed_methods)]
            let root = x.sqrt();
            #[cfg(not(feature = "std"))]
            let root = $other(x);
            root
        }
    )+};
}

square_root! {
    /// In double precision.
    sqrt(f64) without_std libm::sqrt;
    /// In single precision.
    sqrtf(f32) without_std libm::sqrtf;
}
