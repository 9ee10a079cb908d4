//! Joints in motion: friction coupled implicitly to an inertia, stepped at a fixed rate.
//!
//! Over a step the velocity of the midpoint, `w = (v + v+)/2`, is held. It is the root of
//! `2 J (w - v)/dt + tf(w) = u(w)`, with `tf` the mean friction torque of the exact step: unconditionally
//! stable, and what the motor and the environment give is what the joint keeps and the friction
//! takes, to rounding. Everything is computed by value, in a bounded number of operations.
//!
//! | file | what |
//! |---|---|
//! | `body` | what friction acts on: a mechanism seen from its one coordinate with friction |
//! | `coupling` | a step of body and friction; stiction as a set |
//! | `root` | the scalar equation of a step |
//! | `rigid`, `gravity`, `ball_screw` | one inertia: revolute, prismatic, moved by a screw |
//! | `elastic` | motor and load with a spring and play between them |
//! | `arm` | two joints in the plane, each with its friction |
//! | `trajectory`, `controller` | what the joint shall do, and who sees to it |
//! | `compensator`, `observer` | friction cancelled by a model of it, and what is left of it |
//!
//! ```
//! use stribeck::composed::Spec;
//! use stribeck::dynamics::State;
//! use stribeck::joint::{self, Joint, Posture, Push};
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
//! # Ok::<(), stribeck::error::ModelError>(())
//! ```

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

pub use arm::{ArmPosture, ArmPush, PlanarArm};
pub use ball_screw::BallScrew;
pub use body::{Body, Push};
pub use compensator::Compensator;
pub use controller::{Controller, Effort};
pub use coupling::{Taken, step};
pub use elastic::{ElasticJoint, ElasticPosture, MovingApart, Transmission};
pub use gravity::Gravity;
pub use observer::Observer;
pub use rigid::{Joint, Moving, Posture};
pub use trajectory::{Fourier, HARMONICS, Profile, Reference, Stroke, Trajectory};
