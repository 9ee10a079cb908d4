//! Tables that describe laws and effects, and the macro that generates a table and its struct.

use core::fmt;

use crate::error::ModelError;
use crate::scalar::Real;

/// A column of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Channel {
    Velocity,
    Position,
    Acceleration,
    Temperature,
    TemperatureRate,
    LoadTorque,
    LoadTorqueCurvature,
    MotorTorque,
    ExternalTorque,
    Time,
}

impl Channel {
    /// All channels.
    pub const ALL: [Self; 10] = [
        Self::Velocity,
        Self::Position,
        Self::Acceleration,
        Self::Temperature,
        Self::TemperatureRate,
        Self::LoadTorque,
        Self::LoadTorqueCurvature,
        Self::MotorTorque,
        Self::ExternalTorque,
        Self::Time,
    ];

    /// The name in recordings and commands.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Position => "position",
            Self::Acceleration => "acceleration",
            Self::Temperature => "temperature",
            Self::TemperatureRate => "temperature_rate",
            Self::LoadTorque => "load_torque",
            Self::LoadTorqueCurvature => "load_torque_curvature",
            Self::MotorTorque => "motor_torque",
            Self::ExternalTorque => "external_torque",
            Self::Time => "time",
        }
    }

    /// Unit in terms of T, X, s and degC.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Velocity => "X/s",
            Self::Position => "X",
            Self::Acceleration => "X/s2",
            Self::Temperature => "degC",
            Self::TemperatureRate => "K/s",
            Self::LoadTorque | Self::MotorTorque | Self::ExternalTorque => "T",
            Self::LoadTorqueCurvature => "T/s2",
            Self::Time => "s",
        }
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The quantity that scales bounds and start of a parameter, so that tables do not depend on units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// No scaling.
    None,
    /// Largest |velocity| of the recording.
    Speed,
    /// Largest excursion in position.
    Position,
    /// Size of the torque.
    Torque,
    /// Torque over the largest excursion in position.
    Stiffness,
    /// Torque over speed.
    Damping,
    /// Torque over speed squared.
    SquareDamping,
    /// Torque over speed cubed.
    CubicDamping,
    /// Torque over the square root of speed.
    RootDamping,
    /// One over speed.
    InverseSpeed,
    /// One over torque.
    InverseTorque,
    /// Torque over the largest |acceleration|.
    Inertia,
    /// Torque over time: the rate at which a torque settles, as torque times speed over position.
    TorqueRate,
    /// The time to reach the largest speed with the largest acceleration.
    Time,
    /// The square of `Time`.
    SquareTime,
    /// The median time step, or 1/120 s if that is shorter.
    SamplePeriod,
    /// The time from the first to the last sample of a run.
    Duration,
}

impl Scale {
    /// The name shown to users.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Speed => "speed",
            Self::Position => "position",
            Self::Torque => "torque",
            Self::Stiffness => "stiffness",
            Self::Damping => "damping",
            Self::SquareDamping => "square_damping",
            Self::CubicDamping => "cubic_damping",
            Self::RootDamping => "root_damping",
            Self::InverseSpeed => "inverse_speed",
            Self::InverseTorque => "inverse_torque",
            Self::Inertia => "inertia",
            Self::TorqueRate => "torque_rate",
            Self::Time => "time",
            Self::SquareTime => "square_time",
            Self::SamplePeriod => "sample_period",
            Self::Duration => "duration",
        }
    }
}

/// How a parameter enters the torque when all [`Role::Nonlinear`] ones are fixed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Linear in the dry magnitude; linear in the torque unless it acts through a bristle.
    Dry,
    /// Linear in the rate-dependent part (a bristle's damping too, given its state).
    Rate,
    /// Linear in the additive part.
    Additive,
    /// Nonlinear.
    Nonlinear,
    /// Fixed at its start in a fit: other parameters have its effect.
    Held,
}

impl Role {
    /// The name shown to users.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dry => "dry",
            Self::Rate => "rate",
            Self::Additive => "additive",
            Self::Nonlinear => "nonlinear",
            Self::Held => "held",
        }
    }
}

/// When a parameter is part of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// Always.
    Always,
    /// If the law or an effect has a Stribeck curve.
    WithStribeck,
    /// If the law or an effect makes dry friction depend on load.
    WithLoad,
    /// Unless the effect `offset` is present, which explains the same torque.
    WithoutOffset,
    /// If the law has at least this many elements.
    Element(u8),
    /// If a formula contains it.
    InFormula,
}

/// One parameter. Units: `T` is the unit of torque or force, `X` that of position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Physical name.
    pub name: &'static str,
    /// Symbol in the formula.
    pub symbol: &'static str,
    /// Unit in terms of T, X, s and K.
    pub unit: &'static str,
    /// Lower bound of a fit, in multiples of `scale`.
    pub lower: f64,
    /// Upper bound of a fit, in multiples of `scale`.
    pub upper: f64,
    /// Start of a fit, in multiples of `scale`.
    pub start: f64,
    /// Range of the random starts of a fit, in multiples of `scale`: the values to expect, where
    /// the bounds also admit every published value.
    pub drawn: (f64, f64),
    /// The quantity that scales bounds, start and random starts.
    pub scale: Scale,
    /// How it enters the torque.
    pub role: Role,
    /// When it is part of the model.
    pub presence: Presence,
    /// Description in one sentence.
    pub description: &'static str,
}

impl ParameterInfo {
    /// Whether a model can be evaluated at `value`. The bounds of a fit are narrower: published
    /// parameters may lie outside them (even `vs < 0`, of which only `|v/vs|` is used).
    #[must_use]
    pub fn admits(&self, value: f64) -> bool {
        value.is_finite()
            && match self.scale {
                _ if self.lower <= 0.0 => true,
                Scale::Speed => value != 0.0,
                _ => value > 0.0,
            }
    }
}

/// Checks that there is one value for each parameter, at which the model can be evaluated.
///
/// # Errors
/// A wrong number of values, or a value at which the model cannot be evaluated.
pub(crate) fn check<S: Real, I: Iterator<Item = &'static ParameterInfo>>(
    parameters: impl Fn() -> I,
    values: &[S],
) -> Result<(), ModelError<'static>> {
    let expected = parameters().count();
    if values.len() != expected {
        return Err(ModelError::Count { expected, given: values.len() });
    }
    for (parameter, value) in parameters().zip(values) {
        let mut refused = None;
        value.every(|value| {
            refused = (!parameter.admits(value)).then_some(value);
            refused.is_none()
        });
        if let Some(value) = refused {
            return Err(ModelError::Value { parameter: parameter.name, value });
        }
    }
    Ok(())
}

/// A fixed number of a law or an effect, chosen with the recording and stored with the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantInfo {
    /// Name.
    pub name: &'static str,
    /// Unit in terms of T, X, s and K.
    pub unit: &'static str,
    /// Default value.
    pub default: f64,
    /// Description in one sentence.
    pub description: &'static str,
}

/// A temperature at which a law is singular; data must lie on one side of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pole {
    /// 0 degC.
    Zero,
    /// The constant `base_temperature`.
    Base,
}

impl Pole {
    /// The name shown to users.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Zero => "zero",
            Self::Base => "base_temperature",
        }
    }
}

/// A friction law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawInfo {
    /// Id.
    pub id: &'static str,
    /// Title.
    pub title: &'static str,
    /// Paper and equation.
    pub source: &'static str,
    /// Formula in plain text.
    pub formula: &'static str,
    /// Its parameters, in the order of the source.
    pub parameters: &'static [ParameterInfo],
    /// Columns it reads besides the velocity.
    pub channels: &'static [Channel],
    /// Constants it uses.
    pub constants: &'static [&'static str],
    /// Temperature at which it is singular, if there is one.
    pub pole: Option<Pole>,
    /// Ids of the effects that it includes.
    pub captures: &'static [&'static str],
}

/// An effect that can be added to a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectInfo {
    /// Id.
    pub id: &'static str,
    /// Group of the cause: friction, measurement, actuator, rigid body, drive.
    pub group: &'static str,
    /// Title.
    pub title: &'static str,
    /// The physical cause in one sentence.
    pub what: &'static str,
    /// Formula in plain text.
    pub formula: &'static str,
    /// What a recording must contain to show it.
    pub needs: &'static str,
    /// The simpler effect that it extends: alone, it would be mistaken for that one.
    pub beyond: Option<&'static str>,
    /// Columns it reads besides the velocity.
    pub channels: &'static [Channel],
    /// Constants it uses.
    pub constants: &'static [&'static str],
    /// Its parameters.
    pub parameters: &'static [ParameterInfo],
}

/// A struct of parameters and its table, generated by `parameters!`.
pub trait Parameters<S>: Sized {
    /// One entry per field, in order.
    const TABLE: &'static [ParameterInfo];

    /// Reads the fields in order from `next`.
    fn read(next: impl FnMut(Presence) -> S) -> Self;
}

/// Generates a struct of parameters and its table: field, symbol, unit, bounds, start, scale and
/// role of each parameter; the doc comment of a field is its description. Random starts lie between
/// the bounds, or in a narrower range that is stated after `drawn`.
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        $name:ident {
            $(
                #[doc = $description:literal]
                $field:ident: $symbol:literal [$unit:literal]
                    $lower:literal .. $upper:literal, start $start:literal
                    $(drawn $least:literal .. $most:literal)?,
                    $scale:ident, $role:ident $(, $presence:ident)?;
            )+
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<S> {
            $(
                #[doc = $description]
                pub $field: S,
            )+
        }

        impl<S> $crate::table::Parameters<S> for $name<S> {
            const TABLE: &'static [$crate::table::ParameterInfo] = &[
                $($crate::table::ParameterInfo {
                    name: stringify!($field),
                    symbol: $symbol,
                    unit: $unit,
                    lower: $lower,
                    upper: $upper,
                    start: $start,
                    drawn: $crate::table::parameters!(
                        @drawn ($lower, $upper) $(($least, $most))?
                    ),
                    scale: $crate::table::Scale::$scale,
                    role: $crate::table::Role::$role,
                    presence: $crate::table::parameters!(@presence $($presence)?),
                    description: $description.trim_ascii(),
                },)+
            ];

            #[inline]
            fn read(mut next: impl FnMut($crate::table::Presence) -> S) -> Self {
                Self {
                    $($field: next($crate::table::parameters!(@presence $($presence)?)),)+
                }
            }
        }
    };
    (@drawn $bounds:tt) => { $bounds };
    (@drawn $bounds:tt $range:tt) => { $range };
    (@presence) => { $crate::table::Presence::Always };
    (@presence $presence:ident) => { $crate::table::Presence::$presence };
}
pub(crate) use parameters;
