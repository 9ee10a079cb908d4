//! Python interface: the catalog.

use std::vec::Vec;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::catalog::{EffectId, LawId};
use crate::constants::CONSTANTS;
use crate::table::{EffectInfo, LawInfo, ParameterInfo, Pole};

/// All laws, effects and constants: lists of dicts under `laws`, `effects` and `constants`.
#[pyfunction]
pub fn catalog(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let laws: Vec<_> = LawId::ALL.iter().map(|id| law(py, id.info())).collect::<PyResult<_>>()?;
    let effects: Vec<_> =
        EffectId::ALL.iter().map(|id| effect(py, id.info())).collect::<PyResult<_>>()?;
    let constants = PyList::empty(py);
    for info in CONSTANTS {
        let row = PyDict::new(py);
        row.set_item("name", info.name)?;
        row.set_item("unit", info.unit)?;
        row.set_item("default", info.default)?;
        row.set_item("description", info.description)?;
        constants.append(row)?;
    }
    let catalog = PyDict::new(py);
    catalog.set_item("laws", laws)?;
    catalog.set_item("effects", effects)?;
    catalog.set_item("constants", constants)?;
    Ok(catalog)
}

fn law<'py>(py: Python<'py>, info: &LawInfo) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("id", info.id)?;
    row.set_item("title", info.title)?;
    row.set_item("source", info.source)?;
    row.set_item("formula", info.formula)?;
    row.set_item("parameters", parameters(py, info.parameters)?)?;
    row.set_item("channels", info.channels.iter().map(|c| c.name()).collect::<Vec<_>>())?;
    row.set_item("constants", info.constants.to_vec())?;
    row.set_item("pole", info.pole.map(Pole::name))?;
    row.set_item("captures", info.captures.to_vec())?;
    Ok(row)
}

fn effect<'py>(py: Python<'py>, info: &EffectInfo) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("id", info.id)?;
    row.set_item("group", info.group)?;
    row.set_item("title", info.title)?;
    row.set_item("what", info.what)?;
    row.set_item("formula", info.formula)?;
    row.set_item("needs", info.needs)?;
    row.set_item("beyond", info.beyond)?;
    row.set_item("channels", info.channels.iter().map(|c| c.name()).collect::<Vec<_>>())?;
    row.set_item("constants", info.constants.to_vec())?;
    row.set_item("parameters", parameters(py, info.parameters)?)?;
    Ok(row)
}

fn parameters<'py>(py: Python<'py>, table: &[ParameterInfo]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    table.iter().map(|info| parameter(py, info)).collect()
}

/// One entry of a parameter table.
pub(super) fn parameter<'py>(
    py: Python<'py>,
    info: &ParameterInfo,
) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("name", info.name)?;
    row.set_item("symbol", info.symbol)?;
    row.set_item("unit", info.unit)?;
    row.set_item("lower", info.lower)?;
    row.set_item("upper", info.upper)?;
    row.set_item("start", info.start)?;
    row.set_item("drawn", info.drawn)?;
    row.set_item("scale", info.scale.name())?;
    row.set_item("role", info.role.name())?;
    row.set_item("description", info.description)?;
    Ok(row)
}
