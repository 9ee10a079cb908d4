//! Python interface: formulas.

use std::string::{String, ToString};
use std::vec::Vec;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::refuse;
use crate::formula::{
    self, Builder, COLUMN_FUNCTIONS, ColumnFunction, FUNCTIONS, Function, Operation, Reason,
};
use crate::table::Channel;

/// Friction terms given as text. No text is executed as code.
#[pyclass(frozen, module = "stribeck._core")]
pub struct Formula {
    formula: formula::Formula,
    names: Vec<String>,
}

#[pymethods]
impl Formula {
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let (formula, names) = formula::Formula::parse(text).map_err(refuse)?;
        let names = names.as_slice().iter().map(ToString::to_string).collect();
        Ok(Self { formula, names })
    }

    /// The names of its parameters, in the order of their first use in the text.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// How each parameter enters the torque: dry, rate, additive, nonlinear.
    #[getter]
    fn roles(&self) -> Vec<&'static str> {
        (0..self.names.len()).map(|i| self.formula.role(i).name()).collect()
    }

    /// Columns it reads.
    #[getter]
    fn channels(&self) -> Vec<&'static str> {
        let read = Channel::ALL.into_iter().filter(|&channel| self.formula.reads(channel));
        read.map(Channel::name).collect()
    }

    /// The program in postfix order: operations and their data.
    #[getter]
    fn operations<'py>(&self, py: Python<'py>) -> PyResult<Vec<(&'static str, Bound<'py, PyAny>)>> {
        let program = self.formula.program();
        let none = || py.None().into_bound(py);
        let step = |operation: &Operation| {
            Ok(match *operation {
                Operation::Constant(i) => {
                    let constant = program.constants().get(usize::from(i));
                    ("constant", constant.into_pyobject(py)?.into_any())
                }
                Operation::Parameter(i) => ("parameter", i.into_pyobject(py)?.into_any()),
                Operation::Channel(channel) => {
                    ("channel", channel.name().into_pyobject(py)?.into_any())
                }
                Operation::Negate => ("negate", none()),
                Operation::Add => ("add", none()),
                Operation::Subtract => ("subtract", none()),
                Operation::Multiply => ("multiply", none()),
                Operation::Divide => ("divide", none()),
                Operation::IntegerPower(n) => ("integer_power", n.into_pyobject(py)?.into_any()),
                Operation::Call(function) => {
                    ("call", function.name().into_pyobject(py)?.into_any())
                }
            })
        };
        program.operations().iter().map(step).collect()
    }

    /// Its terms, one dict each: `kind`, `negative`, and the ranges of operations `part` (the whole
    /// term) and `direction` (its factor `sgn v`, exact or smoothed).
    #[getter]
    fn terms<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let term = |term: &formula::Term| {
            let (part, direction) = (term.part(), term.direction());
            let row = PyDict::new(py);
            row.set_item("kind", term.kind.name())?;
            row.set_item("negative", term.is_negative())?;
            row.set_item("part", (part.start, part.end))?;
            row.set_item("direction", (direction.start, direction.end))?;
            Ok(row)
        };
        self.formula.terms().map(term).collect()
    }
}

/// A formula over parameters, or a condition on them. No text is executed as code.
#[pyclass(frozen, module = "stribeck._core")]
pub struct Expression {
    expression: formula::Expression,
    names: Vec<String>,
}

#[pymethods]
impl Expression {
    #[new]
    #[allow(clippy::needless_pass_by_value)]
    fn new(text: &str, known: Vec<String>) -> PyResult<Self> {
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let (expression, names) = formula::Expression::parse(text, &known).map_err(refuse)?;
        let names = names.as_slice().iter().map(ToString::to_string).collect();
        Ok(Self { expression, names })
    }

    /// The names of the parameters that it uses, in the order of their first use.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.names.clone()
    }

    /// Whether it is a condition.
    #[getter]
    fn is_condition(&self) -> bool {
        self.expression.is_condition()
    }

    /// Its value, and its derivatives by these parameters.
    #[allow(clippy::needless_pass_by_value)]
    fn evaluate(&self, values: Vec<f64>) -> (f64, Vec<f64>) {
        let (value, slopes) = self.expression.evaluate(&values);
        (value, slopes.into_iter().take(self.names.len()).collect())
    }
}

/// One step of a formula over columns, in postfix order.
struct Step<'a> {
    name: &'static str,
    detail: Detail<'a>,
    /// The byte at which it begins.
    at: usize,
}

/// What a step works on besides the values before it.
enum Detail<'a> {
    None,
    Number(f64),
    Text(&'a str),
    /// A function and its number of arguments.
    Call(&'static str, usize),
}

/// The steps of a formula over columns while its text is parsed.
struct Columns<'a>(Vec<Step<'a>>);

impl<'a> Columns<'a> {
    fn add(&mut self, name: &'static str, detail: Detail<'a>, at: usize) {
        self.0.push(Step { name, detail, at });
    }
}

impl<'a> Builder<'a> for Columns<'a> {
    const DEPTH: usize = 100;
    const CONDITIONS: bool = true;
    const COLUMNS: bool = true;

    fn number(&mut self, number: f64, at: usize) -> Result<(), Reason<'a>> {
        if !number.is_finite() {
            return Err(Reason::NotFinite);
        }
        self.add("number", Detail::Number(number), at);
        Ok(())
    }

    fn name(&mut self, name: &'a str, at: usize) -> Result<(), Reason<'a>> {
        self.add("name", Detail::Text(name), at);
        Ok(())
    }

    fn operation(&mut self, operation: Operation, at: usize) -> Result<(), Reason<'a>> {
        let name = match operation {
            Operation::Negate => "negate",
            Operation::Add => "add",
            Operation::Subtract => "subtract",
            Operation::Multiply => "multiply",
            Operation::Divide => "divide",
            _ => "power",
        };
        self.add(name, Detail::None, at);
        Ok(())
    }

    fn call(&mut self, function: Function, given: usize, at: usize) -> Result<(), Reason<'a>> {
        self.add("call", Detail::Call(function.name(), given), at);
        Ok(())
    }

    fn column_call(
        &mut self,
        function: &'static ColumnFunction,
        given: usize,
        at: usize,
    ) -> Result<(), Reason<'a>> {
        self.add("call", Detail::Call(function.name, given), at);
        Ok(())
    }

    fn text(&mut self, text: &'a str, at: usize) -> Result<(), Reason<'a>> {
        self.add("text", Detail::Text(text), at);
        Ok(())
    }

    fn condition(&mut self, word: &'a str, chained: bool, at: usize) -> Result<(), Reason<'a>> {
        match word {
            "and" => self.add("and", Detail::None, at),
            "or" => self.add("or", Detail::None, at),
            "not" => self.add("not", Detail::None, at),
            _ if chained => self.add("chain", Detail::Text(word), at),
            _ => self.add("compare", Detail::Text(word), at),
        }
        Ok(())
    }
}

/// The steps of a formula over columns in postfix order: what to do, with what, and the position of
/// the character where it begins, counted from 1.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn column_formula<'py>(
    py: Python<'py>,
    text: &str,
) -> PyResult<Vec<(&'static str, Bound<'py, PyAny>, usize)>> {
    let mut columns = Columns(Vec::new());
    formula::parse(text, &mut columns).map_err(refuse)?;
    let step = |step: &Step<'_>| {
        let detail = match step.detail {
            Detail::None => py.None().into_bound(py),
            Detail::Number(number) => number.into_pyobject(py)?.into_any(),
            Detail::Text(text) => text.into_pyobject(py)?.into_any(),
            Detail::Call(name, given) => (name, given).into_pyobject(py)?.into_any(),
        };
        let before = text.get(..step.at).unwrap_or_default();
        Ok((step.name, detail, before.chars().count() + 1))
    };
    columns.0.iter().map(step).collect()
}

/// The functions of formulas: each name, and the name in programs.
#[pyfunction]
pub fn formula_functions() -> Vec<(&'static str, &'static str)> {
    FUNCTIONS.iter().map(|(name, function)| (*name, function.name())).collect()
}

/// The functions of whole columns, which formulas over columns have besides those of laws.
#[pyfunction]
pub fn column_functions() -> Vec<&'static str> {
    COLUMN_FUNCTIONS.iter().map(|function| function.name).collect()
}
