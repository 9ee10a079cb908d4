//! Whether a model can generate energy: proved over a box of operating points, not sampled.
//!
//! | module | content |
//! |---|---|
//! | `enclosure` | interval arithmetic: a law evaluated on intervals is bounded |
//! | `region` | boxes of operating points, split so that laws do not branch inside |
//! | `search` | minimum over boxes by branch and bound |
//! | `friction` | friction along the motion |
//! | `cycles` | the exact condition for a single deflection |
//! | `replay` | counterexamples, simulated with the exact step |
//! | `factor` | the largest share of friction that may be cancelled |
//! | `requirement` | conditions on the parameters, for a fit |
//! | `spread` | these conditions at points spread over the box |
//!
//! All motions within the box are covered: velocity, temperature, load ... may change at any time
//! in any way. Values of a channel below 1e-30 count as zero, speeds as rest.
//!
//! All comparisons that a proof rests on are between outward bounds (`enclosure`), or between a
//! bound and zero; the sum of two bounds has the sign of the exact sum.

mod cycles;
mod enclosure;
mod factor;
mod friction;
mod region;
mod replay;
mod requirement;
mod search;
mod spread;
#[cfg(test)]
mod tests;

pub use factor::{Factor, largest_factor};
pub use region::{Point, Side};
pub use replay::{Counterexample, Hold, work};
pub use requirement::Requirement;

use core::fmt;
use std::vec::Vec;

use crate::catalog::{EffectId, EffectSet, LawId};
use crate::composed::{Composed, Spec};
use crate::error::ModelError;
use crate::formula::{Formula, TermKind};
use crate::scalar::Real;
use crate::table::Channel;
use cycles::{Outcome, Reach};
use enclosure::Enclosure;
use friction::{Bristled, sliding};
use region::{Region, faster_than, pieces};
use search::Search;

/// Relative accuracy of a reported margin.
const TOLERANCE: f64 = 1e-3;

/// Share of the largest speed above which counterexamples are searched first: a real joint can
/// follow them.
const REALISTIC_SPEED: f64 = 1e-3;

/// A condition of passivity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Friction in steady sliding opposes the motion.
    Sliding,
    /// `0 <= s1 <= 4 D/|v|` (Tadese et al. 2021, property 1, i).
    Damping,
    /// Friction in parallel with the bristle opposes the motion (property 1, ii).
    Resistance,
    /// The model dissipates more than it stores in `f^2/(2 s0)`.
    Storage,
    /// No cycle of the deflection generates energy.
    Cycle,
    /// Elements of constant strength: springs and sliders in parallel.
    Elements,
    /// No condition is known for this kind of state.
    Unknown,
}

impl Condition {
    /// The name shown to users.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sliding => "sliding",
            Self::Damping => "damping",
            Self::Resistance => "resistance",
            Self::Storage => "storage",
            Self::Cycle => "cycle",
            Self::Elements => "elements",
            Self::Unknown => "unknown",
        }
    }
}

/// A condition and its margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// The condition.
    pub condition: Condition,
    /// Lower bound of the margin over the box (T).
    pub lower: f64,
    /// Upper bound of the least margin: that of `point` (T); `None` if not searched.
    pub upper: Option<f64>,
    /// The point of the upper bound.
    pub point: Option<Point>,
}

/// The result of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the model is passive; `None` if undecided.
    pub passive: Option<bool>,
    /// The condition that decided, or that could not be decided.
    pub condition: Condition,
    /// The margins of all conditions that were checked.
    pub margins: Vec<Margin>,
    /// A motion that generates energy.
    pub counterexample: Option<Counterexample>,
    /// The violated or undecided requirement, if it can be stated at single points.
    pub open: Option<Requirement>,
}

/// Why passivity cannot be checked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PassivityError {
    /// The model cannot be used.
    Model(ModelError<'static>),
    /// The box gives no range for a channel that the model reads.
    Missing(Channel),
    /// The range of a channel is empty, reversed or not finite.
    Range(Side),
    /// The box gives two ranges for a channel.
    Repeated(Channel),
    /// Bounds of a parameter, by its position, that are reversed or not finite.
    Bounds(usize, [f64; 2]),
    /// The law branches on more than the signs of channels.
    Branches,
    /// The box contains no motion.
    NoMotion,
    /// The box contains the pole of the law (degC).
    Pole(f64),
    /// A point and its dry friction, which is not positive there: a bristle needs a strength.
    NoBristle(Point, f64),
}

impl fmt::Display for PassivityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(error) => error.fmt(f),
            Self::Missing(channel) => write!(f, "the box gives no range for {channel}"),
            Self::Range(side) => write!(
                f,
                "the range {} to {} of {} is not two finite numbers in order",
                side.lower, side.upper, side.channel
            ),
            Self::Repeated(channel) => write!(f, "the box gives two ranges for {channel}"),
            Self::Bounds(position, [lower, upper]) => write!(
                f,
                "the bounds {lower} to {upper} of parameter {} are not two finite numbers in order",
                position + 1
            ),
            Self::Branches => f.write_str(
                "the law branches on more than the signs of channels, which interval bounds cannot \
                 follow",
            ),
            Self::NoMotion => f.write_str("the box contains no motion"),
            Self::Pole(at) => write!(f, "the box contains {at} degC, where the law is singular"),
            Self::NoBristle(point, dry) => write!(
                f,
                "a bristle needs dry friction above zero, but it is {dry:.4} at velocity {:.4}, \
                 temperature {:.4}, load torque {:.4}, position {:.4}",
                point.velocity, point.temperature, point.load_torque, point.position
            ),
        }
    }
}

impl core::error::Error for PassivityError {}

impl From<ModelError<'static>> for PassivityError {
    fn from(error: ModelError<'static>) -> Self {
        Self::Model(error)
    }
}

/// Checks whether the model is passive over the box, with at most `budget` evaluations.
///
/// The whole model counts as friction, a constant torque too: leave out effects that are not
/// friction.
///
/// # Errors
/// A model or a box that cannot be used.
pub fn check(
    spec: &Spec,
    values: &[f64],
    sides: &[Side],
    budget: usize,
) -> Result<Verdict, PassivityError> {
    let mut verdict = Task::of(spec, values, sides, budget)?.run()?;
    if verdict.passive == Some(true) {
        verdict.open = None;
    }
    Ok(verdict)
}

/// Requirements on the parameters at points spread over the box, the worst of each kind, to start a
/// constrained fit. Empty if the state of the model is more than a single deflection.
///
/// # Errors
/// A model or a box that cannot be used.
pub fn requirements(
    spec: &Spec,
    values: &[f64],
    sides: &[Side],
) -> Result<Vec<Requirement>, PassivityError> {
    let task = Task::of(spec, values, sides, 0)?;
    let bristle = task.has_bristle();
    Ok(if task.bounded.has_state() && !bristle {
        Vec::new()
    } else {
        spread::worst(&task.exact, &task.regions, &task.channels, bristle)
    })
}

/// The box of the channels that any of the models reads, in pieces.
///
/// # Errors
/// A range that is missing, empty, reversed or not finite, a box without motion, or one that
/// contains the pole of a law. An empty box would prove everything.
fn regions_of(specs: &[&Spec], sides: &[Side]) -> Result<Vec<Region>, PassivityError> {
    for spec in specs {
        for channel in spec.channels() {
            let side = sides.iter().find(|side| side.channel == channel);
            let side = side.ok_or(PassivityError::Missing(channel))?;
            if let (Channel::Temperature, Some(pole)) = (channel, spec.pole())
                && (side.lower..=side.upper).contains(&pole)
            {
                return Err(PassivityError::Pole(pole));
            }
        }
    }
    for (number, &side) in sides.iter().enumerate() {
        if !(side.lower.is_finite() && side.upper.is_finite() && side.lower <= side.upper) {
            return Err(PassivityError::Range(side));
        }
        if sides[..number].iter().any(|earlier| earlier.channel == side.channel) {
            return Err(PassivityError::Repeated(side.channel));
        }
    }
    let is_read =
        |side: &&Side| specs.iter().any(|spec| spec.channels().any(|c| c == side.channel));
    let read: Vec<_> = sides.iter().filter(is_read).copied().collect();
    let regions = pieces(&read);
    if regions.is_empty() { Err(PassivityError::NoMotion) } else { Ok(regions) }
}

/// Whether a law branches on more than the signs of channels, which intervals cannot follow.
fn branches(spec: &Spec) -> bool {
    let smoothed = |own: &Formula| own.terms().any(|term| term.kind == TermKind::Smoothed);
    let formula = |own: &Formula| own.compares() || (spec.has_state() && smoothed(own));
    spec.law() == LawId::BamM6 || spec.formula().is_some_and(formula)
}

struct Task<'a> {
    spec: &'a Spec,
    bounded: Composed<Enclosure>,
    exact: Composed<f64>,
    channels: Vec<Channel>,
    regions: Vec<Region>,
    budget: usize,
}

impl<'a> Task<'a> {
    fn of(
        spec: &'a Spec,
        values: &[f64],
        sides: &[Side],
        budget: usize,
    ) -> Result<Self, PassivityError> {
        let numbers: Vec<_> = values.iter().map(|&x| Enclosure::point(x)).collect();
        let (bounded, exact) = (spec.with(&numbers)?, spec.with(values)?);
        let channels: Vec<_> = spec.channels().collect();
        let regions = regions_of(&[spec], sides)?;
        Ok(Self { spec, bounded, exact, channels, regions, budget })
    }

    /// Whether the state is a single deflection.
    fn has_bristle(&self) -> bool {
        self.bounded.has_state()
            && !self.lags()
            && self.regions.first().is_some_and(|region| self.bounded.deflection(region).is_some())
    }

    fn run(&self) -> Result<Verdict, PassivityError> {
        let bristle = self.has_bristle();
        if bristle {
            self.check_strength()?;
        }
        let slides = self.least(Condition::Sliding, |region| sliding(&self.bounded, region));
        let mut verdict = Verdict {
            passive: None,
            condition: Condition::Sliding,
            margins: [slides].to_vec(),
            counterexample: None,
            open: slides.point.map(Requirement::Sliding),
        };
        if branches(self.spec) {
            // No bound is proved; the point is evaluated as it is.
            verdict.margins[0].lower = f64::NEG_INFINITY;
            verdict.condition = Condition::Unknown;
            return Ok(verdict);
        }
        if slides.upper.is_some_and(|value| value < 0.0)
            && let Some(point) = slides.point
        {
            let example = replay::sliding(&self.exact, &point, self.speeds());
            if example.work < 0.0 {
                verdict.passive = Some(false);
                verdict.counterexample = Some(example);
            }
            return Ok(verdict);
        }
        if !self.bounded.has_state() {
            verdict.passive = (slides.lower >= 0.0).then_some(true);
            return Ok(verdict);
        }
        if !bristle {
            verdict.condition = Condition::Unknown;
            if slides.lower >= 0.0 && self.constant_elements() {
                verdict.passive = Some(true);
                verdict.condition = Condition::Elements;
            }
            return Ok(verdict);
        }
        self.check_deflection(&mut verdict);
        Ok(verdict)
    }

    /// Checks that dry friction is positive everywhere.
    fn check_strength(&self) -> Result<(), PassivityError> {
        let dry = |region: &Region| Some(self.bounded.split(region).dry());
        let mut search = Search::over(&self.regions, &self.channels, &dry);
        search.run(self.budget, |s| s.lower() > 0.0 || s.upper() <= 0.0);
        match search.best {
            Some((dry, point)) if dry <= 0.0 => Err(PassivityError::NoBristle(point, dry)),
            _ => Ok(()),
        }
    }

    fn check_deflection(&self, verdict: &mut Verdict) {
        let bristled = |region: &Region| Bristled::of(&self.bounded, region);
        let part = |condition, function: fn(&Bristled<Enclosure>) -> Enclosure| {
            let value = |region: &Region| bristled(region).map_or(Enclosure::ALL, |b| function(&b));
            self.least(condition, value)
        };
        let damping = part(Condition::Damping, |b| {
            let room = Enclosure::point(4.0) * b.dry - b.drag;
            Enclosure::new(room.lower.min(b.drag.lower), room.upper.min(b.drag.upper))
        });
        let resistance = part(Condition::Resistance, |b| b.resistance);
        verdict.margins.extend([damping, resistance]);
        let linear = self.regions.iter().all(|r| bristled(r).is_some_and(|b| b.is_linear()));
        if linear && damping.lower >= 0.0 && resistance.lower >= 0.0 {
            let least = if damping.lower < resistance.lower { damping } else { resistance };
            (verdict.passive, verdict.condition) = (Some(true), least.condition);
            return;
        }
        let reach = self.reach();
        let [slowest, fastest] = self.speeds();
        let brisk = faster_than(&self.regions, REALISTIC_SPEED * fastest.max(-slowest));
        let look = |regions: &[Region], budget| {
            cycles::examine(&self.bounded, regions, &self.channels, reach, budget)
        };
        verdict.condition = Condition::Cycle;
        verdict.open = None;
        if self.is_violated_by(&look(&brisk, self.budget / 4), reach, verdict) {
            return;
        }
        let found = look(&self.regions, self.budget);
        if let Outcome::Passive { margin: lower, by_cycles } = found {
            let condition = if by_cycles { Condition::Cycle } else { Condition::Storage };
            verdict.margins.push(Margin { condition, lower, upper: None, point: None });
            (verdict.passive, verdict.condition) = (Some(true), condition);
        } else {
            self.is_violated_by(&found, reach, verdict);
        }
        if let Outcome::Undecided { force, points: Some([up, down]) } = found {
            verdict.open = Some(Requirement::Cycle { force, up, down });
        }
    }

    /// Whether a cycle was found that generates energy when simulated.
    fn is_violated_by(&self, outcome: &Outcome, reach: Reach, verdict: &mut Verdict) -> bool {
        let Outcome::Active { force, points: [up, down], sum } = outcome else { return false };
        verdict.open = Some(Requirement::Cycle { force: *force, up: *up, down: *down });
        if !self.is_free() {
            return false;
        }
        let cycle = replay::cycle(&self.exact, *force, reach.inner, [up, down], self.speeds());
        let Some(cycle) = cycle else { return false };
        verdict.margins.push(Margin {
            condition: Condition::Cycle,
            lower: f64::NEG_INFINITY,
            upper: Some(*sum),
            point: None,
        });
        (verdict.passive, verdict.counterexample) = (Some(false), Some(cycle));
        true
    }

    /// The forces that are reached: up to the largest force of steady sliding in each direction.
    fn reach(&self) -> Reach {
        let strongest = |forward: bool| {
            let regions: Vec<_> = self
                .regions
                .iter()
                .filter(|region| (region.velocity.lower > 0.0) == forward)
                .copied()
                .collect();
            let weakness =
                |region: &Region| Bristled::of(&self.bounded, region).map(|b| -b.strength());
            let mut search = Search::over(&regions, &self.channels, &weakness);
            search.run(self.budget, |s| s.upper() - s.lower() <= 1e-6 * s.lower().abs());
            if regions.is_empty() { (0.0, 0.0) } else { (-search.lower(), -search.upper()) }
        };
        let (forward, backward) = (strongest(true), strongest(false));
        Reach { outer: [-backward.0, forward.0], inner: [-backward.1, forward.1] }
    }

    /// The minimum over the box.
    fn least(&self, condition: Condition, function: impl Fn(&Region) -> Enclosure) -> Margin {
        let function = |region: &Region| Some(function(region));
        let mut search = Search::over(&self.regions, &self.channels, &function);
        let share = self.budget / 10;
        search.run(self.budget, |s| {
            let (lower, upper) = (s.lower(), s.upper());
            let decided = lower >= 0.0 || upper < 0.0;
            let size = lower.abs().max(upper.abs());
            decided && (upper - lower <= TOLERANCE * size || s.evaluations > share)
        });
        // Without motion there is no friction.
        let lower = if self.regions.is_empty() { 0.0 } else { search.lower() };
        let (upper, point) = search.best.unzip();
        Margin { condition, lower, upper, point }
    }

    /// The range of velocity of the box.
    fn speeds(&self) -> [f64; 2] {
        let ends = self.regions.iter().map(|region| region.velocity);
        let hull = ends.reduce(Enclosure::hull).unwrap_or(Enclosure::point(0.0));
        [hull.lower, hull.upper]
    }

    /// Whether the Stribeck curve lags the velocity.
    fn lags(&self) -> bool {
        self.spec.effects().contains(EffectId::FrictionalLag)
    }

    /// Whether the bristle depends only on channels that can change arbitrarily, unlike position
    /// and time.
    fn is_free(&self) -> bool {
        let bound = [Channel::Position, Channel::Time];
        !self.channels.iter().any(|channel| bound.contains(channel))
    }

    /// Whether the state consists of parallel elements of constant strength: springs and sliders.
    fn constant_elements(&self) -> bool {
        self.spec.law() == LawId::Gms
            && self.spec.effects() == EffectSet::NONE
            && self.regions.iter().all(|region| {
                let split = self.bounded.split(region);
                split.height.upper == 0.0 && (split.rate * region.velocity.sign()).lower >= 0.0
            })
    }
}
