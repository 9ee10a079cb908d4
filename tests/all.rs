//! All tests of the public crate in one program: it is compiled and linked once.

mod common;

mod balance;
mod dynamics;
mod effects_with_a_state;
mod feedforward;
mod fixed;
mod golden;
mod gradient;
mod identify;
mod joint_arm;
mod joint_compensation;
mod joint_drive;
mod joint_elastic;
mod joint_energy;
mod joint_extremes;
mod joint_stick_slip;
mod joint_stiction;
mod math;
mod model;
mod passivity;
mod passivity_factor;
mod robot_step;
mod side_by_side;
mod triangle;
