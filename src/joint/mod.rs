//! Simulation of joints with friction: implicit steps of constant length.
//!
//! A step uses the midpoint velocity `w = (v + v+)/2`, the root of `2 J (w - v)/dt + tf(w) = u(w)`,
//! with `tf` the mean friction torque of the exact step: unconditionally stable, and the energy
//! balance of motor, environment, joint and friction closes to rounding. All types are values, and
//! the number of operations is bounded.
//!
//! | file | content |
//! |---|---|
//! | `body` | a mechanism in its one coordinate with friction; inputs of a step |
//! | `coupling` | one step of body and friction; stick and slip |
//! | `root` | the scalar equation of a step |
//! | `rigid`, `gravity`, `ball_screw` | one inertia: revolute, prismatic, with a ball screw |
//! | `elastic` | motor and load with a spring and backlash between them |
//! | `algebra` | vectors and matrices, by nalgebra |
//! | `arm` | a planar arm with two joints, each with its friction |
//! | `trajectory`, `controller` | the desired motion and a controller that follows it |
//! | `compensator`, `observer` | friction compensation, and a disturbance observer for its error |
//!
//! ```
//! use stribeck::joint::{self, Joint, Posture, Push};
//! use stribeck::{Spec, State};
//!
//! let friction = Spec::new("coulomb", [])?.with(&[0.5, 2.0])?;
//! let (joint, mut state) = (Joint::revolute(0.3, 1.0, 0.0), State::default());
//! let mut posture = Posture { position: 0.0, velocity: 0.0 };
//! let push = Push::by_motor(2.5);
//! for _ in 0..60_000 {
//!     let mut body = joint.moving(posture, &push);
//!     joint::step(&friction, &mut state, &mut body, 1e-3);
//!     posture = body.posture;
//! }
//! // 2.5 N m against gravity of 1 N m: less than the 2 N m that hold it.
//! assert_eq!(posture.position, 0.0);
//! # Ok::<(), stribeck::ModelError>(())
//! ```

mod algebra;
mod arm;
mod ball_screw;
mod body;
mod compensator;
mod controller;
mod coupling;
mod elastic;
mod gravity;
mod observer;
mod rigid;
mod root;
mod trajectory;

pub use algebra::{MassMatrix, Matrix, Number, Vector};
pub use arm::{ArmPosture, ArmPush, PlanarArm};
pub use ball_screw::BallScrew;
pub use body::{Body, Push};
pub use compensator::Compensator;
pub use controller::{Controller, Effort};
pub use coupling::{JointStep, step};
pub(crate) use coupling::{advance_state, mean_friction, required};
pub use elastic::{ElasticJoint, ElasticPosture, MovingElastic, Transmission};
pub use gravity::Gravity;
pub use observer::Observer;
pub use rigid::{Joint, Moving, Posture};
pub(crate) use root::{Equation, rounding};
pub use trajectory::{Fourier, HARMONICS, Profile, Reference, Stroke, Trajectory};
