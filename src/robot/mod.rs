//! Rigid bodies of a whole robot: a tree of links, each moved by a revolute or prismatic joint.
//!
//! Without allocation; elementary functions by [`crate::math`], so that every target has the same
//! bits. Sources: Featherstone, *Rigid Body Dynamics Algorithms* (2008): recursive Newton-Euler
//! (section 5.3), composite rigid bodies (6.2), factors of the mass matrix (6.5). Torques are
//! linear in ten inertial parameters a link: Atkeson, An, Hollerbach, *Int. J. Robotics Research*
//! 5(3), 1986.
//!
//! [`Tree`] works on slices, for robots known at run time; [`Robot`] on arrays, for those known at
//! compile time. [`ArmFeedforward`] adds the friction of every joint. All have the coordinates of the
//! joints; [`Coupling`] leads to those of motors that turn with several joints.

mod body;
mod coupling;
mod derivatives;
mod dynamics;
mod feedforward;
mod mass;
mod pose;
mod regressor;
mod state;
mod step;

pub use body::{Body, Inertial, Movement, PARAMETERS};
pub use coupling::{Coupled, Coupling, invert};
pub use derivatives::LinkChange;
pub use dynamics::Robot;
pub use feedforward::ArmFeedforward;
pub use pose::Pose;
pub use state::{LinkState, Tree};
pub use step::{Axis, Moving, Pushed, Room};

#[cfg(test)]
mod tests;
