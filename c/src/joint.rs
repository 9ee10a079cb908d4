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

/// What a joint is made from, whatever the precision.
pub struct Settings<S> {
    pub model: *const c_char,
    pub parameters: *const S,
    pub parameter_count: usize,
    pub constants: *const StribeckConstant,
    pub constant_count: usize,
    pub period: S,
    pub limits: Limits<S>,
}

pub type Joint<S> = Feedforward<Composed<S>, S>;

/// What the first word of a joint is once it has been initialised.
const INITIALISED: u64 = 0x7374_7269_6265_636b;

/// Room for a joint, owned by the caller.
#[repr(C)]
pub struct Room<const WORDS: usize> {
    pub tag: u64,
    pub words: [u64; WORDS],
}

impl<const WORDS: usize> Room<WORDS> {
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

/// A joint as the settings say.
///
/// # Safety
/// Pointers that are not null point to as many elements as the settings say, strings end in 0.
pub unsafe fn build<S: Scalar<Plain = S> + PartialOrd>(
    settings: &Settings<S>,
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
    Feedforward::new(model, settings.period, settings.limits).map_err(|_| StribeckStatus::Limit)
}

/// The model that a string names.
///
/// # Safety
/// The string ends in 0.
pub unsafe fn spec(model: *const c_char) -> Result<Spec, StribeckStatus> {
    // SAFETY: as for this function.
    Spec::parse(unsafe { text(model)? }).map_err(|error| status(&error))
}

/// One step, for all that may be wrong with pointers.
pub fn next<S: Scalar<Plain = S> + PartialOrd, const WORDS: usize>(
    room: Option<&mut Room<WORDS>>,
    sample: Option<Sample<S>>,
    torque: Option<&mut S>,
    source: Option<&mut StribeckSource>,
) -> StribeckStatus {
    let (Some(room), Some(torque)) = (room, torque) else { return StribeckStatus::NullPointer };
    let Some(joint) = room.joint::<S>() else { return StribeckStatus::NotInitialised };
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
