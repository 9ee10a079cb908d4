//! What a controller needs: `use stribeck::prelude::*`.
//!
//! It leaves out [`Real`](crate::Real), whose `sin`, `exp` ... would collide with those of other
//! numeric traits.
//!
//! ```
//! use stribeck::prelude::*;
//!
//! let friction = Spec::parse("coulomb+stribeck")?.with(&[0.5, 2.0, 0.7, 0.05, 2.0])?;
//! let joint = Joint::free(0.3);
//! let (push, mut state) = (Push::by_motor(2.5), State::default());
//! let mut body = joint.moving(Posture { position: 0.0, velocity: 0.0 }, &push);
//! let result = joint::step(&friction, &mut state, &mut body, 1e-3);
//! // Less than the 2.7 N m at which it breaks away.
//! assert_eq!((result.friction, body.posture.velocity), (2.5, 0.0));
//! # Ok::<(), ModelError>(())
//! ```

pub use crate::joint::{
    self, BallScrew, Body, Compensator, Controller, Effort, ElasticJoint, ElasticPosture, Gravity,
    Joint, JointStep, Observer, PlanarArm, Posture, Push, Trajectory, Transmission,
};
pub use crate::law::{self, FrictionLaw};
pub use crate::{
    Channel, Composed, Constants, Feed, Feedforward, FixedLaw, Formula, FormulaError, Friction,
    Interval, Limits, Memory, ModelError, Sample, Scalar, Source, Spec, State, Step, math,
};
