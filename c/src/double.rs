//! Joints in double precision.

use crate::joint::{
    StribeckJoint, StribeckSample, StribeckSettings, StribeckSource, StribeckStatus, init, next,
};

/// What is read at one instant, in double precision.
pub type StribeckSampleF64 = StribeckSample<f64>;

/// What a joint in double precision is made from.
pub type StribeckSettingsF64 = StribeckSettings<f64>;

/// A joint in double precision.
pub type StribeckJointF64 = StribeckJoint<384>;

/// Makes a joint of which nothing has been read yet.
///
/// # Safety
/// The pointers are null or point to what their types say, `parameters` and `constants` to as many
/// elements as the counts say, strings end in 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_joint_init_f64(
    joint: *mut StribeckJoint<384>,
    settings: *const StribeckSettings<f64>,
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
pub unsafe extern "C" fn stribeck_joint_next_f64(
    joint: *mut StribeckJoint<384>,
    sample: *const StribeckSample<f64>,
    torque: *mut f64,
    source: *mut StribeckSource,
) -> StribeckStatus {
    // SAFETY: as for this function.
    unsafe { next(joint, sample, torque, source) }
}
