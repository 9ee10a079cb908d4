//! Joints in single precision.

use crate::joint::{
    StribeckJoint, StribeckSample, StribeckSettings, StribeckSource, StribeckStatus, init, next,
};

/// The inputs at one instant, in single precision.
pub type StribeckSampleF32 = StribeckSample<f32>;

/// Settings of a joint in single precision.
pub type StribeckSettingsF32 = StribeckSettings<f32>;

/// A joint in single precision.
pub type StribeckJointF32 = StribeckJoint<256>;

/// Initialises a joint without readings.
///
/// # Safety
/// Every pointer is null or points to what its type says, `parameters` and `constants` to as many
/// elements as the counts say; strings end in 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_joint_init_f32(
    joint: *mut StribeckJoint<256>,
    settings: *const StribeckSettings<f32>,
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
pub unsafe extern "C" fn stribeck_joint_next_f32(
    joint: *mut StribeckJoint<256>,
    sample: *const StribeckSample<f32>,
    torque: *mut f32,
    source: *mut StribeckSource,
) -> StribeckStatus {
    // SAFETY: as for this function.
    unsafe { next(joint, sample, torque, source) }
}
