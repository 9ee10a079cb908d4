//! Statuses and messages for invalid pointers and settings.

use core::ptr::{null, null_mut};
use std::ffi::CStr;

use stribeck::Spec;
use stribeck_c::{
    STRIBECK_VERSION, StribeckConstant, StribeckJointF64, StribeckSampleF64, StribeckSettingsF64,
    StribeckStatus, stribeck_joint_init_f64, stribeck_joint_next_f64, stribeck_message,
    stribeck_parameter_count, stribeck_version,
};

const PARAMETERS: [f64; 2] = [1.5, 2.0];

fn settings(model: &'static CStr) -> StribeckSettingsF64 {
    StribeckSettingsF64 {
        model: model.as_ptr(),
        parameters: PARAMETERS.as_ptr(),
        parameter_count: PARAMETERS.len(),
        constants: null(),
        constant_count: 0,
        period: 1e-3,
        torque_limit: 10.0,
        speed_limit: 5.0,
        held: 0,
    }
}

fn init(settings: &StribeckSettingsF64) -> StribeckStatus {
    let mut joint = empty();
    // SAFETY: both pointers are valid.
    unsafe { stribeck_joint_init_f64(&raw mut joint, settings) }
}

/// A joint of zeros, as C initialises one.
fn empty() -> StribeckJointF64 {
    // SAFETY: consists of integers.
    unsafe { core::mem::zeroed() }
}

#[test]
fn invalid_settings_are_reported() {
    let with = |change: &dyn Fn(&mut StribeckSettingsF64)| {
        let mut settings = settings(c"coulomb");
        change(&mut settings);
        init(&settings)
    };
    assert_eq!(with(&|_| ()), StribeckStatus::Ok);
    assert_eq!(with(&|s| s.model = c"colomb".as_ptr()), StribeckStatus::UnknownModel);
    assert_eq!(with(&|s| s.model = c"coulomb+viscous".as_ptr()), StribeckStatus::UnknownModel);
    assert_eq!(with(&|s| s.model = c"\xff".as_ptr()), StribeckStatus::UnknownModel);
    assert_eq!(with(&|s| s.model = null()), StribeckStatus::NullPointer);
    assert_eq!(with(&|s| s.parameters = null()), StribeckStatus::NullPointer);
    assert_eq!(with(&|s| s.parameter_count = 1), StribeckStatus::ParameterCount);
    assert_eq!(with(&|s| s.parameters = [f64::NAN; 2].as_ptr()), StribeckStatus::ParameterValue);
    assert_eq!(with(&|s| s.constant_count = 1), StribeckStatus::NullPointer);
    assert_eq!(with(&|s| s.period = 0.0), StribeckStatus::Limit);
    assert_eq!(with(&|s| s.torque_limit = f64::NAN), StribeckStatus::Limit);
    let unknown = [StribeckConstant { name: c"pi".as_ptr(), value: 3.0 }];
    let constants = |s: &mut StribeckSettingsF64| {
        (s.constants, s.constant_count) = (unknown.as_ptr(), unknown.len());
    };
    assert_eq!(with(&constants), StribeckStatus::Constant);
}

#[test]
fn an_uninitialised_joint_is_refused() {
    let (mut joint, mut torque) = (empty(), 7.0);
    let sample = StribeckSampleF64 {
        velocity: -1.0,
        position: 0.0,
        acceleration: 0.0,
        temperature: 0.0,
        load_torque: 0.0,
        load_torque_curvature: 0.0,
        temperature_rate: 0.0,
        motor_torque: 0.0,
        external_torque: 0.0,
        time: 0.0,
    };
    let mut next = |joint: *mut StribeckJointF64| {
        // SAFETY: pointers that are not null are valid.
        let status =
            unsafe { stribeck_joint_next_f64(joint, &sample, &raw mut torque, null_mut()) };
        (status, torque)
    };
    assert_eq!(next(null_mut()), (StribeckStatus::NullPointer, 7.0));
    assert_eq!(next(&raw mut joint), (StribeckStatus::NotInitialised, 7.0));
    // SAFETY: both pointers are valid.
    let made = unsafe { stribeck_joint_init_f64(&raw mut joint, &settings(c"coulomb")) };
    assert_eq!(made, StribeckStatus::Ok);
    assert_eq!(next(&raw mut joint), (StribeckStatus::Ok, -3.5));
}

#[test]
fn version_messages_and_counts() {
    assert_eq!(stribeck_version(), STRIBECK_VERSION);
    // SAFETY: messages end in 0.
    let message = |status| unsafe { CStr::from_ptr(stribeck_message(status)) };
    assert_eq!(
        message(StribeckStatus::Limit as i32),
        c"the period or a limit is not a positive number"
    );
    assert_eq!(message(-1), message(8));
    let mut count = 0;
    // SAFETY: both pointers are valid.
    let status = unsafe { stribeck_parameter_count(c"lugre+load".as_ptr(), &raw mut count) };
    let expected = Spec::new("lugre", ["load"]).expect("a model").parameter_count();
    assert_eq!((status, count), (StribeckStatus::Ok, expected));
}
