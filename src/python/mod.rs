//! The extension module `stribeck._core`: a thin interface without mathematics.

mod arm;
mod catalog;
mod channels;
mod columns;
mod compensation;
mod decompositions;
mod export;
mod formula;
mod identify;
mod joint;
mod model;
mod normal;
mod passivity;
mod robot;
mod robot_step;
mod units;

use std::string::ToString;

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

create_exception!(
    stribeck._core,
    ModelError,
    PyValueError,
    "A model, its parameters or its columns cannot be used; the message says which and why."
);

fn refuse(error: impl core::error::Error) -> PyErr {
    ModelError::new_err(error.to_string())
}

#[pymodule]
mod _core {
    #[pymodule_export]
    use super::ModelError;
    #[pymodule_export]
    use super::arm::simulate_arm;
    #[pymodule_export]
    use super::catalog::catalog;
    #[pymodule_export]
    use super::channels::{
        divided_differences, first_order, learn, low_pass, spring_torque_curvature,
    };
    #[pymodule_export]
    use super::compensation::{compensate, largest_factor};
    #[pymodule_export]
    use super::decompositions::{least_squares, pivots, singular, solve, symmetric_eigen};
    #[pymodule_export]
    use super::export::{elementary, elementary_constants};
    #[pymodule_export]
    use super::formula::{
        Expression, Formula, column_formula, column_functions, formula_functions,
    };
    #[pymodule_export]
    use super::identify::{
        bounded_least_squares, reduced, search, search_by, slides, triangle, triangles_of,
    };
    #[pymodule_export]
    use super::joint::{fourier, simulate, stroke};
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::normal::normal_equations;
    #[pymodule_export]
    use super::passivity::{Requirement, margins, missed, passivity, requirements, work};
    #[pymodule_export]
    use super::robot::RigidBodies;
    #[pymodule_export]
    use super::robot_step::simulate_robot;
    #[pymodule_export]
    use super::units::units;

    /// Version of the extension module, which is that of the crate.
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
