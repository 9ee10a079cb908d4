//! Python interface: exported programs and elementary functions.

use std::format;
use std::string::String;
use std::vec::Vec;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use super::refuse;
use crate::composed::Spec;
use crate::export::{Binary, Input, Operation, Program, Unary};
use crate::math;

/// One step of a model as a dict: `operations`, each with its name, the indices of its operands and
/// its other data; `torque`, the index of the torque; `states`, one dict each.
pub(super) fn program<'py>(
    py: Python<'py>,
    spec: &Spec,
    single: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let program = if single { Program::of::<f32>(spec) } else { Program::of::<f64>(spec) };
    let program = program.map_err(refuse)?;
    let operations = PyList::empty(py);
    for &own in &program.operations {
        let (name, said) = describe(py, own)?;
        operations.append((name, own.operands(), said))?;
    }
    let states = PyList::empty(py);
    for state in &program.states {
        let (name, unit, what) = state.part.describe();
        let name = match state.part.element() {
            Some(k) => format!("{name}_{}", k + 1),
            None => String::from(name),
        };
        let row = PyDict::new(py);
        row.set_item("name", name)?;
        row.set_item("unit", unit)?;
        row.set_item("what", what)?;
        row.set_item("after", state.after)?;
        states.append(row)?;
    }
    let dict = PyDict::new(py);
    dict.set_item("operations", operations)?;
    dict.set_item("torque", program.torque)?;
    dict.set_item("states", states)?;
    Ok(dict)
}

/// The name of an operation, and its data apart from the operands.
fn describe(py: Python<'_>, operation: Operation) -> PyResult<(&'static str, Bound<'_, PyAny>)> {
    let none = || py.None().into_bound(py);
    Ok(match operation {
        Operation::Constant(bits) => {
            ("constant", f64::from_bits(bits).into_pyobject(py)?.into_any())
        }
        Operation::Parameter(index) => ("parameter", index.into_pyobject(py)?.into_any()),
        Operation::Column(column) => match Program::input(column) {
            Input::Channel(channel) => ("channel", channel.name().into_pyobject(py)?.into_any()),
            Input::TimeStep => ("time_step", none()),
            Input::State(place) => ("state", place.into_pyobject(py)?.into_any()),
        },
        Operation::Unary(Unary::Phi(order), _) => ("phi", order.into_pyobject(py)?.into_any()),
        Operation::Unary(own, _) => (unary(own), none()),
        Operation::Binary(own, ..) => (binary(own), none()),
        Operation::Choose(..) => ("choose", none()),
        Operation::Previous(_) => ("previous", none()),
        Operation::Relax(_) => ("relax", none()),
        Operation::Before(..) => ("before", none()),
    })
}

fn unary(operation: Unary) -> &'static str {
    match operation {
        Unary::Negate => "negate",
        Unary::Abs => "abs",
        Unary::Sign => "sign",
        Unary::Exp => "exp",
        Unary::Expm1 => "expm1",
        Unary::Ln => "ln",
        Unary::Sqrt => "sqrt",
        Unary::Cbrt => "cbrt",
        Unary::Sin => "sin",
        Unary::Cos => "cos",
        Unary::Tanh => "tanh",
        Unary::Atan => "atan",
        Unary::Phi(_) => "phi",
        Unary::IsFinite => "is_finite",
        Unary::Not => "not",
    }
}

fn binary(operation: Binary) -> &'static str {
    match operation {
        Binary::Add => "add",
        Binary::Subtract => "subtract",
        Binary::Multiply => "multiply",
        Binary::Divide => "divide",
        Binary::Power => "power",
        Binary::Below => "below",
        Binary::Above => "above",
        Binary::Equal => "equal",
        Binary::And => "and",
        Binary::Or => "or",
        Binary::Chain => "chain",
    }
}

/// The constants and polynomials of the elementary functions, lists by name.
#[pyfunction]
#[pyo3(signature = (*, single=false))]
pub fn elementary_constants(py: Python<'_>, single: bool) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    let mut rows: Vec<(&'static str, Vec<f64>)> = Vec::new();
    if single {
        math::f32::constants(|name, own| {
            rows.push((name, own.iter().copied().map(f64::from).collect()))
        });
    } else {
        math::f64::constants(|name, own| rows.push((name, own.to_vec())));
    }
    for (name, own) in rows {
        dict.set_item(name, own)?;
    }
    Ok(dict)
}

/// An elementary function with the bits that the laws compute: `power` uses `other` as exponents.
/// With `single` everything is computed in single precision.
///
/// # Errors
/// An unknown function.
#[pyfunction]
#[pyo3(signature = (function, x, other=Vec::new(), *, single=false))]
#[allow(clippy::needless_pass_by_value)]
pub fn elementary(
    function: &str,
    x: Vec<f64>,
    other: Vec<f64>,
    single: bool,
) -> PyResult<Vec<f64>> {
    let second = |i: usize| other.get(i).copied().unwrap_or(f64::NAN);
    macro_rules! of {
        ($float:ident) => {{
            let one: fn($float, $float) -> $float = match function {
                "exp" => |x, _| math::$float::exp(x),
                "expm1" => |x, _| math::$float::expm1(x),
                "phi" => |x, _| math::$float::phi(1, x),
                "ln" => |x, _| math::$float::ln(x),
                "sqrt" => |x, _| math::$float::sqrt(x),
                "cbrt" => |x, _| math::$float::cbrt(x),
                "sin" => |x, _| math::$float::sin(x),
                "cos" => |x, _| math::$float::cos(x),
                "tanh" => |x, _| math::$float::tanh(x),
                "atan" => |x, _| math::$float::atan(x),
                "power" => math::$float::powf,
                _ => return Err(super::ModelError::new_err(format!("no function {function}"))),
            };
            let rows = x.iter().enumerate();
            rows.map(|(i, &x)| f64::from(one(x as $float, second(i) as $float))).collect()
        }};
    }
    Ok(if single { of!(f32) } else { of!(f64) })
}
