//! Python interface: rigid bodies of a robot, on arrays of samples.

use std::vec;
use std::vec::Vec;

use numpy::ndarray::ArrayView2;
use numpy::{AllowTypeChange, IntoPyArray, PyArray2, PyArray3, PyArrayLike2, PyArrayMethods};
use pyo3::prelude::*;

use super::ModelError;
use crate::joint::{Matrix, Number, Vector};
use crate::robot::{
    Body, Coupling, Inertial, LinkChange, LinkState, Movement, PARAMETERS, Pose, Tree, invert,
};

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

/// Rigid bodies in one precision.
struct Bodies<P: Number> {
    bodies: Vec<Body<P>>,
    gravity: [P; 3],
    /// Speeds of motors per speeds of joints, and the inverse.
    coupling: Option<[Vec<P>; 2]>,
}

impl<P: Number> Bodies<P> {
    fn of(links: &[Described], gravity: [f64; 3], coupling: Option<&[Vec<f64>; 2]>) -> Self {
        let cast = |matrix: &Vec<f64>| matrix.iter().map(|x| P::from_f64(*x)).collect();
        Self {
            bodies: links.iter().map(Described::body).collect(),
            gravity: gravity.map(P::from_f64),
            coupling: coupling.map(|both| both.each_ref().map(cast)),
        }
    }

    fn tree(&self) -> Tree<'_, P> {
        let coupling = self.coupling.as_ref();
        Tree {
            bodies: &self.bodies,
            gravity: self.gravity,
            coupling: coupling.map(|[turns, inverse]| Coupling { turns, inverse }),
        }
    }
}

/// A tree of links, each moved by a revolute or prismatic joint.
#[pyclass(frozen, module = "stribeck._core")]
pub struct RigidBodies {
    double: Bodies<f64>,
    single: Bodies<f32>,
}

#[pymethods]
impl RigidBodies {
    /// With `coupling` [N, N], the velocity of each motor (row) per velocity of each joint.
    #[new]
    #[pyo3(signature = (links, gravity, coupling=None))]
    #[allow(clippy::needless_pass_by_value)]
    fn new(
        links: Vec<Described>,
        gravity: [f64; 3],
        coupling: Option<Vec<Vec<f64>>>,
    ) -> PyResult<Self> {
        if links.iter().enumerate().any(|(k, link)| link.parent.is_some_and(|p| p >= k)) {
            return Err(ModelError::new_err("a link stands before the link that carries it"));
        }
        let coupling = coupling.map(|rows| both_ways(&rows, links.len())).transpose()?;
        let double = Bodies::of(&links, gravity, coupling.as_ref());
        Ok(Self { double, single: Bodies::of(&links, gravity, coupling.as_ref()) })
    }

    /// Velocity of each joint (row) per velocity of each motor; None where motors are not coupled.
    #[getter]
    fn joints_per_motor(&self) -> Option<Vec<Vec<f64>>> {
        let [_, inverse] = self.double.coupling.as_ref()?;
        Some(inverse.chunks(self.count()).map(<[f64]>::to_vec).collect())
    }

    /// A motion [n, N] of the joints in the coordinates of their motors, and the torques [n, N] that
    /// the motors need for the rigid bodies; with `single`, computed in single precision.
    #[pyo3(signature = (position, velocity, acceleration, *, single=false))]
    #[allow(clippy::needless_pass_by_value)]
    fn of_motors<'py>(
        &self,
        py: Python<'py>,
        position: Columns<'py>,
        velocity: Columns<'py>,
        acceleration: Columns<'py>,
        single: bool,
    ) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        let motion = self.motion([&position, &velocity, &acceleration])?;
        let n = self.count();
        let rows = motion[0].len() / n.max(1);
        let moved = py.detach(|| {
            if single {
                of_motors(&self.single.tree(), &motion)
            } else {
                of_motors(&self.double.tree(), &motion)
            }
        });
        moved.into_iter().map(|column| column.into_pyarray(py).reshape([rows, n])).collect()
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
        let n = self.count();
        let rows = motion[0].len() / n.max(1);
        let torque = py.detach(|| {
            if single {
                torques(&self.single.tree(), &motion)
            } else {
                torques(&self.double.tree(), &motion)
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
        let n = self.count();
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
        let n = self.count();
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
        let n = self.count();
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
        let n = self.count();
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
        let n = self.count();
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
        (self.tree(), vec![LinkState::new(); self.count()])
    }

    /// The rigid bodies in double precision.
    pub(super) fn tree(&self) -> Tree<'_, f64> {
        self.double.tree()
    }

    /// Number of joints.
    pub(super) fn count(&self) -> usize {
        self.double.bodies.len()
    }

    /// The columns of samples, row by row.
    fn motion<const K: usize>(&self, given: [&Columns<'_>; K]) -> PyResult<[Vec<f64>; K]> {
        let views: [ArrayView2<'_, f64>; K] = given.map(|columns| columns.as_array());
        let rows = views.first().map_or(0, ArrayView2::nrows);
        if views.iter().any(|view| view.dim() != (rows, self.count())) {
            return Err(ModelError::new_err(
                "the columns of a robot need one value per joint, and as many rows as each other",
            ));
        }
        Ok(views.map(|view| view.iter().copied().collect()))
    }
}

/// The coupling of motors, row by row, and its inverse.
fn both_ways(rows: &[Vec<f64>], n: usize) -> PyResult<[Vec<f64>; 2]> {
    let turns = rows.concat();
    if turns.len() != n * n || rows.iter().any(|row| row.len() != n) {
        return Err(ModelError::new_err("the coupling of motors needs one row and column a joint"));
    }
    let (mut room, mut inverse) = (turns.clone(), vec![0.0; n * n]);
    if !invert(&mut room, &mut inverse, n) {
        return Err(ModelError::new_err("joints may move while all motors rest"));
    }
    Ok([turns, inverse])
}

/// Motion of the motors and torques that they need, row by row.
fn of_motors<P: Number>(tree: &Tree<'_, P>, motion: &[Vec<f64>; 3]) -> [Vec<f64>; 4] {
    let n = tree.bodies.len().max(1);
    let [position, velocity, acceleration] = motion;
    let made = [position.clone(), velocity.clone(), acceleration.clone(), torques(tree, motion)];
    let Some(coupling) = tree.coupling else { return made };
    let mut kinds = [false, false, false, true].into_iter();
    made.map(|column| {
        let is_torque = kinds.next() == Some(true);
        let of_joints: Vec<P> = column.into_iter().map(P::from_f64).collect();
        let mut moved = vec![P::zero(); of_joints.len()];
        for (joints, motors) in of_joints.chunks(n).zip(moved.chunks_mut(n)) {
            if is_torque {
                coupling.motor_torque(joints, motors);
            } else {
                coupling.motors(joints, motors);
            }
        }
        moved.into_iter().map(|x| x.value()).collect()
    })
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
