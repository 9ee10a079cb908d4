//! Types and functions generic over the precision.

use core::ffi::{CStr, c_char};
use core::mem::{align_of, size_of};
use core::slice;

use stribeck::prelude::*;

/// The result of a call.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StribeckStatus {
    /// Success.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// The joint has not been initialised.
    NotInitialised = 2,
    /// The model contains an unknown law or effect, or an effect that is named twice or part of the
    /// law.
    UnknownModel = 3,
    /// The number of parameters is not that of the model.
    ParameterCount = 4,
    /// The model cannot be evaluated with one of the parameters.
    ParameterValue = 5,
    /// A constant is unknown, or its value is inadmissible.
    Constant = 6,
    /// The period or a limit is not a positive number.
    Limit = 7,
}

/// The origin of a torque.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StribeckSource {
    /// The model.
    Law = 0,
    /// The model, limited.
    Limit = 1,
    /// The last valid reading.
    Last = 2,
    /// None: no valid reading is recent enough; the torque is 0.
    None = 3,
}

/// A constant of a model.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StribeckConstant {
    /// Name, as in a model file.
    pub name: *const c_char,
    /// Value.
    pub value: f64,
}

/// The inputs at one instant, in SI units. Channels that the model does not read are 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StribeckSample<S> {
    /// Velocity (rad/s or m/s).
    pub velocity: S,
    /// Position (rad or m).
    pub position: S,
    /// Acceleration (rad/s2 or m/s2).
    pub acceleration: S,
    /// Joint temperature (degC).
    pub temperature: S,
    /// Load torque: all torque at the joint except friction (N m or N).
    pub load_torque: S,
    /// Second time derivative of the load torque (N m/s2 or N/s2); behind a resonance that of the
    /// torque in the spring.
    pub load_torque_curvature: S,
    /// Motor torque (N m or N).
    pub motor_torque: S,
    /// External torque of the environment on the joint, without inertia (N m or N).
    pub external_torque: S,
    /// Time since the start (s).
    pub time: S,
    /// Time derivative of the temperature (K/s).
    pub temperature_rate: S,
}

impl<S: Scalar<Plain = S>> StribeckSample<S> {
    fn read(&self) -> Sample<S> {
        Sample {
            velocity: self.velocity,
            position: self.position,
            acceleration: self.acceleration,
            temperature: self.temperature,
            load_torque: self.load_torque,
            load_torque_curvature: self.load_torque_curvature,
            motor_torque: self.motor_torque,
            external_torque: self.external_torque,
            time: self.time,
            temperature_rate: self.temperature_rate,
        }
    }
}

/// Settings of a joint. The pointers are read only by the function that initialises it.
#[repr(C)]
pub struct StribeckSettings<S> {
    /// Law and effects, as in a model file: `"lugre+load"`.
    pub model: *const c_char,
    /// Parameters in the order of the model file.
    pub parameters: *const S,
    /// Number of parameters.
    pub parameter_count: usize,
    /// Constants that differ from their defaults; may be null.
    pub constants: *const StribeckConstant,
    /// Number of constants.
    pub constant_count: usize,
    /// Sample period (s).
    pub period: S,
    /// Largest torque (N m or N).
    pub torque_limit: S,
    /// Largest speed of the joint: a reading above it is invalid.
    pub speed_limit: S,
    /// Number of consecutive missing or invalid readings for which the last torque is held.
    pub held: u32,
}

pub type Joint<S> = Feedforward<Composed<S>, S>;

/// The first word of an initialised joint.
const INITIALISED: u64 = 0x7374_7269_6265_636b;

/// Friction of one joint with its state, in memory that the caller owns. The layout may change
/// between versions.
#[repr(C)]
pub struct StribeckJoint<const WORDS: usize> {
    tag: u64,
    words: [u64; WORDS],
}

impl<const WORDS: usize> StribeckJoint<WORDS> {
    /// Writes a joint.
    pub fn fill<S: Scalar<Plain = S> + PartialOrd>(&mut self, joint: Joint<S>) {
        const { assert!(size_of::<Joint<S>>() <= 8 * WORDS && align_of::<Joint<S>>() <= 8) };
        // SAFETY: large enough and aligned, as asserted above.
        unsafe { self.words.as_mut_ptr().cast::<Joint<S>>().write(joint) };
        self.tag = INITIALISED ^ size_of::<Joint<S>>() as u64;
    }

    /// The joint, if one was written.
    pub fn joint<S: Scalar<Plain = S> + PartialOrd>(&mut self) -> Option<&mut Joint<S>> {
        let filled = self.tag == INITIALISED ^ size_of::<Joint<S>>() as u64;
        // SAFETY: the tag shows that `fill` has written a joint of this type.
        filled.then(|| unsafe { &mut *self.words.as_mut_ptr().cast::<Joint<S>>() })
    }
}

/// Initialises a joint from its settings.
///
/// # Safety
/// Every pointer, also in the settings, is null or points to as much as types and counts say;
/// strings end in 0.
pub unsafe fn init<S: Scalar<Plain = S> + PartialOrd, const WORDS: usize>(
    joint: *mut StribeckJoint<WORDS>,
    settings: *const StribeckSettings<S>,
) -> StribeckStatus {
    // SAFETY: as for this function.
    let (room, settings) = unsafe { (joint.as_mut(), settings.as_ref()) };
    let (Some(room), Some(settings)) = (room, settings) else { return StribeckStatus::NullPointer };
    room.tag = 0;
    // SAFETY: as for this function.
    match unsafe { build(settings) } {
        Ok(joint) => {
            room.fill(joint);
            StribeckStatus::Ok
        }
        Err(status) => status,
    }
}

/// A joint from its settings.
///
/// # Safety
/// Pointers that are not null point to as many elements as the settings say; strings end in 0.
unsafe fn build<S: Scalar<Plain = S> + PartialOrd>(
    settings: &StribeckSettings<S>,
) -> Result<Joint<S>, StribeckStatus> {
    // SAFETY: as for this function.
    let (mut spec, parameters, constants) = unsafe {
        (
            spec(settings.model)?,
            array(settings.parameters, settings.parameter_count)?,
            array(settings.constants, settings.constant_count)?,
        )
    };
    for constant in constants {
        // SAFETY: as for this function.
        let name = unsafe { text(constant.name)? };
        spec.set_constant(name, constant.value).map_err(|error| status(&error))?;
    }
    let model = spec.with(parameters).map_err(|error| status(&error))?;
    let limits =
        Limits { torque: settings.torque_limit, speed: settings.speed_limit, held: settings.held };
    Feedforward::new(model, settings.period, limits).map_err(|_| StribeckStatus::Limit)
}

/// The model with this name.
///
/// # Safety
/// The string ends in 0.
pub unsafe fn spec(model: *const c_char) -> Result<Spec, StribeckStatus> {
    // SAFETY: as for this function.
    Spec::parse(unsafe { text(model)? }).map_err(|error| status(&error))
}

/// One step.
///
/// # Safety
/// Every pointer is null or points to what its type says.
pub unsafe fn next<S: Scalar<Plain = S> + PartialOrd, const WORDS: usize>(
    joint: *mut StribeckJoint<WORDS>,
    sample: *const StribeckSample<S>,
    torque: *mut S,
    source: *mut StribeckSource,
) -> StribeckStatus {
    // SAFETY: as for this function.
    let (room, sample) = unsafe { (joint.as_mut(), sample.as_ref()) };
    // SAFETY: as for this function.
    let (torque, source) = unsafe { (torque.as_mut(), source.as_mut()) };
    let (Some(room), Some(torque)) = (room, torque) else { return StribeckStatus::NullPointer };
    let Some(joint) = room.joint::<S>() else { return StribeckStatus::NotInitialised };
    let sample = sample.map(StribeckSample::read);
    let feed = joint.next(sample.as_ref());
    *torque = feed.torque;
    if let Some(source) = source {
        *source = match feed.source {
            Source::Law => StribeckSource::Law,
            Source::Limit => StribeckSource::Limit,
            Source::Last => StribeckSource::Last,
            Source::None => StribeckSource::None,
        };
    }
    StribeckStatus::Ok
}

fn status(error: &ModelError<'_>) -> StribeckStatus {
    match error {
        ModelError::Count { .. } => StribeckStatus::ParameterCount,
        ModelError::Value { .. } => StribeckStatus::ParameterValue,
        ModelError::UnknownConstant(_) | ModelError::Constant(..) => StribeckStatus::Constant,
        _ => StribeckStatus::UnknownModel,
    }
}

/// # Safety
/// The string is null or ends in 0.
unsafe fn text<'a>(string: *const c_char) -> Result<&'a str, StribeckStatus> {
    if string.is_null() {
        return Err(StribeckStatus::NullPointer);
    }
    // SAFETY: as for this function.
    unsafe { CStr::from_ptr(string) }.to_str().map_err(|_| StribeckStatus::UnknownModel)
}

/// # Safety
/// The pointer is null or points to `count` elements.
unsafe fn array<'a, T>(first: *const T, count: usize) -> Result<&'a [T], StribeckStatus> {
    match (first.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(StribeckStatus::NullPointer),
        // SAFETY: as for this function.
        (false, _) => Ok(unsafe { slice::from_raw_parts(first, count) }),
    }
}
