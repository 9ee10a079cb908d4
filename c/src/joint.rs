//! What both precisions share.

use core::ffi::{CStr, c_char};
use core::mem::{align_of, size_of};
use core::slice;

use stribeck::composed::{Composed, Spec};
use stribeck::error::ModelError;
use stribeck::feedforward::{Feedforward, Limits, Source};
use stribeck::sample::Sample;
use stribeck::scalar::Scalar;

/// How a call went.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StribeckStatus {
    /// As it should.
    Ok = 0,
    /// A pointer is null.
    NullPointer = 1,
    /// The joint has not been initialised.
    NotInitialised = 2,
    /// The model names a law or an effect that is unknown, twice there or in the law already.
    UnknownModel = 3,
    /// The number of parameters is not that of the model.
    ParameterCount = 4,
    /// The model cannot be evaluated with one of the parameters.
    ParameterValue = 5,
    /// A constant is unknown or cannot have this value.
    Constant = 6,
    /// The period or a limit is not a positive number.
    Limit = 7,
}

/// Where a torque comes from.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StribeckSource {
    /// From the model.
    Law = 0,
    /// From the model, which gives more than the limit.
    Limit = 1,
    /// From the last reading that could be used.
    Last = 2,
    /// From nowhere: there is nothing to go by, the torque is 0.
    None = 3,
}

/// A constant of a model, by its name.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct StribeckConstant {
    /// Name, as in a model file.
    pub name: *const c_char,
    /// Value.
    pub value: f64,
}

/// What is read at one instant, in SI units. Channels that the model does not read: 0.
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
    /// Load torque: all at the joint that is not friction (N m or N).
    pub load_torque: S,
    /// Second derivative of the load torque by time (N m/s2 or N/s2).
    pub load_torque_curvature: S,
    /// Motor torque (N m or N).
    pub motor_torque: S,
    /// Torque of the environment on the joint, without inertia (N m or N).
    pub external_torque: S,
    /// Time since the start (s).
    pub time: S,
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
        }
    }
}

/// What a joint is made from. Pointers are read by the function that makes a joint alone.
#[repr(C)]
pub struct StribeckSettings<S> {
    /// Law and effects, as in a model file: `"lugre+load"`.
    pub model: *const c_char,
    /// Parameters in the order of the model file.
    pub parameters: *const S,
    /// How many parameters.
    pub parameter_count: usize,
    /// Constants that are not the usual ones; may be null.
    pub constants: *const StribeckConstant,
    /// How many constants.
    pub constant_count: usize,
    /// Sample period (s).
    pub period: S,
    /// Largest torque that is given (N m or N).
    pub torque_limit: S,
    /// Largest speed that the joint can have: a reading beyond it is not believed.
    pub speed_limit: S,
    /// For how many samples in a row without a reading the last torque is given.
    pub held: u32,
}

pub type Joint<S> = Feedforward<Composed<S>, S>;

/// What the first word of a joint is once it has been initialised.
const INITIALISED: u64 = 0x7374_7269_6265_636b;

/// Friction of one joint with its state: room that the caller owns. Its contents may change from
/// version to version.
#[repr(C)]
pub struct StribeckJoint<const WORDS: usize> {
    tag: u64,
    words: [u64; WORDS],
}

impl<const WORDS: usize> StribeckJoint<WORDS> {
    /// Puts a joint there.
    pub fn fill<S: Scalar<Plain = S> + PartialOrd>(&mut self, joint: Joint<S>) {
        const { assert!(size_of::<Joint<S>>() <= 8 * WORDS && align_of::<Joint<S>>() <= 8) };
        // SAFETY: large enough and aligned, as has just been asserted.
        unsafe { self.words.as_mut_ptr().cast::<Joint<S>>().write(joint) };
        self.tag = INITIALISED ^ size_of::<Joint<S>>() as u64;
    }

    /// The joint, if one has been put there.
    pub fn joint<S: Scalar<Plain = S> + PartialOrd>(&mut self) -> Option<&mut Joint<S>> {
        let filled = self.tag == INITIALISED ^ size_of::<Joint<S>>() as u64;
        // SAFETY: the tag says that `fill` has put one there.
        filled.then(|| unsafe { &mut *self.words.as_mut_ptr().cast::<Joint<S>>() })
    }
}

/// Puts a joint as the settings say into its room.
///
/// # Safety
/// The pointers, those in the settings too, are null or point to as much as types and counts say;
/// strings end in 0.
pub unsafe fn init<S: Scalar<Plain = S> + PartialOrd, const WORDS: usize>(
    joint: *mut StribeckJoint<WORDS>,
    settings: *const StribeckSettings<S>,
) -> StribeckStatus {
    // SAFETY: as for this function.
    let (room, said) = unsafe { (joint.as_mut(), settings.as_ref()) };
    let (Some(room), Some(said)) = (room, said) else { return StribeckStatus::NullPointer };
    room.tag = 0;
    // SAFETY: as for this function.
    match unsafe { build(said) } {
        Ok(joint) => {
            room.fill(joint);
            StribeckStatus::Ok
        }
        Err(status) => status,
    }
}

/// A joint as the settings say.
///
/// # Safety
/// Pointers that are not null point to as many elements as the settings say, strings end in 0.
unsafe fn build<S: Scalar<Plain = S> + PartialOrd>(
    said: &StribeckSettings<S>,
) -> Result<Joint<S>, StribeckStatus> {
    // SAFETY: as for this function.
    let (mut spec, parameters, constants) = unsafe {
        (
            spec(said.model)?,
            array(said.parameters, said.parameter_count)?,
            array(said.constants, said.constant_count)?,
        )
    };
    for constant in constants {
        // SAFETY: as for this function.
        let name = unsafe { text(constant.name)? };
        spec.set_constant(name, constant.value).map_err(|error| status(&error))?;
    }
    let model = spec.with(parameters).map_err(|error| status(&error))?;
    let limits = Limits { torque: said.torque_limit, speed: said.speed_limit, held: said.held };
    Feedforward::new(model, said.period, limits).map_err(|_| StribeckStatus::Limit)
}

/// The model that a string names.
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
/// The pointers are null or point to what their types say.
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
/// The string, where there is one, ends in 0.
unsafe fn text<'a>(string: *const c_char) -> Result<&'a str, StribeckStatus> {
    if string.is_null() {
        return Err(StribeckStatus::NullPointer);
    }
    // SAFETY: as for this function.
    unsafe { CStr::from_ptr(string) }.to_str().map_err(|_| StribeckStatus::UnknownModel)
}

/// # Safety
/// Where the pointer is not null it points to so many elements.
unsafe fn array<'a, T>(first: *const T, count: usize) -> Result<&'a [T], StribeckStatus> {
    match (first.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(StribeckStatus::NullPointer),
        // SAFETY: as for this function.
        (false, _) => Ok(unsafe { slice::from_raw_parts(first, count) }),
    }
}
