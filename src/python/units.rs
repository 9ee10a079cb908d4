//! The table of units, for Python.

use std::vec::Vec;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::table::Channel;
use crate::units::{DIMENSIONS, UNITS, powers};

/// Every dimension, unit and channel: lists of dicts under `dimensions`, `units` and `channels`.
///
/// `unit` is in terms of T, X, s and K, and `powers` are the powers of these four.
#[pyfunction]
pub fn units(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let tables = PyDict::new(py);
    let dimensions = DIMENSIONS.iter().map(|dimension| {
        let row = PyDict::new(py);
        row.set_item("name", dimension.name)?;
        row.set_item("si", dimension.si)?;
        row.set_item("unit", dimension.unit)?;
        row.set_item("powers", dimension.unit.and_then(powers).map(Into::<(_, _, _, _)>::into))?;
        Ok(row)
    });
    tables.set_item("dimensions", dimensions.collect::<PyResult<Vec<_>>>()?)?;
    let units = UNITS.iter().map(|unit| {
        let row = PyDict::new(py);
        row.set_item("dimension", unit.dimension)?;
        row.set_item("spellings", unit.spellings.split(' ').collect::<Vec<_>>())?;
        row.set_item("factor", unit.factor)?;
        row.set_item("offset", unit.offset)?;
        Ok(row)
    });
    tables.set_item("units", units.collect::<PyResult<Vec<_>>>()?)?;
    let channels = Channel::ALL.iter().map(|channel| {
        let row = PyDict::new(py);
        row.set_item("name", channel.name())?;
        row.set_item("unit", channel.unit())?;
        row.set_item("powers", powers(channel.unit()).map(Into::<(_, _, _, _)>::into))?;
        Ok(row)
    });
    tables.set_item("channels", channels.collect::<PyResult<Vec<_>>>()?)?;
    Ok(tables)
}
