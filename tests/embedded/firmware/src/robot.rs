//! Six joints of an arm: the torques of a cycle, from rigid bodies and a law with memory.

use core::array::from_fn;
use core::hint::black_box;

use stribeck::joint::{Matrix, Vector};
use stribeck::law::Lugre;
use stribeck::prelude::{Constants, FixedLaw, Sample};
use stribeck::robot::{ArmFeedforward, Body, Inertial, Movement, Pose, Robot};

use crate::{Number, PERIOD, Step};

/// Steps whose instructions are counted.
pub const COUNTED: u32 = 1000;
/// Steps whose stack use is measured.
pub const PROBED: u32 = 200;
/// Name and step.
pub const STEPS: &[(&str, Step)] = &[("robot_feedforward", robot_feedforward)];

/// Parameters of laws: none.
pub const VALUES: &[(&str, &[Number])] = &[];

const JOINTS: usize = 6;
/// Offsets of the joints of an arm with a wrist (m), and the cosine and sine of the twist before.
const PLACES: [([Number; 3], [Number; 2]); JOINTS] = [
    ([0.0, 0.0, 0.18], [1.0, 0.0]),
    ([0.0, 0.0, 0.0], [0.0, 1.0]),
    ([-0.61, 0.0, 0.0], [1.0, 0.0]),
    ([-0.57, 0.0, 0.17], [1.0, 0.0]),
    ([0.0, -0.12, 0.0], [0.0, 1.0]),
    ([0.0, 0.12, 0.0], [0.0, -1.0]),
];
/// Mass, first moments and inertia of the links.
const LINKS: [[Number; 10]; JOINTS] = [
    [7.4, 0.1, -0.2, 0.3, 0.06, 0.01, 0.06, 0.0, 0.02, 0.05],
    [13.1, 3.9, 0.1, 2.0, 0.5, 0.02, 2.6, 0.6, 0.01, 2.2],
    [4.3, 1.1, 0.0, 0.2, 0.03, 0.01, 0.5, 0.1, 0.02, 0.4],
    [2.1, 0.1, 0.2, -0.1, 0.02, 0.0, 0.01, 0.0, 0.0, 0.02],
    [2.0, 0.0, -0.1, 0.1, 0.01, 0.0, 0.01, 0.0, 0.0, 0.01],
    [0.6, 0.0, 0.0, 0.02, 0.001, 0.0, 0.001, 0.0, 0.0, 0.001],
];

/// The torques of a cycle.
pub struct Joints {
    arm: ArmFeedforward<FixedLaw<Lugre<Number>, Number>, Number, JOINTS>,
}

impl Joints {
    /// Relaxed friction; `None` if the law refuses its parameters.
    pub fn new() -> Option<Self> {
        let values: &[Number] = &[2000.0, 12.0, 1.5, 2.0, 2.7, 0.08, 1.3];
        let law = FixedLaw::from_values(black_box(values), &Constants::default()).ok()?;
        let (places, links) = black_box((PLACES, LINKS));
        let mut before = None;
        let bodies = from_fn(|k| {
            let parent = before.replace(k);
            let ([x, y, z], [cos, sin]) = places[k % JOINTS];
            Body {
                parent,
                movement: Movement::Revolute,
                axis: Vector::from([0.0, 0.0, 1.0]),
                placement: Pose {
                    rotation: Matrix::from([[1.0, 0.0, 0.0], [0.0, cos, sin], [0.0, -sin, cos]]),
                    translation: Vector::from([x, y, z]),
                },
                inertial: Inertial::from_parameters(links[k % JOINTS]),
                rotor: 0.5,
            }
        });
        let robot = Robot { bodies, gravity: [0.0, 0.0, -9.81], coupling: None };
        Some(Self { arm: ArmFeedforward::new(robot, [law; JOINTS]) })
    }
}

/// The torques of a cycle, added with different weights.
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn robot_feedforward(
    joints: &mut Joints,
    velocity: Number,
    temperature: Number,
    load_torque: Number,
) -> Number {
    let mut share = 1.0;
    let planned = from_fn(|_| {
        share -= 0.3;
        Sample {
            position: 0.3 * load_torque + share,
            acceleration: temperature * share,
            ..Sample::at(velocity * share)
        }
    });
    let torques = joints.arm.torque(&planned, PERIOD);
    torques.iter().rev().fold(0.0, |sum, torque| 0.5 * sum + *torque)
}
