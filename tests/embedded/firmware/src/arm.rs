//! A planar arm: its forward dynamics, and a step of it with friction in both joints.

use core::hint::black_box;

use stribeck::joint::{ArmPosture, ArmPush};
use stribeck::prelude::{Composed, PlanarArm, Spec, State};

use crate::{Number, PERIOD, Step};

/// Steps whose instructions are counted.
pub const COUNTED: u32 = 1000;
/// Steps whose stack use is measured.
pub const PROBED: u32 = 200;
/// Name and step.
pub const STEPS: &[(&str, Step)] =
    &[("arm_acceleration", arm_acceleration), ("arm_step", arm_step)];

/// Parameters of laws: none.
pub const VALUES: &[(&str, &[Number])] = &[];

/// The joints of an arm in motion.
pub struct Joints {
    arm: PlanarArm<Number>,
    /// Of both joints: two would not fit into the memory of the smallest processor.
    friction: Composed<Number>,
    states: [State<Number>; 2],
    posture: ArmPosture<Number>,
}

impl Joints {
    /// The arm of Indri et al. at rest; `None` if a law refuses its parameters.
    pub fn new() -> Option<Self> {
        let arm = PlanarArm { inertia_1: 3.689, inertia_2: 0.275, moment_x: 0.34, moment_y: 0.035 };
        let values: &[Number] = &[900.0, 1.0, 0.2, 0.3, 0.4, 0.1, 2.0];
        Some(Self {
            arm: black_box(arm),
            friction: Spec::new("lugre", []).ok()?.with(black_box(values)).ok()?,
            states: [State::default(); 2],
            posture: ArmPosture { position: [0.0; 2], velocity: [0.0; 2] },
        })
    }
}

/// The difference of both accelerations.
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn arm_acceleration(
    joints: &mut Joints,
    velocity: Number,
    temperature: Number,
    load_torque: Number,
) -> Number {
    let posture = ArmPosture { position: [0.0, temperature], velocity: [velocity, load_torque] };
    match joints.arm.acceleration(&posture, [load_torque, velocity]) {
        Some([first, second]) => first - second,
        None => 0.0,
    }
}

/// The velocity of the second joint after a step.
#[unsafe(no_mangle)]
#[inline(never)]
extern "C" fn arm_step(
    joints: &mut Joints,
    velocity: Number,
    temperature: Number,
    load_torque: Number,
) -> Number {
    let Joints { arm, friction, states, posture } = joints;
    let motor = [load_torque, velocity];
    let push = ArmPush { motor, temperature: [temperature; 2], time: 0.0 };
    arm.step([&*friction; 2], states, posture, &push, PERIOD);
    posture.velocity[1]
}
