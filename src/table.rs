//! The tables that describe laws and effects, and the macro that ties a table to a struct.

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
    LoadTorque,
    LoadTorqueCurvature,
    MotorTorque,
    ExternalTorque,
    Time,
}

impl Channel {
    /// Every channel.
    pub const ALL: [Self; 9] = [
        Self::Velocity,
        Self::Position,
        Self::Acceleration,
        Self::Temperature,
        Self::LoadTorque,
        Self::LoadTorqueCurvature,
        Self::MotorTorque,
        Self::ExternalTorque,
        Self::Time,
    ];

    /// The name users write.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Position => "position",
            Self::Acceleration => "acceleration",
            Self::Temperature => "temperature",
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

/// What bounds and start of a parameter are multiples of, so that no table depends on units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// As it stands.
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
    /// Torque over time: how fast a torque settles, in units of torque times speed over position.
    TorqueRate,
    /// The time in which the largest acceleration yields the largest speed.
    Time,
    /// Its square.
    SquareTime,
    /// The median time step.
    SamplePeriod,
}

impl Scale {
    /// The name users read.
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
        }
    }
}

/// How a parameter enters the torque when all [`Role::Nonlinear`] ones are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Linear in the dry magnitude; linear in the torque unless a bristle stands between.
    Dry,
    /// Linear in the rate-dependent part (a bristle's damping too, given its state).
    Rate,
    /// Linear in the additive part.
    Additive,
    /// Anything else.
    Nonlinear,
    /// Kept at its start in a fit: other parameters carry what it does.
    Held,
}

impl Role {
    /// The name users read.
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

/// When a parameter of an effect is part of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// Always.
    Always,
    /// If law or effects have a Stribeck curve.
    WithStribeck,
    /// If law or effects make dry friction depend on the load.
    WithLoad,
    /// Unless `offset` already explains it.
    WithoutOffset,
    /// If the law has at least this many elements.
    Element(u8),
    /// If a formula mentions it.
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
    /// What the bounds are multiples of.
    pub scale: Scale,
    /// How it enters the torque.
    pub role: Role,
    /// When it is part of the model.
    pub presence: Presence,
    /// One sentence.
    pub description: &'static str,
}

impl ParameterInfo {
    /// Whether a formula can be evaluated at `value`. Bounds of a fit are narrower: published
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

/// Whether there is one value for each parameter, at which a formula can be evaluated.
///
/// # Errors
/// A wrong number of values, or a value at which a formula cannot be evaluated.
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

/// A fixed number of an effect, chosen with the recording and kept with the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantInfo {
    /// Name.
    pub name: &'static str,
    /// Unit in terms of T, X, s and K.
    pub unit: &'static str,
    /// Value where none is given.
    pub default: f64,
    /// One sentence.
    pub description: &'static str,
}

/// A temperature at which a law has no limit; it can be used on either side of it alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pole {
    /// 0 degC.
    Zero,
    /// The constant `base_temperature`.
    Base,
}

impl Pole {
    /// The name users read.
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
    /// Id users write.
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
    /// Temperature at which it has no limit, if there is one.
    pub pole: Option<Pole>,
    /// Ids of the effects it has by itself.
    pub captures: &'static [&'static str],
}

/// An effect that can be added to a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectInfo {
    /// Id users write.
    pub id: &'static str,
    /// Where the cause lies: friction, measurement, actuator, rigid body, drive.
    pub group: &'static str,
    /// Title.
    pub title: &'static str,
    /// The physical cause, in one plain sentence.
    pub what: &'static str,
    /// Formula in plain text.
    pub formula: &'static str,
    /// What a recording must contain to show it.
    pub needs: &'static str,
    /// The simpler effect it contains: by itself it would be taken for that one.
    pub beyond: Option<&'static str>,
    /// Columns it reads besides the velocity.
    pub channels: &'static [Channel],
    /// Constants it uses.
    pub constants: &'static [&'static str],
    /// Its parameters.
    pub parameters: &'static [ParameterInfo],
}

/// A struct of parameters and its table, which `parameters!` writes from one statement.
pub trait Parameters<S>: Sized {
    /// One row a field, in order.
    const TABLE: &'static [ParameterInfo];

    /// Fills the fields in order with what `next` yields.
    fn read(next: impl FnMut(Presence) -> S) -> Self;
}

/// States field, symbol, unit, bounds, start, scale and role of each parameter once; the doc
/// comment of a field is its description.
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        $name:ident {
            $(
                #[doc = $description:literal]
                $field:ident: $symbol:literal [$unit:literal]
                    $lower:literal .. $upper:literal, start $start:literal,
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
    (@presence) => { $crate::table::Presence::Always };
    (@presence $presence:ident) => { $crate::table::Presence::$presence };
}
pub(crate) use parameters;
