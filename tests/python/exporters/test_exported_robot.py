"""An exported robot compiles without a warning and gives the bits of Python."""

from __future__ import annotations

import ctypes
import subprocess
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from exported_models import CREEP, FLAGS, compile_and_run, needs, valued
from stribeck.base.errors import SpecError
from stribeck.exporters.robot.export import export_robot
from stribeck.robot.arm import Robot, RobotJoint

LAWS = ("lugre+load", "coulomb", "coulomb+load", "lugre+load", "gms", "coulomb+temperature_viscous")


def made_robot(seed: int = 0) -> Robot:
    """A tree: joint 3 slides, joints 4 to 6 stand on link 1; axes and frames are askew."""
    random = np.random.default_rng(seed)
    joints = []
    for k, parent in enumerate((None, 0, 1, 0, 3, 4)):
        axis = random.normal(size=3) if k else np.array([0.0, 0.0, 1.0])
        axis /= np.sqrt(axis @ axis)
        frame = np.linalg.qr(random.normal(size=(3, 3)))[0]
        frame[:, 0] *= np.sign(np.linalg.det(frame))
        centre, mass = random.uniform(-0.2, 0.2, 3), random.uniform(1.0, 8.0)
        about = mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)) + 0.05 * np.eye(3)
        moments = [about[0, 0], about[0, 1], about[1, 1], about[0, 2], about[1, 2], about[2, 2]]
        joints.append(
            RobotJoint(
                name=f"axis {k + 1}",
                movement="prismatic" if k == 2 else "revolute",
                parent=parent,
                axis=(float(axis[0]), float(axis[1]), float(axis[2])),
                rotation=frame,
                translation=random.uniform(-0.5, 0.5, 3),
                inertial=np.array([mass, *(mass * centre), *moments]),
                rotor=0.1 * k,
            )
        )
    return Robot("made arm", tuple(joints), gravity=(0.3, -0.4, -9.7))


def friction_of(robot: Robot, specs: tuple[str, ...] = LAWS) -> dict[str, sb.Model]:
    made = {}
    for k, (name, spec) in enumerate(zip(robot.names, specs, strict=True)):
        made[name] = valued(sb.model(spec), np.random.default_rng(k))
    return made


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_a_robot_gives_the_bits_of_python(precision: str, tmp_path: Path) -> None:
    robot = made_robot()
    written = export_robot(robot, friction_of(robot), "c", tmp_path, precision=precision)
    assert [path.name for path in written.files][:2] == ["made_arm.h", "made_arm.c"]
    assert compile_and_run(needs("gcc"), written.files) == 0


def test_another_mass_or_friction_changes_the_torque(tmp_path: Path) -> None:
    robot = made_robot()
    written = export_robot(robot, friction_of(robot), "c", tmp_path, name="arm")
    source = tmp_path / "arm.c"
    given = source.read_text()
    inertial = robot.joints[-1].inertial
    assert inertial is not None
    value = float(friction_of(robot)["axis 5"].values[-1])
    for number in (float(inertial[0]), value):
        assert given.count(repr(number)) == 1
        source.write_text(given.replace(repr(number), repr(number * 1.01)))
        assert compile_and_run(needs("gcc"), written.files) == 1


def test_joints_of_one_law_share_its_step(tmp_path: Path) -> None:
    robot = made_robot()
    export_robot(robot, friction_of(robot), "c", tmp_path, name="arm")
    source = (tmp_path / "arm.c").read_text()
    assert source.count("friction_of_lugre_load(\n    const") == 1
    assert source.count("friction_of_lugre_load(\n        &parameters") == 2


def test_exported_torque_is_that_of_robot_and_friction(tmp_path: Path) -> None:
    """The same as Python on a motion that is not in the test vectors, with another payload."""
    robot = made_robot()
    friction = friction_of(robot, ("coulomb+load",) * 6)
    export_robot(robot, friction, "c", tmp_path, name="arm")
    (tmp_path / "run.c").write_text(
        '#include "arm.c"\nvoid run(const double *motion, double payload, double *torque);\n'
        "void run(const double *motion, double payload, double *torque)\n{\n"
        "    arm_parameters loaded = arm_fitted;\n    loaded.links[5].mass += payload;\n"
        "    arm_sample sample;\n    arm_state state;\n    arm_init(&state);\n"
        "    (void)memcpy(&sample, motion, sizeof sample);\n"
        "    arm_step(&loaded, &state, &sample, 0.001, torque);\n}\n"
    )
    library = tmp_path / "run.so"
    words = [needs("gcc"), *FLAGS, "-shared", "-fPIC", str(tmp_path / "run.c"), "-o", str(library)]
    subprocess.run(words, check=True)
    run = ctypes.CDLL(str(library)).run
    bodies = np.array([[*joint.inertial, joint.rotor] for joint in robot.joints])
    bodies[-1, 0] += 2.5
    loaded = robot.with_bodies(bodies)
    random = np.random.default_rng(9)
    for _ in range(20):
        motion, torque = random.uniform(-3.0, 3.0, (3, 6)), np.empty(6)
        pointers = (array.ctypes.data_as(ctypes.c_void_p) for array in (motion, torque))
        first, second = pointers
        run(first, ctypes.c_double(2.5), second)
        load = loaded.torque(*(row[None, :] for row in motion))[0]
        for k, name in enumerate(robot.names):
            expected = friction[name].torque(motion[1, [k]], load_torque=load[[k]])
            assert torque[k] == load[k] + expected[0]


def test_effects_by_formula_and_a_delay(tmp_path: Path) -> None:
    robot = made_robot()
    friction = friction_of(robot)
    model = sb.model("coulomb").with_effect(CREEP, {}).with_effect("delay", {})
    friction["axis 2"] = valued(model, np.random.default_rng(3))
    written = export_robot(robot, friction, "c", tmp_path)
    assert compile_and_run(needs("gcc"), written.files) == 0


def test_what_cannot_be_exported(tmp_path: Path) -> None:
    robot = made_robot()
    friction = friction_of(robot)
    with pytest.raises(SpecError, match="to cannot be 'fortran'"):
        export_robot(robot, friction, "fortran", tmp_path)
    with pytest.raises(SpecError, match="precision cannot be 'q15'"):
        export_robot(robot, friction, "c", tmp_path, precision="q15")
    with pytest.raises(SpecError, match="friction of joint axis 3 is not known"):
        export_robot(robot, {n: m for n, m in friction.items() if n != "axis 3"}, "c", tmp_path)
    assert list(tmp_path.iterdir()) == []
