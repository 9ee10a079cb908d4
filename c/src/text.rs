//! Version, messages, and what a model expects.

use core::ffi::{CStr, c_char};

use crate::STRIBECK_VERSION;
use crate::joint::{StribeckStatus, spec};

/// The version that the library has.
#[unsafe(no_mangle)]
pub extern "C" fn stribeck_version() -> u32 {
    STRIBECK_VERSION
}

/// How many parameters a model has.
///
/// # Safety
/// The pointers are null or point to what their types say; the string ends in 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_parameter_count(
    model: *const c_char,
    count: *mut usize,
) -> StribeckStatus {
    // SAFETY: as for this function.
    let Some(count) = (unsafe { count.as_mut() }) else { return StribeckStatus::NullPointer };
    // SAFETY: as for this function.
    match unsafe { spec(model) } {
        Ok(spec) => {
            *count = spec.parameter_count();
            StribeckStatus::Ok
        }
        Err(status) => status,
    }
}

/// What each status means, in its order.
const MESSAGES: [&CStr; 8] = [
    c"done",
    c"a pointer is null",
    c"the joint has not been initialised",
    c"the model names a law or effect that is unknown, twice there or in the law already",
    c"the number of parameters is not that of the model",
    c"the model cannot be evaluated with a parameter",
    c"a constant is unknown or cannot have this value",
    c"the period or a limit is not a positive number",
];

/// What a status means, in English. Any number may be given: C does not check what is in an enum.
#[unsafe(no_mangle)]
pub extern "C" fn stribeck_message(status: i32) -> *const c_char {
    let known = usize::try_from(status).ok().and_then(|status| MESSAGES.get(status));
    known.copied().unwrap_or(c"not a status of this version").as_ptr()
}
