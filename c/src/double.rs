//! Joints in double precision.

use crate::joint::{
    StribeckJoint, StribeckSample, StribeckSettings, StribeckSource, StribeckStatus, init, next,
};

/// The inputs at one instant, in double precision.
pub type StribeckSampleF64 = StribeckSample<f64>;

/// Settings of a joint in double precision.
pub type StribeckSettingsF64 = StribeckSettings<f64>;

/// A joint in double precision.
pub type StribeckJointF64 = StribeckJoint<384>;

/// Initialises a joint without readings.
///
/// # Safety
/// Every pointer is null or points to what its type says, `parameters` and `constants` to as many
/// elements as the counts say; strings end in 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_joint_init_f64(
    joint: *mut StribeckJoint<384>,
    settings: *const StribeckSettings<f64>,
) -> StribeckStatus {
    // SAFETY: as for this function.
    unsafe { init(joint, settings) }
}

/// The torque to add until the next sample. A null `sample` is a missing reading; one that is not
/// finite or too fast counts as missing. `source` may be null.
///
/// # Safety
/// Every pointer is null or points to what its type says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_joint_next_f64(
    joint: *mut StribeckJoint<384>,
    sample: *const StribeckSample<f64>,
    torque: *mut f64,
    source: *mut StribeckSource,
) -> StribeckStatus {
    // SAFETY: as for this function.
    unsafe { next(joint, sample, torque, source) }
}
