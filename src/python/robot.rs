//! Python interface: rigid bodies of a robot, on arrays of samples.

use std::vec;
use std::vec::Vec;

use numpy::ndarray::ArrayView2;
use numpy::{AllowTypeChange, IntoPyArray, PyArray2, PyArray3, PyArrayLike2, PyArrayMethods};
use pyo3::prelude::*;

use super::ModelError;
use crate::joint::{Matrix, Number, Vector};
use crate::robot::{Body, Inertial, LinkChange, LinkState, Movement, PARAMETERS, Pose, Tree};
use crate::scalar::Real;

type Columns<'py> = PyArrayLike2<'py, f64, AllowTypeChange>;
type Matrices<'py> = Bound<'py, PyArray3<f64>>;

/// A link with its joint, as Python describes it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Described {
    parent: Option<usize>,
    prismatic: bool,
    axis: [f64; 3],
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
    parameters: [f64; 10],
    rotor: f64,
}

impl Described {
    fn body<P: Number>(&self) -> Body<P> {
        let cast = P::from_f64;
        let rotation = self.rotation.map(|row| row.map(cast));
        Body {
            parent: self.parent,
            movement: if self.prismatic { Movement::Prismatic } else { Movement::Revolute },
            axis: Vector::from(self.axis.map(cast)),
            placement: Pose {
                rotation: Matrix::<P, 3, 3>::from(rotation).transpose(),
                translation: Vector::from(self.translation.map(cast)),
            },
            inertial: Inertial::from_parameters(self.parameters.map(cast)),
            rotor: cast(self.rotor),
        }
    }
}

/// A tree of links, each moved by a revolute or prismatic joint.
#[pyclass(frozen, module = "stribeck._core")]
pub struct RigidBodies {
    bodies: Vec<Body<f64>>,
    single: Vec<Body<f32>>,
    gravity: [f64; 3],
}

#[pymethods]
impl RigidBodies {
    #[new]
    #[allow(clippy::needless_pass_by_value)]
    fn new(links: Vec<Described>, gravity: [f64; 3]) -> PyResult<Self> {
        let bodies: Vec<_> = links.iter().map(Described::body).collect();
        if bodies.iter().enumerate().any(|(k, body)| body.parent.is_some_and(|p| p >= k)) {
            return Err(ModelError::new_err("a link stands before the link that carries it"));
        }
        let single = links.iter().map(Described::body).collect();
        Ok(Self { bodies, single, gravity })
    }

    /// Torques [n, N] of a motion [n, N]; with `single`, computed in single precision.
    #[pyo3(signature = (position, velocity, acceleration, *, single=false))]
    #[allow(clippy::needless_pass_by_value)]
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        position: Columns<'py>,
        velocity: Columns<'py>,
        acceleration: Columns<'py>,
        single: bool,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let motion = self.motion([&position, &velocity, &acceleration])?;
        let n = self.bodies.len();
        let rows = motion[0].len() / n.max(1);
        let torque = py.detach(|| {
            if single {
                let gravity = self.gravity.map(f32::from_f64);
                torques(&Tree { bodies: &self.single, gravity }, &motion)
            } else {
                torques(&Tree { bodies: &self.bodies, gravity: self.gravity }, &motion)
            }
        });
        torque.into_pyarray(py).reshape([rows, n])
    }

    /// Derivatives [n, N, 11 N] of the torques by the inertial parameters.
    #[allow(clippy::needless_pass_by_value)]
    fn regressor<'py>(
        &self,
        py: Python<'py>,
        position: Columns<'py>,
        velocity: Columns<'py>,
        acceleration: Columns<'py>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let motion = self.motion([&position, &velocity, &acceleration])?;
        let n = self.bodies.len();
        let rows = motion[0].len() / n.max(1);
        let size = n * n * PARAMETERS;
        let mut matrix = vec![0.0; rows * size];
        py.detach(|| {
            let (tree, mut states) = self.ready();
            for (k, matrix) in matrix.chunks_mut(size.max(1)).enumerate() {
                let [q, v, a] = row(&motion, k, n);
                tree.regressor(q, v, a, &mut states, matrix);
            }
        });
        matrix.into_pyarray(py).reshape([rows, n, n * PARAMETERS])
    }

    /// Mass matrices [n, N, N] at positions [n, N].
    #[allow(clippy::needless_pass_by_value)]
    fn mass_matrix<'py>(
        &self,
        py: Python<'py>,
        position: Columns<'py>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let [motion] = self.motion([&position])?;
        let n = self.bodies.len();
        let rows = motion.len() / n.max(1);
        let mut matrix = vec![0.0; rows * n * n];
        py.detach(|| {
            let (tree, mut states) = self.ready();
            for (q, matrix) in motion.chunks(n.max(1)).zip(matrix.chunks_mut((n * n).max(1))) {
                tree.mass_matrix(q, &mut states, matrix);
            }
        });
        matrix.into_pyarray(py).reshape([rows, n, n])
    }

    /// Derivatives [n, N, N] of the torques by the positions, and by the velocities.
    #[allow(clippy::needless_pass_by_value)]
    fn inverse_dynamics_derivatives<'py>(
        &self,
        py: Python<'py>,
        position: Columns<'py>,
        velocity: Columns<'py>,
        acceleration: Columns<'py>,
    ) -> PyResult<(Matrices<'py>, Matrices<'py>)> {
        let motion = self.motion([&position, &velocity, &acceleration])?;
        let n = self.bodies.len();
        let rows = motion[0].len() / n.max(1);
        let size = n * n;
        let [mut by_position, mut by_velocity] = [(); 2].map(|()| vec![0.0; rows * size]);
        py.detach(|| {
            let (tree, mut states) = self.ready();
            let mut changes = vec![LinkChange::new(); n];
            let columns = by_position.chunks_mut(size.max(1));
            for (k, (p, d)) in columns.zip(by_velocity.chunks_mut(size.max(1))).enumerate() {
                let [q, v, a] = row(&motion, k, n);
                tree.inverse_dynamics_derivatives(q, v, a, &mut states, &mut changes, p, d);
            }
        });
        let shape = [rows, n, n];
        let by_position = by_position.into_pyarray(py).reshape(shape)?;
        Ok((by_position, by_velocity.into_pyarray(py).reshape(shape)?))
    }

    /// Torques [n, N] that hold the robot against gravity at positions [n, N].
    #[allow(clippy::needless_pass_by_value)]
    fn gravity_torque<'py>(
        &self,
        py: Python<'py>,
        position: Columns<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let [motion] = self.motion([&position])?;
        let n = self.bodies.len();
        let rows = motion.len() / n.max(1);
        let mut torque = vec![0.0; rows * n];
        py.detach(|| {
            let (tree, mut states) = self.ready();
            for (q, torque) in motion.chunks(n.max(1)).zip(torque.chunks_mut(n.max(1))) {
                tree.gravity_torque(q, &mut states, torque);
            }
        });
        torque.into_pyarray(py).reshape([rows, n])
    }

    /// Accelerations [n, N] that torques [n, N] cause.
    #[allow(clippy::needless_pass_by_value)]
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        position: Columns<'py>,
        velocity: Columns<'py>,
        torque: Columns<'py>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let motion = self.motion([&position, &velocity, &torque])?;
        let n = self.bodies.len();
        let rows = motion[0].len() / n.max(1);
        let mut acceleration = vec![0.0; rows * n];
        let definite = py.detach(|| {
            let (tree, mut states) = self.ready();
            let mut room = vec![0.0; n * n];
            acceleration.chunks_mut(n.max(1)).enumerate().all(|(k, acceleration)| {
                let [q, v, t] = row(&motion, k, n);
                tree.forward_dynamics(q, v, t, &mut states, &mut room, acceleration)
            })
        });
        if !definite {
            return Err(ModelError::new_err("the mass matrix is not positive definite"));
        }
        acceleration.into_pyarray(py).reshape([rows, n])
    }
}

impl RigidBodies {
    fn ready(&self) -> (Tree<'_, f64>, Vec<LinkState<f64>>) {
        let tree = Tree { bodies: &self.bodies, gravity: self.gravity };
        (tree, vec![LinkState::new(); self.bodies.len()])
    }

    /// The columns of samples, row by row.
    fn motion<const K: usize>(&self, given: [&Columns<'_>; K]) -> PyResult<[Vec<f64>; K]> {
        let views: [ArrayView2<'_, f64>; K] = given.map(|columns| columns.as_array());
        let rows = views.first().map_or(0, ArrayView2::nrows);
        if views.iter().any(|view| view.dim() != (rows, self.bodies.len())) {
            return Err(ModelError::new_err(
                "the columns of a robot need one value per joint, and as many rows as each other",
            ));
        }
        Ok(views.map(|view| view.iter().copied().collect()))
    }
}

/// Torques of a motion, row by row.
fn torques<P: Number>(tree: &Tree<'_, P>, motion: &[Vec<f64>; 3]) -> Vec<f64> {
    let n = tree.bodies.len().max(1);
    let cast = motion.each_ref().map(|column| column.iter().map(|&x| P::from_f64(x)).collect());
    let [position, velocity, acceleration]: [Vec<P>; 3] = cast;
    let mut states = vec![LinkState::new(); tree.bodies.len()];
    let mut torque = vec![P::zero(); position.len()];
    for (k, torque) in torque.chunks_mut(n).enumerate() {
        let of = k * n..(k + 1) * n;
        let (q, v, a) = (&position[of.clone()], &velocity[of.clone()], &acceleration[of]);
        tree.inverse_dynamics(q, v, a, &mut states, torque);
    }
    torque.into_iter().map(|x| x.value()).collect()
}

fn row<const K: usize>(motion: &[Vec<f64>; K], k: usize, n: usize) -> [&[f64]; K] {
    motion.each_ref().map(|column| &column[k * n..(k + 1) * n])
}
