//! Units of measured quantities: what files and users spell, and the factor to SI.
//!
//! The tables of laws and effects spell units by `T` (torque or force), `X` (position), `s` and `K`,
//! because a model of a revolute joint and one of a prismatic joint share them.

use core::f64::consts::{PI, TAU};

/// A physical dimension of what a sensor measures.
pub struct Dimension {
    /// Name that users read.
    pub name: &'static str,
    /// SI unit; temperatures are in degC.
    pub si: &'static str,
    /// Unit in terms of T, X, s and K; `None` where the tables have no such quantity.
    pub unit: Option<&'static str>,
}

/// A unit: SI value = `factor` times the value + `offset`.
pub struct Unit {
    /// Name of its dimension.
    pub dimension: &'static str,
    /// Every spelling, separated by spaces; the first is the one that users read.
    pub spellings: &'static str,
    /// Factor to SI.
    pub factor: f64,
    /// Offset to SI.
    pub offset: f64,
}

const fn dimension(name: &'static str, si: &'static str, unit: Option<&'static str>) -> Dimension {
    Dimension { name, si, unit }
}

const fn unit(dimension: &'static str, spellings: &'static str, factor: f64) -> Unit {
    Unit { dimension, spellings, factor, offset: 0.0 }
}

/// Every dimension.
pub const DIMENSIONS: &[Dimension] = &[
    dimension("time", "s", Some("s")),
    dimension("angle", "rad", Some("X")),
    dimension("length", "m", Some("X")),
    dimension("angular velocity", "rad/s", Some("X/s")),
    dimension("linear velocity", "m/s", Some("X/s")),
    dimension("angular acceleration", "rad/s2", Some("X/s2")),
    dimension("linear acceleration", "m/s2", Some("X/s2")),
    dimension("torque", "N m", Some("T")),
    dimension("force", "N", Some("T")),
    dimension("temperature", "degC", Some("K")),
    dimension("current", "A", None),
    dimension("voltage", "V", None),
    dimension("percent", "%", None),
    dimension("number", "1", Some("1")),
];

const DEGREE: f64 = PI / 180.0;
const PER_MINUTE: f64 = TAU / 60.0;

/// Every unit, those of one dimension together.
pub const UNITS: &[Unit] = &[
    unit("time", "s sec second seconds", 1.0),
    unit("time", "ms msec millisecond milliseconds", 1e-3),
    unit("time", "us usec µs microseconds", 1e-6),
    unit("time", "ns nsec nanoseconds", 1e-9),
    unit("time", "min", 60.0),
    unit("time", "h hour hours", 3600.0),
    unit("angle", "rad radian radians", 1.0),
    unit("angle", "mrad", 1e-3),
    unit("angle", "deg ° degree degrees", DEGREE),
    unit("angle", "rev turn turns revolutions", TAU),
    unit("length", "m meter metre meters metres", 1.0),
    unit("length", "cm", 1e-2),
    unit("length", "mm", 1e-3),
    unit("length", "um µm", 1e-6),
    unit("length", "in inch", 0.0254),
    unit("angular velocity", "rad/s radps rads rad_per_s radpersec", 1.0),
    unit("angular velocity", "mrad/s mradps", 1e-3),
    unit("angular velocity", "deg/s degps dps °/s deg_per_s", DEGREE),
    unit("angular velocity", "rpm rev/min r/min 1/min", PER_MINUTE),
    unit("angular velocity", "rev/s revps rps turn/s", TAU),
    unit("linear velocity", "m/s mps m_per_s", 1.0),
    unit("linear velocity", "cm/s cmps", 1e-2),
    unit("linear velocity", "mm/s mmps mm_per_s", 1e-3),
    unit("linear velocity", "um/s umps µm/s", 1e-6),
    unit("linear velocity", "m/min", 1.0 / 60.0),
    unit("linear velocity", "mm/min mmpmin", 1e-3 / 60.0),
    unit("angular acceleration", "rad/s2 radps2 rads2 rad_per_s2", 1.0),
    unit("angular acceleration", "deg/s2 degps2 deg_per_s2 °/s2", DEGREE),
    unit("angular acceleration", "rpm/s rpmps", PER_MINUTE),
    unit("linear acceleration", "m/s2 mps2 m_per_s2", 1.0),
    unit("linear acceleration", "mm/s2 mmps2 mm_per_s2", 1e-3),
    unit("torque", "Nm N_m newtonmeter", 1.0),
    unit("torque", "mNm mN_m", 1e-3),
    unit("torque", "uNm µNm", 1e-6),
    unit("torque", "kNm", 1e3),
    unit("torque", "Ncm", 1e-2),
    unit("torque", "Nmm", 1e-3),
    unit("torque", "kgfcm kgcm", 9.806_65e-2),
    unit("torque", "kgfm kgm", 9.806_65),
    unit("torque", "ozin ozfin", 7.061_551_833_3e-3),
    unit("torque", "lbfin lbin inlb", 0.112_984_829_0),
    unit("torque", "lbfft lbft ftlb", 1.355_817_948_3),
    unit("force", "N newton", 1.0),
    unit("force", "mN", 1e-3),
    unit("force", "kN", 1e3),
    unit("force", "kgf", 9.806_65),
    unit("force", "lbf", 4.448_221_615_3),
    unit("temperature", "degC C °C celsius deg_C", 1.0),
    Unit { offset: -273.15, ..unit("temperature", "K kelvin", 1.0) },
    Unit { offset: -160.0 / 9.0, ..unit("temperature", "degF F °F fahrenheit", 5.0 / 9.0) },
    unit("current", "A amp amps ampere", 1.0),
    unit("current", "mA", 1e-3),
    unit("voltage", "V volt volts", 1.0),
    unit("voltage", "mV", 1e-3),
    unit("percent", "% pct percent", 1.0),
    unit("percent", "permille ‰", 0.1),
    unit("number", "1 none", 1.0),
];

/// Powers of T, X, s and K in a unit such as `T s2/X2`; `None` where a power is not a whole number.
///
/// A degree Celsius counts as a kelvin.
pub fn powers(unit: &str) -> Option<[i8; 4]> {
    let mut powers = [0; 4];
    for (place, factors) in unit.split('/').enumerate() {
        let sign = if place == 0 { 1 } else { -1 };
        for factor in factors.split(' ').filter(|&factor| factor != "1") {
            let digits = factor.trim_start_matches(|c: char| c.is_ascii_alphabetic());
            let base = factor.strip_suffix(digits)?;
            let base = ["T", "X", "s", if base == "degC" { "degC" } else { "K" }]
                .iter()
                .position(|&known| known == base)?;
            let power: i8 = if digits.is_empty() { 1 } else { digits.parse().ok()? };
            powers[base] += sign * power;
        }
    }
    Some(powers)
}

#[cfg(test)]
mod tests {
    use super::{DIMENSIONS, UNITS, powers};
    use crate::catalog::{EffectId, LawId};
    use crate::table::Channel;

    #[test]
    fn powers_follow_the_spelling() {
        assert_eq!(powers("T s2/X2"), Some([1, -2, 2, 0]));
        assert_eq!(powers("X/s/K2"), Some([0, 1, -1, -2]));
        assert_eq!(powers("1/T"), Some([-1, 0, 0, 0]));
        assert_eq!(powers("1"), Some([0; 4]));
        assert_eq!(powers("degC"), powers("K"));
        assert_eq!(powers("T (s/X)^(1/2)"), None);
        assert_eq!(powers("N m"), None);
    }

    #[test]
    fn every_unit_of_the_catalog_has_powers_unless_they_are_broken() {
        let laws = LawId::ALL.iter().flat_map(|law| law.info().parameters);
        let effects = EffectId::ALL.iter().flat_map(|effect| effect.info().parameters);
        for parameter in laws.chain(effects) {
            let broken = parameter.unit.contains('(');
            assert_eq!(powers(parameter.unit).is_none(), broken, "{}", parameter.unit);
        }
        assert!(Channel::ALL.iter().all(|channel| powers(channel.unit()).is_some()));
    }

    #[test]
    fn every_unit_has_a_dimension_and_every_dimension_its_si_unit() {
        for unit in UNITS {
            assert!(DIMENSIONS.iter().any(|d| d.name == unit.dimension), "{}", unit.spellings);
        }
        for dimension in DIMENSIONS {
            let first = UNITS.iter().find(|unit| unit.dimension == dimension.name);
            let first = first.expect("a unit of each dimension");
            let si: std::string::String = dimension.si.split(' ').collect();
            assert_eq!(first.spellings.split(' ').next(), Some(si.as_str()));
            assert!(first.factor == 1.0 && first.offset == 0.0, "{}", dimension.name);
            assert!(dimension.unit.is_none_or(|unit| powers(unit).is_some()));
        }
    }
}
