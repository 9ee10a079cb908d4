//! Joints in single precision.

use core::ffi::c_char;

use stribeck::feedforward::Limits;
use stribeck::sample::Sample;

use crate::joint::{Room, Settings, StribeckConstant, StribeckSource, StribeckStatus, build, next};

/// Words that a joint takes at most.
const WORDS: usize = 256;

/// What is read at one instant, in SI units. Channels that the model does not read: 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StribeckSampleF32 {
    /// Velocity (rad/s or m/s).
    pub velocity: f32,
    /// Position (rad or m).
    pub position: f32,
    /// Acceleration (rad/s2 or m/s2).
    pub acceleration: f32,
    /// Joint temperature (degC).
    pub temperature: f32,
    /// Load torque: all at the joint that is not friction (N m or N).
    pub load_torque: f32,
    /// Second derivative of the load torque by time (N m/s2 or N/s2).
    pub load_torque_curvature: f32,
    /// Motor torque (N m or N).
    pub motor_torque: f32,
    /// Torque of the environment on the joint, without inertia (N m or N).
    pub external_torque: f32,
    /// Time since the start (s).
    pub time: f32,
}

/// What a joint is made from. Pointers are read by `stribeck_joint_init_f32` alone.
#[repr(C)]
pub struct StribeckSettingsF32 {
    /// Law and effects, as in a model file: `"lugre+load"`.
    pub model: *const c_char,
    /// Parameters in the order of the model file.
    pub parameters: *const f32,
    /// How many parameters.
    pub parameter_count: usize,
    /// Constants that are not the usual ones; may be null.
    pub constants: *const StribeckConstant,
    /// How many constants.
    pub constant_count: usize,
    /// Sample period (s).
    pub period: f32,
    /// Largest torque that is given (N m or N).
    pub torque_limit: f32,
    /// Largest speed that the joint can have: a reading beyond it is not believed.
    pub speed_limit: f32,
    /// For how many samples in a row without a reading the last torque is given.
    pub held: u32,
}

/// Friction of one joint with its state: room that the caller owns. Its contents may change from
/// version to version.
#[repr(C)]
pub struct StribeckJointF32 {
    tag: u64,
    words: [u64; 256],
}

/// Makes a joint of which nothing has been read yet.
///
/// # Safety
/// The pointers are null or point to what their types say, `parameters` and `constants` to as many
/// elements as the counts say, strings end in 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_joint_init_f32(
    joint: *mut StribeckJointF32,
    settings: *const StribeckSettingsF32,
) -> StribeckStatus {
    // SAFETY: both have the same layout; as for this function.
    let (room, said) = unsafe { (joint.cast::<Room<WORDS>>().as_mut(), settings.as_ref()) };
    let (Some(room), Some(said)) = (room, said) else { return StribeckStatus::NullPointer };
    room.tag = 0;
    let settings = Settings {
        model: said.model,
        parameters: said.parameters,
        parameter_count: said.parameter_count,
        constants: said.constants,
        constant_count: said.constant_count,
        period: said.period,
        limits: Limits { torque: said.torque_limit, speed: said.speed_limit, held: said.held },
    };
    // SAFETY: as for this function.
    match unsafe { build(&settings) } {
        Ok(joint) => {
            room.fill(joint);
            StribeckStatus::Ok
        }
        Err(status) => status,
    }
}

/// The torque to add until the next sample. A null `sample` is a reading that has not come; one that
/// is not finite, or too fast, counts as that. `source` may be null.
///
/// # Safety
/// The pointers are null or point to what their types say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stribeck_joint_next_f32(
    joint: *mut StribeckJointF32,
    sample: *const StribeckSampleF32,
    torque: *mut f32,
    source: *mut StribeckSource,
) -> StribeckStatus {
    // SAFETY: both have the same layout; as for this function.
    let (room, sample) = unsafe { (joint.cast::<Room<WORDS>>().as_mut(), sample.as_ref()) };
    // SAFETY: as for this function.
    let (torque, source) = unsafe { (torque.as_mut(), source.as_mut()) };
    let sample = sample.map(|read| Sample {
        velocity: read.velocity,
        position: read.position,
        acceleration: read.acceleration,
        temperature: read.temperature,
        load_torque: read.load_torque,
        load_torque_curvature: read.load_torque_curvature,
        motor_torque: read.motor_torque,
        external_torque: read.external_torque,
        time: read.time,
    });
    next(room, sample, torque, source)
}
