//! Python interface: formulas.

use std::string::{String, ToString};
use std::vec::Vec;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::refuse;
use crate::formula::{self, Operation};
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
