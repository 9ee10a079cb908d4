//! The terms of a formula: it is split into dry, rate-dependent and additive friction, so that
//! effects apply to it.

use core::ops::Range;

use super::error::{FormulaError, Reason};
use super::law::{self, FormulaNames};
use super::linear::{ParameterSet, linear_parameters};
use super::program::{MAX_OPERATIONS, MAX_PARAMETERS, Operation, Program, Replacement};
use super::vocabulary::Function;
use crate::sample::{Sample, Split};
use crate::scalar::Real;
use crate::table::{Channel, ParameterInfo, Presence, Role, Scale};

/// Largest number of terms of a formula.
pub const MAX_TERMS: usize = 24;

/// The kind of a term.
///
/// | kind | condition |
/// |---|---|
/// | dry | it has the factor `sgn(v)`, and the other factors are not zero at `v = 0` |
/// | smoothed | the same with the factor `tanh` or `atan` of a multiple of `v` |
/// | rate | neither of these, and zero at `v = 0` |
/// | additive | none of these |
///
/// Factors are searched in products, numerators and behind signs, not inside a bracketed sum:
/// `(c1 + c2*abs(v))*sgn(v)` is one dry term, and `c1*sgn(v) + c2*abs(v)*sgn(v)` a dry and a rate
/// term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermKind {
    /// Dry friction along `sgn(v)`.
    Dry,
    /// Dry friction with a smoothed sign.
    Smoothed,
    /// Vanishes at zero velocity.
    Rate,
    /// Independent of the motion.
    Additive,
}

impl TermKind {
    /// The name shown to users.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dry => "dry",
            Self::Smoothed => "smoothed",
            Self::Rate => "rate",
            Self::Additive => "additive",
        }
    }
}

/// A term of the sum, as a part of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// Its kind.
    pub kind: TermKind,
    negative: bool,
    part: (u8, u8),
    direction: (u8, u8),
}

impl Term {
    /// Whether it is subtracted.
    #[must_use]
    pub const fn is_negative(&self) -> bool {
        self.negative
    }

    /// The operations that compute it.
    #[must_use]
    pub fn part(&self) -> Range<usize> {
        range(self.part)
    }

    /// The operations that compute its factor `sgn(v)` or the smoothed sign; empty if there is
    /// none.
    #[must_use]
    pub fn direction(&self) -> Range<usize> {
        range(self.direction)
    }
}

fn range((first, end): (u8, u8)) -> Range<usize> {
    usize::from(first)..usize::from(end)
}

/// A formula: its program, its terms, and the parameters in which it is linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula {
    program: Program,
    terms: [Option<Term>; MAX_TERMS],
    linear: ParameterSet,
}

impl Formula {
    /// Parses a text.
    ///
    /// # Errors
    /// What is wrong with the text, and where.
    pub fn parse(text: &str) -> Result<(Self, FormulaNames<'_>), FormulaError<'_>> {
        let (program, names) = law::parse(text)?;
        Ok((Self::of(program)?, names))
    }

    fn of(program: Program) -> Result<Self, FormulaError<'static>> {
        let mut formula = Self { program, terms: [None; MAX_TERMS], linear: 0 };
        if !formula.collect(program.operations().len() - 1, false) {
            let reason = Reason::TooLarge("terms", MAX_TERMS);
            return Err(FormulaError { position: 1, reason });
        }
        formula.linear = linear_parameters(&program);
        Ok(formula)
    }

    /// The program.
    #[must_use]
    pub const fn program(&self) -> &Program {
        &self.program
    }

    /// Number of parameters.
    #[must_use]
    pub const fn parameter_count(&self) -> usize {
        self.program.parameter_count
    }

    /// The terms, in their order.
    pub fn terms(&self) -> impl Iterator<Item = &Term> {
        self.terms.iter().flatten()
    }

    /// The sum of two formulas; the parameters of the second follow those of the first.
    ///
    /// # Errors
    /// The sum is larger than a formula can be.
    pub fn plus(&self, other: &Self) -> Result<Self, FormulaError<'static>> {
        let program = self.program.plus(&other.program).ok_or(FormulaError {
            position: 1,
            reason: Reason::TooLarge("parameters and operations in all terms", MAX_OPERATIONS),
        })?;
        Self::of(program)
    }

    /// Whether the formula reads a channel.
    #[must_use]
    pub fn reads(&self, channel: Channel) -> bool {
        self.program.operations().contains(&Operation::Channel(channel))
    }

    /// Whether the formula contains `min` or `max`.
    #[must_use]
    pub fn compares(&self) -> bool {
        let extreme = [Operation::Call(Function::Minimum), Operation::Call(Function::Maximum)];
        self.program.operations().iter().any(|operation| extreme.contains(operation))
    }

    /// A table entry for each parameter, named `p1`, `p2` ...: the caller keeps the names in the
    /// text.
    pub fn parameters(&self) -> impl Iterator<Item = &'static ParameterInfo> + '_ {
        (0..self.parameter_count()).filter_map(|i| slots(self.role(i)).get(i))
    }

    /// How a parameter enters the torque.
    #[must_use]
    pub fn role(&self, parameter: usize) -> Role {
        if parameter >= MAX_PARAMETERS || self.linear >> parameter & 1 == 0 {
            return Role::Nonlinear;
        }
        let within = |kind| self.terms().any(|t| t.kind == kind && self.mentions(t, parameter));
        if within(TermKind::Dry) || within(TermKind::Smoothed) {
            Role::Dry
        } else if within(TermKind::Additive) {
            Role::Additive
        } else {
            Role::Rate
        }
    }

    fn mentions(&self, term: &Term, parameter: usize) -> bool {
        let operations = self.program.operations().get(term.part()).unwrap_or_default();
        operations
            .iter()
            .any(|o| matches!(o, Operation::Parameter(i) if usize::from(*i) == parameter))
    }

    /// Collects the terms of the sum that ends at `last`; `false` if there are too many.
    fn collect(&mut self, last: usize, negative: bool) -> bool {
        let Some(&operation) = self.program.operations().get(last) else { return false };
        match operation {
            Operation::Add | Operation::Subtract => {
                let before = self.program.part(last - 1).start - 1;
                let minus = operation == Operation::Subtract;
                self.collect(before, negative) && self.collect(last - 1, negative != minus)
            }
            Operation::Negate => self.collect(last - 1, !negative),
            _ => {
                let term = self.term(last, negative);
                match (self.terms.iter_mut().find(|slot| slot.is_none()), term) {
                    (Some(slot), Some(term)) => {
                        *slot = Some(term);
                        true
                    }
                    _ => false,
                }
            }
        }
    }

    fn term(&self, last: usize, negative: bool) -> Option<Term> {
        let part = self.program.part(last);
        let sharp = self.factor(last, &|at| self.is_sign_of_velocity(at));
        let smooth = || self.factor(last, &|at| self.smoothed_limit(at).is_some());
        let direction = sharp.clone().or_else(smooth).filter(|factor| {
            let without = Replacement { part: factor, by: 1.0 };
            !self.vanishes(&part, Some(without))
        });
        let kind = match &direction {
            Some(_) if direction == sharp => TermKind::Dry,
            Some(_) => TermKind::Smoothed,
            None if sharp.is_some() || self.vanishes(&part, None) => TermKind::Rate,
            None => TermKind::Additive,
        };
        let small =
            |r: Range<usize>| Some((u8::try_from(r.start).ok()?, u8::try_from(r.end).ok()?));
        let direction = small(direction.unwrap_or_default())?;
        Some(Term { kind, negative, part: small(part)?, direction })
    }

    /// The first factor of a product that satisfies `wanted`, as a part of the program.
    fn factor(&self, last: usize, wanted: &dyn Fn(usize) -> bool) -> Option<Range<usize>> {
        if wanted(last) {
            return Some(self.program.part(last));
        }
        let before = |at: usize| self.program.part(at).start.checked_sub(1);
        match self.program.operations().get(last)? {
            Operation::Multiply => {
                self.factor(before(last - 1)?, wanted).or_else(|| self.factor(last - 1, wanted))
            }
            Operation::Divide => self.factor(before(last - 1)?, wanted),
            Operation::Negate => self.factor(last - 1, wanted),
            _ => None,
        }
    }

    fn is_velocity(&self, at: usize) -> bool {
        self.program.operations().get(at) == Some(&Operation::Channel(Channel::Velocity))
    }

    fn is_sign_of_velocity(&self, last: usize) -> bool {
        self.program.operations().get(last) == Some(&Operation::Call(Function::Sign))
            && self.is_velocity(last - 1)
    }

    /// The limit of a smoothed sign at high speed, if the function that ends at `last` is one.
    fn smoothed_limit(&self, last: usize) -> Option<f64> {
        let limit = match self.program.operations().get(last)? {
            Operation::Call(Function::Tanh) => 1.0,
            Operation::Call(Function::Atan) => core::f64::consts::FRAC_PI_2,
            _ => return None,
        };
        self.factor(last - 1, &|at| self.is_velocity(at)).map(|_| limit)
    }

    /// Whether a part of the program is zero at rest: evaluated at arbitrary parameters and
    /// channels, at which no terms cancel by accident.
    fn vanishes(&self, part: &Range<usize>, replacement: Option<Replacement<'_, f64>>) -> bool {
        let parameters = core::array::from_fn(|i| 0.7312 + 0.1937 * f64::from(i as u8));
        let rest = |sign: f64| Sample {
            velocity: 0.0,
            position: sign * 0.4271,
            acceleration: sign * 1.3719,
            temperature: 30.0 + sign * 8.8813,
            load_torque: sign * 2.7193,
            load_torque_curvature: 0.0,
            temperature_rate: 0.0,
            motor_torque: sign * 3.1871,
            external_torque: sign * 1.9177,
            time: 0.0,
        };
        [1.0, -1.0]
            .iter()
            .all(|&sign| self.program.evaluate(part, replacement, &parameters, &rest(sign)) == 0.0)
    }
}

/// Table entries for parameters with this role: unbounded, without a unit.
const fn slots(role: Role) -> &'static [ParameterInfo; MAX_PARAMETERS] {
    match role {
        Role::Dry => const { &table(Role::Dry) },
        Role::Rate => const { &table(Role::Rate) },
        Role::Additive => const { &table(Role::Additive) },
        Role::Nonlinear | Role::Held => const { &table(Role::Nonlinear) },
    }
}

const fn table(role: Role) -> [ParameterInfo; MAX_PARAMETERS] {
    const NAMES: [&str; MAX_PARAMETERS] = [
        "p1", "p2", "p3", "p4", "p5", "p6", "p7", "p8", "p9", "p10", "p11", "p12", "p13", "p14",
        "p15", "p16",
    ];
    let unnamed = ParameterInfo {
        name: "",
        symbol: "",
        unit: "1",
        lower: f64::NEG_INFINITY,
        upper: f64::INFINITY,
        start: 1.0,
        drawn: (f64::NEG_INFINITY, f64::INFINITY),
        scale: Scale::None,
        role,
        presence: Presence::InFormula,
        description: "Parameter of a formula.",
    };
    let mut rows = [unnamed; MAX_PARAMETERS];
    let mut i = 0;
    while i < rows.len() {
        rows[i].name = NAMES[i];
        rows[i].symbol = NAMES[i];
        i += 1;
    }
    rows
}

/// A formula with parameter values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormulaTerms<S> {
    formula: Formula,
    parameters: [S; MAX_PARAMETERS],
}

impl<S: Real> FormulaTerms<S> {
    /// The formula with the parameters that `next` returns, in their order.
    #[inline]
    #[must_use]
    pub fn read(formula: &Formula, mut next: impl FnMut() -> S) -> Self {
        let count = formula.parameter_count();
        let parameters = core::array::from_fn(|i| if i < count { next() } else { S::zero() });
        Self { formula: *formula, parameters }
    }

    /// The formula with these parameters; missing ones are zero.
    #[cfg(test)]
    #[must_use]
    pub fn new(formula: &Formula, parameters: &[S]) -> Self {
        let mut parameters = parameters.iter().copied();
        Self::read(formula, || parameters.next().unwrap_or_else(S::zero))
    }

    /// The torque at one sample, by terms.
    #[cfg(test)]
    #[inline]
    #[must_use]
    pub fn split(&self, sample: &Sample<S::Plain>) -> Split<S> {
        let mut split = Split::zero();
        self.add_to(&mut split, sample);
        split
    }

    /// Adds the terms to `split`.
    #[inline]
    pub fn add_to(&self, split: &mut Split<S>, sample: &Sample<S::Plain>) {
        for term in self.formula.terms() {
            let value = |by: Option<S::Plain>| {
                let direction = &term.direction();
                let replacement = by.map(|by| Replacement { part: direction, by });
                let program = &self.formula.program;
                let value = program.evaluate(&term.part(), replacement, &self.parameters, sample);
                if term.negative { -value } else { value }
            };
            match term.kind {
                TermKind::Dry => split.coulomb += value(Some(S::Plain::one())),
                TermKind::Smoothed => {
                    split.smoothed_torque += value(None);
                    split.smoothed_amplitude += value(Some(self.limit(term, sample)));
                }
                TermKind::Rate => split.rate += value(None),
                TermKind::Additive => split.additive += value(None),
            }
        }
    }

    /// The limit of the smoothed sign at high forward speed.
    fn limit(&self, term: &Term, sample: &Sample<S::Plain>) -> S::Plain {
        let direction = term.direction();
        let last = direction.end.saturating_sub(1);
        let forwards = Sample { velocity: S::Plain::one(), ..*sample };
        let inside = direction.start..last;
        let argument = self.formula.program.evaluate(&inside, None, &self.parameters, &forwards);
        let limit = self.formula.smoothed_limit(last).unwrap_or_default();
        let limit = S::Plain::from_f64(limit);
        S::Plain::choose(argument.is_negative(), -limit, limit)
    }
}
