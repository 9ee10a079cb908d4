//! Python interface: models.

use std::collections::BTreeMap;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use numpy::{IntoPyArray, PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::catalog::parameter;
use super::columns::{Arguments, Array, Dt, Start, contiguous, fresh, numbers, writable};
use super::export::program;
use super::{ModelError, refuse};
use crate::batch;
use crate::composed::Spec;
use crate::formula::Formula;
use crate::table::Presence;

/// A friction law with effects and formula terms. Its parameters are fixed; their values are
/// arguments.
#[pyclass(frozen, module = "stribeck._core")]
pub struct Model {
    pub(super) spec: Spec,
    /// Names of the formula parameters in the model, and in the formulas.
    own: Vec<(String, String)>,
}

#[pymethods]
impl Model {
    #[new]
    #[pyo3(signature = (law, effects = Vec::new(), constants = BTreeMap::new(), own = Vec::new()))]
    #[allow(clippy::needless_pass_by_value)]
    fn new(
        law: Option<&str>,
        effects: Vec<String>,
        constants: BTreeMap<String, f64>,
        own: Vec<(String, Vec<String>)>,
    ) -> PyResult<Self> {
        let mut called = Vec::new();
        let mut formulas = Vec::new();
        for (text, names) in &own {
            let (formula, symbols) = Formula::parse(text).map_err(refuse)?;
            if names.len() != symbols.as_slice().len() {
                let message = format!("'{text}' does not have {} parameters", names.len());
                return Err(ModelError::new_err(message));
            }
            let symbols = symbols.as_slice().iter().map(ToString::to_string);
            called.extend(names.iter().cloned().zip(symbols));
            formulas.push(formula);
        }
        let mut formulas = formulas.iter();
        let effects = effects.iter().map(String::as_str);
        let mut spec = match law {
            Some(law) => Spec::new(law, effects).map_err(refuse)?,
            None => {
                let missing = || ModelError::new_err("neither a law nor a formula is given");
                let formula = formulas.next().ok_or_else(missing)?;
                Spec::by_formula(formula, effects).map_err(refuse)?
            }
        };
        for formula in formulas {
            spec.add_terms(formula).map_err(refuse)?;
        }
        for (name, &value) in &constants {
            spec.set_constant(name, value).map_err(refuse)?;
        }
        Ok(Self { spec, own: called })
    }

    /// Id of the law.
    #[getter]
    fn law(&self) -> &'static str {
        self.spec.law().info().id
    }

    /// Ids of the effects, in the order in which they act.
    #[getter]
    fn effects(&self) -> Vec<&'static str> {
        self.spec.effects().iter().map(|effect| effect.info().id).collect()
    }

    /// `law+effect+...`.
    #[getter]
    fn spec(&self) -> String {
        self.spec.to_string()
    }

    /// The constants of its law and effects.
    #[getter]
    fn constants(&self) -> BTreeMap<&'static str, f64> {
        self.spec.constants().collect()
    }

    /// Whether the torque depends on the history.
    #[getter]
    fn has_state(&self) -> bool {
        self.spec.has_state()
    }

    /// Number of values of its state.
    #[getter]
    fn state_size(&self) -> usize {
        self.spec.memory().size()
    }

    /// Columns that it reads.
    #[getter]
    fn needs(&self) -> Vec<&'static str> {
        self.spec.channels().map(crate::table::Channel::name).collect()
    }

    /// Its parameters in the order of `values`, one dict each.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let mut own = self.own.iter();
        self.spec
            .parameters()
            .map(|info| {
                let row = parameter(py, info)?;
                row.set_item("linear", self.spec.is_linear(info))?;
                if info.presence == Presence::InFormula
                    && let Some((name, symbol)) = own.next()
                {
                    row.set_item("name", name)?;
                    row.set_item("symbol", symbol)?;
                }
                Ok(row)
            })
            .collect()
    }

    /// One step of the model as a list of operations, to generate code from: dict of `operations`
    /// (name, operands, data), `torque` (index) and `states` (dicts). With `single` numbers known
    /// beforehand are computed in single precision.
    #[pyo3(signature = (*, single=false))]
    fn program<'py>(&self, py: Python<'py>, single: bool) -> PyResult<Bound<'py, PyDict>> {
        program(py, &self.spec, single)
    }

    /// Friction torque of every sample; with memory, at the end of the sample's step. `single`
    /// computes in single precision throughout. The result is written to `out` where it is given. A
    /// result that is not finite is refused where `what` names it.
    #[pyo3(signature = (values, dt, velocity, position=None, acceleration=None, temperature=None,
        load_torque=None, motor_torque=None, external_torque=None, time=None,
        load_torque_curvature=None, temperature_rate=None, smooth=None, shift_load=true, mean_velocity=None, state=None, *, single=false, out=None, what=None))]
    #[allow(clippy::too_many_arguments)]
    fn torque<'py>(
        &self,
        py: Python<'py>,
        values: Array<'py>,
        dt: Option<Dt<'py>>,
        velocity: Array<'py>,
        position: Option<Array<'py>>,
        acceleration: Option<Array<'py>>,
        temperature: Option<Array<'py>>,
        load_torque: Option<Array<'py>>,
        motor_torque: Option<Array<'py>>,
        external_torque: Option<Array<'py>>,
        time: Option<Array<'py>>,
        load_torque_curvature: Option<Array<'py>>,
        temperature_rate: Option<Array<'py>>,
        smooth: Option<BTreeMap<String, Array<'py>>>,
        shift_load: bool,
        mean_velocity: Option<Array<'py>>,
        state: Option<Start<'py>>,
        single: bool,
        out: Option<Bound<'py, PyArray1<f64>>>,
        what: Option<&str>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = contiguous(&values);
        let arguments = Arguments {
            dt,
            velocity,
            position,
            acceleration,
            temperature,
            load_torque,
            motor_torque,
            external_torque,
            time,
            load_torque_curvature,
            temperature_rate,
            smooth,
            shift_load,
            mean_velocity,
            state,
        };
        let out = match out {
            Some(out) => out,
            None => fresh(py, [arguments.rows()])?,
        };
        let run = if single { batch::torque_single_and_range } else { batch::torque_and_range };
        let mut room = writable(&out)?;
        let torque = numbers(&mut room)?;
        let finite = arguments
            .detached(py, |columns| run(&self.spec, &values, columns, &mut *torque))?
            .map_err(refuse)?;
        if let (false, Some(what)) = (finite, what) {
            return Err(out_of_range(what, torque, 1));
        }
        drop(room);
        Ok(out)
    }

    /// Friction torque of every sample and its derivatives with respect to the `wanted` parameters
    /// (indices, by default all) in that order, one column each. Both are written to `out` where it
    /// is given. Derivatives that are not finite are refused where `what` names them.
    #[pyo3(signature = (values, dt, velocity, position=None, acceleration=None, temperature=None,
        load_torque=None, motor_torque=None, external_torque=None, time=None,
        load_torque_curvature=None, temperature_rate=None, smooth=None, shift_load=true, mean_velocity=None, state=None, *, wanted=None, out=None, what=None))]
    #[allow(clippy::too_many_arguments, clippy::type_complexity)]
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        values: Array<'py>,
        dt: Option<Dt<'py>>,
        velocity: Array<'py>,
        position: Option<Array<'py>>,
        acceleration: Option<Array<'py>>,
        temperature: Option<Array<'py>>,
        load_torque: Option<Array<'py>>,
        motor_torque: Option<Array<'py>>,
        external_torque: Option<Array<'py>>,
        time: Option<Array<'py>>,
        load_torque_curvature: Option<Array<'py>>,
        temperature_rate: Option<Array<'py>>,
        smooth: Option<BTreeMap<String, Array<'py>>>,
        shift_load: bool,
        mean_velocity: Option<Array<'py>>,
        state: Option<Start<'py>>,
        wanted: Option<Vec<usize>>,
        out: Option<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)>,
        what: Option<&str>,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>)> {
        let values = contiguous(&values);
        let arguments = Arguments {
            dt,
            velocity,
            position,
            acceleration,
            temperature,
            load_torque,
            motor_torque,
            external_torque,
            time,
            load_torque_curvature,
            temperature_rate,
            smooth,
            shift_load,
            mean_velocity,
            state,
        };
        let wanted = wanted.unwrap_or_else(|| (0..values.len()).collect());
        let rows = arguments.rows();
        let (torque, slopes) = match out {
            Some(out) => out,
            None => (fresh(py, [rows])?, fresh(py, [rows, wanted.len()])?),
        };
        let (mut torque_room, mut slopes_room) = (writable(&torque)?, writable(&slopes)?);
        let (all, each) = (numbers(&mut torque_room)?, numbers(&mut slopes_room)?);
        let finite = arguments
            .detached(py, |columns| {
                batch::gradient_and_range(&self.spec, &values, columns, &wanted, all, &mut *each)
            })?
            .map_err(refuse)?;
        if let (false, Some(what)) = (finite, what) {
            return Err(out_of_range(what, each, wanted.len()));
        }
        drop((torque_room, slopes_room));
        Ok((torque, slopes))
    }

    /// Parts of the torque in steady sliding: dict of `dry`, `rate` and `additive`.
    #[pyo3(signature = (values, velocity, position=None, acceleration=None, temperature=None,
        load_torque=None, motor_torque=None, external_torque=None, time=None,
        load_torque_curvature=None, temperature_rate=None))]
    #[allow(clippy::too_many_arguments)]
    fn split<'py>(
        &self,
        py: Python<'py>,
        values: Array<'py>,
        velocity: Array<'py>,
        position: Option<Array<'py>>,
        acceleration: Option<Array<'py>>,
        temperature: Option<Array<'py>>,
        load_torque: Option<Array<'py>>,
        motor_torque: Option<Array<'py>>,
        external_torque: Option<Array<'py>>,
        time: Option<Array<'py>>,
        load_torque_curvature: Option<Array<'py>>,
        temperature_rate: Option<Array<'py>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let values = contiguous(&values);
        let arguments = Arguments {
            dt: None,
            velocity,
            position,
            acceleration,
            temperature,
            load_torque,
            motor_torque,
            external_torque,
            time,
            load_torque_curvature,
            temperature_rate,
            smooth: None,
            shift_load: true,
            mean_velocity: None,
            state: None,
        };
        let parts = arguments
            .detached(py, |columns| batch::split(&self.spec, &values, columns))?
            .map_err(refuse)?;
        let dict = PyDict::new(py);
        dict.set_item("dry", parts.dry.into_pyarray(py))?;
        dict.set_item("rate", parts.rate.into_pyarray(py))?;
        dict.set_item("additive", parts.additive.into_pyarray(py))?;
        Ok(dict)
    }

    fn __repr__(&self) -> String {
        std::format!("Model({})", self.spec)
    }
}

/// The refusal of results that are not finite, with `width` numbers per sample.
fn out_of_range(what: &str, results: &[f64], width: usize) -> PyErr {
    let sample = results.iter().position(|x| !x.is_finite()).unwrap_or(0) / width;
    ModelError::new_err(format!(
        "{what} is not finite at sample {sample}: check the values given and their units"
    ))
}
