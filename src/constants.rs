//! Constants of laws and effects: chosen with the recording, stored with the model, never fitted.

use crate::scalar::Real;
use crate::table::ConstantInfo;

macro_rules! constants {
    ($(#[doc = $description:literal] $field:ident [$unit:literal] = $default:expr, $test:expr;)+) => {
        /// Constants of a model; those that neither its law nor its effects use have no influence.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Constants<S> {
            $(#[doc = $description] pub $field: S,)+
        }

        /// Every constant.
        pub const CONSTANTS: &[ConstantInfo] = &[
            $(ConstantInfo {
                name: stringify!($field),
                unit: $unit,
                default: $default,
                description: $description.trim_ascii(),
            },)+
        ];

        impl Default for Constants<f64> {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }

        impl Constants<f64> {
            /// The constant with this name.
            #[must_use]
            pub fn get(&self, name: &str) -> Option<f64> {
                match name {
                    $(stringify!($field) => Some(self.$field),)+
                    _ => None,
                }
            }

            /// Sets a constant; `None` if the name is unknown, `Some(false)` if the value is
            /// inadmissible.
            pub fn set(&mut self, name: &str, value: f64) -> Option<bool> {
                match name {
                    $(stringify!($field) => {
                        let usable: fn(f64) -> bool = $test;
                        let fits = value.is_finite() && usable(value);
                        if fits {
                            self.$field = value;
                        }
                        Some(fits)
                    })+
                    _ => None,
                }
            }

            /// The same constants in another number type.
            #[inline]
            #[must_use]
            pub fn cast<S: Real>(&self) -> Constants<S> {
                Constants { $($field: S::from_f64(self.$field),)+ }
            }
        }
    };
}

constants! {
    /// Temperature at which the temperature factors are 1.
    reference_temperature ["degC"] = 25.0, |_| true;
    /// Load torque at which the load exponent has no influence.
    reference_load ["T"] = 1.0, |x| x > 0.0;
    /// Speed at which exponents of speed have no influence.
    reference_velocity ["X/s"] = 1.0, |x| x > 0.0;
    /// Position where the stroke, or a period, starts.
    position_start ["X"] = 0.0, |_| true;
    /// Length of the stroke, or of one period.
    position_length ["X"] = core::f64::consts::TAU, |x| x > 0.0;
    /// 1 if friction repeats with the length, 0 if the length is the whole stroke.
    position_periodic ["1"] = 1.0, |x| x == 0.0 || x == 1.0;
    /// Estimated period of a ripple; a fit refines it.
    ripple_period ["X"] = 1.0, |x| x > 0.0;
    /// Duration over which drift is counted: that of the recording.
    duration ["s"] = 3600.0, |x| x > 0.0;
    /// Torque at which the saturation exponent has no influence.
    reference_torque ["T"] = 1.0, |x| x > 0.0;
    /// Period of the load's oscillation on the drive train; 0 if it follows without one.
    resonance_period ["s"] = 0.0, |x| x >= 0.0;
    /// Share of critical damping of that oscillation.
    resonance_damping ["1"] = 0.1, |x| x > 0.0 && x < 1.0;
    /// Torque at which that drive train carries twice that of a linear spring; 0 if it is linear.
    resonance_hardening ["T"] = 0.0, |x| x >= 0.0;
    /// Part of the inertia of the load torque that does not oscillate: that of the motor.
    resonance_motor_inertia ["T s2/X"] = 0.0, |x| x >= 0.0;
    /// Origin of temperature of a law; outside the data if the law is singular there.
    base_temperature ["degC"] = 0.0, |_| true;
    /// Speed over which the law smooths the sign of the velocity.
    smoothing_velocity ["X/s"] = 0.01, |x| x > 0.0;
    /// Exponent of the Stribeck curve of laws that do not fit it.
    stribeck_exponent ["1"] = 1.3, |x| x > 0.0;
    /// Largest speed of the motion.
    largest_velocity ["X/s"] = 1.0, |x| x > 0.0;
    /// Largest acceleration of the motion.
    largest_acceleration ["X/s2"] = 1.0, |x| x > 0.0;
    /// Number of elements of the law.
    elements ["1"] = 4.0, |x| (1.0..=16.0).contains(&x) && x % 1.0 == 0.0;
}

impl<S: Real> Constants<S> {
    /// Number of elements of the law.
    #[inline]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn element_count(&self) -> usize {
        let mut count = 0;
        self.elements.every(|elements| {
            count = elements as usize;
            true
        });
        count
    }
}
