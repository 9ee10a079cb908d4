//! Joints in single precision.

use crate::joint::{
    StribeckJoint, StribeckSample, StribeckSettings, StribeckSource, StribeckStatus, init, next,
};

/// What is read at one instant, in single precision.
pub type StribeckSampleF32 = StribeckSample<f32>;

/// What a joint in single precision is made from.
pub type StribeckSettingsF32 = StribeckSettings<f32>;

/// A joint in single precision.
pub type StribeckJointF32 = StribeckJoint<256>;

/// Makes a joint of which nothing has been read yet.
///
/// # Safety
/// The pointers are null or point to what their types say, `parameters` and `constants` to as many
/// elements as the counts say, strings end in 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_joint_init_f32(
    joint: *mut StribeckJoint<256>,
    settings: *const StribeckSettings<f32>,
) -> StribeckStatus {
    // SAFETY: as for this function.
    unsafe { init(joint, settings) }
}

/// The torque to add until the next sample. A null `sample` is a reading that has not come; one that
/// is not finite, or too fast, counts as that. `source` may be null.
///
/// # Safety
/// The pointers are null or point to what their types say.
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
