//! The C interface: friction of a joint in a controller, in double and in single precision.
//!
//! Plain structs that the caller owns, no allocation, no callbacks, no global state: each joint may
//! be stepped from its own thread. `include/stribeck.h` is generated from this crate; `examples/`
//! has a program in C and one in C++.
#![cfg_attr(not(feature = "std"), no_std)]

mod double;
mod joint;
mod single;
mod text;

pub use double::*;
pub use joint::{
    StribeckConstant, StribeckJoint, StribeckSample, StribeckSettings, StribeckSource,
    StribeckStatus,
};
pub use single::*;
pub use text::{stribeck_message, stribeck_parameter_count, stribeck_version};

/// Version of this interface: a program is compatible with a library for which `stribeck_version()`
/// returns the same value.
pub const STRIBECK_VERSION: u32 = 1;

/// Required without `std`. The core never panics.
#[cfg(all(not(feature = "std"), target_os = "none"))]
#[panic_handler]
fn panicked(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
