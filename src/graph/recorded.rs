//! Numbers that record the operations performed on them.

use core::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use super::operation::{Binary, Id, Operation, Unary};
use super::recorder::Recorder;
use crate::scalar::{Choice, Mask, Real, Scalar};

/// A number known while recording, or a node of a graph; known numbers are computed in format `F`.
#[derive(Clone, Copy, Debug)]
pub enum Recorded<'r, F = f64> {
    /// A known number: operations on known numbers are computed at once.
    Known(F),
    /// A node of the graph.
    Node(&'r Recorder, Id),
}

/// The result of a comparison: known, or a node.
#[derive(Clone, Copy, Debug)]
pub enum RecordedMask<'r> {
    /// Known while recording.
    Known(bool),
    /// A node of the graph.
    Node(&'r Recorder, Id),
}

use Recorded::{Known, Node};

/// A format that known numbers are computed in.
pub trait Format: Scalar<Plain = Self> {}

impl<F: Scalar<Plain = F>> Format for F {}

impl<'r, F: Format> Recorded<'r, F> {
    #[allow(clippy::should_implement_trait)]
    fn one(self, operation: Unary, compute: impl Fn(F) -> F) -> Self {
        match self {
            Known(x) => Known(compute(x)),
            Node(recorder, x) => recorder.unary(operation, x),
        }
    }

    fn two(self, other: Self, operation: Binary, compute: impl Fn(F, F) -> F) -> Self {
        match (self, other) {
            (Known(x), Known(y)) => Known(compute(x, y)),
            (Node(recorder, _), _) | (_, Node(recorder, _)) => {
                recorder.binary(operation, recorder.id(self), recorder.id(other))
            }
        }
    }

    fn compare(
        self,
        other: Self,
        operation: Binary,
        compute: impl Fn(F, F) -> bool,
    ) -> RecordedMask<'r> {
        match (self, other) {
            (Known(x), Known(y)) => RecordedMask::Known(compute(x, y)),
            (Node(recorder, _), _) | (_, Node(recorder, _)) => {
                let (x, y) = (recorder.id(self), recorder.id(other));
                let node = recorder.node(Operation::Binary(operation, x, y));
                RecordedMask::Node(recorder, node)
            }
        }
    }

    /// Whether it is known to equal `number`; the sign of zero is ignored.
    #[must_use]
    pub fn is(self, number: f64) -> bool {
        matches!(self, Known(x) if x.value() == number)
    }
}

impl<'r> RecordedMask<'r> {
    fn with(self, other: Self, operation: Binary, compute: impl Fn(bool, bool) -> bool) -> Self {
        match (self, other) {
            (Self::Known(x), Self::Known(y)) => Self::Known(compute(x, y)),
            (Self::Node(recorder, _), _) | (_, Self::Node(recorder, _)) => {
                let operation =
                    Operation::Binary(operation, self.node(recorder), other.node(recorder));
                Self::Node(recorder, recorder.node(operation))
            }
        }
    }

    fn node(self, recorder: &Recorder) -> Id {
        match self {
            Self::Known(yes) => recorder.constant(f64::from(u8::from(yes))),
            Self::Node(_, id) => id,
        }
    }
}

impl Mask for RecordedMask<'_> {
    fn of(yes: bool) -> Self {
        Self::Known(yes)
    }

    fn and(self, other: Self) -> Self {
        self.with(other, Binary::And, |x, y| x & y)
    }

    fn or(self, other: Self) -> Self {
        self.with(other, Binary::Or, |x, y| x | y)
    }

    fn not(self) -> Self {
        match self {
            Self::Known(yes) => Self::Known(!yes),
            Self::Node(recorder, id) => {
                Self::Node(recorder, recorder.node(Operation::Unary(Unary::Not, id)))
            }
        }
    }

    fn all(self) -> bool {
        matches!(self, Self::Known(true))
    }

    /// Records one alternative only where the mask is known.
    fn either<T: Choice<Self>>(self, yes: impl FnOnce() -> T, no: impl FnOnce() -> T) -> T {
        match self {
            Self::Known(true) => yes(),
            Self::Known(false) => no(),
            Self::Node(..) => T::select(self, yes(), no()),
        }
    }
}

macro_rules! operator {
    ($($operator:ident: $method:ident),+) => {$(
        impl<F: Format> $operator for Recorded<'_, F> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.two(other, operator!(@ $operator), F::$method)
            }
        }
    )+};
    (@ Add) => { Binary::Add };
    (@ Sub) => { Binary::Subtract };
}

operator!(Add: add, Sub: sub);

impl<F: Format> Mul for Recorded<'_, F> {
    type Output = Self;

    /// Multiplication by one changes no bits and is left out.
    fn mul(self, other: Self) -> Self {
        match (self.is(1.0), other.is(1.0)) {
            (true, _) => other,
            (_, true) => self,
            _ => self.two(other, Binary::Multiply, F::mul),
        }
    }
}

impl<F: Format> Div for Recorded<'_, F> {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        if other.is(1.0) { self } else { self.two(other, Binary::Divide, F::div) }
    }
}

impl<F: Format> Neg for Recorded<'_, F> {
    type Output = Self;

    fn neg(self) -> Self {
        self.one(Unary::Negate, F::neg)
    }
}

impl<F: Format> AddAssign for Recorded<'_, F> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<F: Format> MulAssign for Recorded<'_, F> {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

macro_rules! functions {
    ($($name:ident = $operation:ident),+ $(,)?) => {$(
        fn $name(self) -> Self {
            self.one(Unary::$operation, F::$name)
        }
    )+};
}

impl<'r, F: Format> Real for Recorded<'r, F> {
    type Plain = Self;
    type Mask = RecordedMask<'r>;

    functions!(
        abs = Abs,
        sign = Sign,
        exp = Exp,
        expm1 = Expm1,
        ln = Ln,
        sqrt = Sqrt,
        cbrt = Cbrt,
        sin = Sin,
        cos = Cos,
        tanh = Tanh,
        atan = Atan
    );

    fn from_f64(x: f64) -> Self {
        Known(F::from_f64(x))
    }

    fn from_plain(x: Self) -> Self {
        x
    }

    fn plain(self) -> Self {
        self
    }

    /// A node passes every test: its value is checked when the graph runs.
    fn every(self, mut test: impl FnMut(f64) -> bool) -> bool {
        match self {
            Known(x) => test(x.value()),
            Node(..) => true,
        }
    }

    fn is_zero(&self) -> bool {
        self.is(0.0)
    }

    fn is_below(self, bound: Self) -> RecordedMask<'r> {
        self.compare(bound, Binary::Below, F::is_below)
    }

    fn is_above(self, bound: Self) -> RecordedMask<'r> {
        self.compare(bound, Binary::Above, F::is_above)
    }

    fn equals(self, other: Self) -> RecordedMask<'r> {
        self.compare(other, Binary::Equal, F::equals)
    }

    fn is_finite(self) -> RecordedMask<'r> {
        match self {
            Known(x) => RecordedMask::Known(x.is_finite()),
            Node(recorder, id) => {
                let node = recorder.node(Operation::Unary(Unary::IsFinite, id));
                RecordedMask::Node(recorder, node)
            }
        }
    }

    fn choose(mask: RecordedMask<'r>, yes: Self, no: Self) -> Self {
        match mask {
            RecordedMask::Known(true) => yes,
            RecordedMask::Known(false) => no,
            RecordedMask::Node(recorder, mask) => {
                let (yes, no) = (recorder.id(yes), recorder.id(no));
                if yes == no {
                    return Node(recorder, yes);
                }
                recorder.number(Operation::Choose(mask, yes, no))
            }
        }
    }

    fn scale(self, factor: Self) -> Self {
        self * factor
    }

    fn shift(self, by: Self) -> Self {
        self + by
    }

    fn add_scaled(&mut self, other: &Self, factor: Self) {
        *self += *other * factor;
    }

    fn add_linear_combination<const K: usize>(&mut self, others: [&Self; K], factors: [Self; K]) {
        for (other, factor) in others.into_iter().zip(factors) {
            *self += *other * factor;
        }
    }

    fn reciprocal_times(self, numerator: Self) -> Self {
        numerator / self
    }

    fn exp_with_base(self, base: Self) -> Self {
        base.powf(self)
    }

    fn powf(self, p: Self) -> Self {
        self.two(p, Binary::Power, F::powf)
    }

    fn phi(self, order: u8) -> Self {
        self.one(Unary::Phi(order), |x| x.phi(order))
    }

    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
}
