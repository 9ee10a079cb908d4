//! The C interface: friction of a joint in a controller, in double and in single precision.
//!
//! Plain structs that the caller owns, no allocation, no callbacks, no global state: joints may be
//! stepped from as many threads as there are joints. `include/stribeck.h` is generated from this
//! crate; `examples/` has a program in C and one in C++.
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

/// Version of this interface: a program and a library belong together where `stribeck_version()`
/// returns it.
pub const STRIBECK_VERSION: u32 = 1;

/// The core cannot panic, and firmware has nobody to tell.
#[cfg(all(not(feature = "std"), target_os = "none"))]
#[panic_handler]
fn panicked(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
