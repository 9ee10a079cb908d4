//! Version, messages, and the number of parameters of a model.

use core::ffi::{CStr, c_char};

use crate::STRIBECK_VERSION;
use crate::joint::{StribeckStatus, spec};

/// The version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn stribeck_version() -> u32 {
    STRIBECK_VERSION
}

/// Number of parameters of a model.
///
/// # Safety
/// Every pointer is null or points to what its type says; the string ends in 0.
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

/// The message of each status, in order.
const MESSAGES: [&CStr; 8] = [
    c"done",
    c"a pointer is null",
    c"the joint has not been initialised",
    c"the model contains an unknown law or effect, or an effect twice",
    c"the number of parameters is not that of the model",
    c"the model cannot be evaluated with a parameter",
    c"a constant is unknown or its value is inadmissible",
    c"the period or a limit is not a positive number",
];

/// The message of a status. Any number may be passed: C does not check the values of an enum.
#[unsafe(no_mangle)]
pub extern "C" fn stribeck_message(status: i32) -> *const c_char {
    let known = usize::try_from(status).ok().and_then(|status| MESSAGES.get(status));
    known.copied().unwrap_or(c"not a status of this version").as_ptr()
}
