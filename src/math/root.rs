//! Square roots. IEEE 754 requires correct rounding, so every implementation gives the same bits.

macro_rules! square_root {
    ($(#[$doc:meta] $name:ident($float:ident) without_std $other:path;)+) => {$(
        #[$doc]
        #[inline(always)]
        #[must_use]
        pub fn $name(x: $float) -> $float {
            // `std`'s square root compiles to an instruction that vectorises with the loop around
            // it.
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
