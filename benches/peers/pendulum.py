"""A pendulum with Coulomb and viscous friction, simulated here and by MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
import stribeck as sb
from mujoco import rollout
from stribeck.motion.simulate.drive import Torque
from stribeck.motion.simulate.joint import Joint
from stribeck.motion.simulate.run import simulate
from timing import line

STEP = 1e-3
STEPS = 6000
#: N m, N m s/rad; kg, m, kg m2; m/s2.
COULOMB, VISCOUS = 0.2, 0.05
MASS, LENGTH, OWN_INERTIA = 0.5, 0.1, 1e-3
GRAVITY = 9.81
#: Largest difference of position, as a share of the motion: MuJoCo softens friction.
APART = 0.01

WORLD = f"""
<mujoco>
  <option timestep="{STEP}" gravity="0 0 {-GRAVITY}" integrator="implicitfast"/>
  <worldbody>
    <body>
      <joint name="pivot" type="hinge" axis="0 1 0" damping="{VISCOUS}" frictionloss="{COULOMB}"/>
      <inertial pos="0 0 {-LENGTH}" mass="{MASS}"
                diaginertia="{OWN_INERTIA} {OWN_INERTIA} {OWN_INERTIA}"/>
    </body>
  </worldbody>
  <actuator><motor joint="pivot"/></actuator>
</mujoco>
"""


def compare_pendulums() -> None:
    """Check that both move alike, then print their times."""
    time = STEP * np.arange(STEPS)
    torque = np.sin(2.0 * time) * np.cos(0.3 * time)
    friction = sb.model("coulomb", coulomb_friction=COULOMB, viscous_friction=VISCOUS)
    joint = Joint.revolute(OWN_INERTIA + MASS * LENGTH**2, gravity_sin=MASS * GRAVITY * LENGTH)
    world = mujoco.MjModel.from_xml_string(WORLD)
    data = mujoco.MjData(world)
    start = np.zeros(mujoco.mj_stateSize(world, mujoco.mjtState.mjSTATE_FULLPHYSICS))

    def ours() -> np.ndarray:
        return simulate(friction, joint, Torque(torque), step=STEP).instant_position[1:]

    def theirs() -> np.ndarray:
        states, _ = rollout.rollout(world, data, start, torque[:, None])
        return states[0, :, 1]  # after the time

    apart = np.abs(ours() - theirs()).max() / np.ptp(ours())
    assert apart < APART, f"{apart:.3g} of the motion apart"
    line(
        f"pendulum with Coulomb friction, {STEPS} steps",
        f"MuJoCo {mujoco.__version__}",
        ours,
        theirs,
        25,
    )
    print(f"  positions {apart:.2%} of the motion apart")
