"""An exported robot compiles without a warning and gives the bits of Python."""

from __future__ import annotations

import ctypes
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from exported_models import CREEP, FLAGS, compile_and_run, needs, valued
from exported_robots import WRIST, friction_of, made_robot
from stribeck.base.errors import SpecError
from stribeck.exporters.robot.export import export_robot


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_a_robot_gives_the_bits_of_python(precision: str, tmp_path: Path) -> None:
    robot = made_robot()
    written = export_robot(robot, friction_of(robot), "c", tmp_path, precision=precision)
    assert [path.name for path in written.files][:2] == ["made_arm.h", "made_arm.c"]
    assert compile_and_run(needs("gcc"), written.files) == 0


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_coupled_motors_give_the_bits_of_python(precision: str, tmp_path: Path) -> None:
    robot = replace(made_robot(), coupling=WRIST)
    written = export_robot(robot, friction_of(robot), "c", tmp_path, precision=precision)
    assert compile_and_run(needs("gcc"), written.files) == 0
    assert "that of the joints; torques and friction are those of the motors" in " ".join(
        (tmp_path / "made_arm.h").read_text().replace("*", " ").split()
    )


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
    with pytest.raises(SpecError, match="option `to` cannot be 'fortran'"):
        export_robot(robot, friction, "fortran", tmp_path)
    with pytest.raises(SpecError, match="option `precision` cannot be 'q15'"):
        export_robot(robot, friction, "c", tmp_path, precision="q15")
    with pytest.raises(SpecError, match="friction of joint axis 3 is not known"):
        export_robot(robot, {n: m for n, m in friction.items() if n != "axis 3"}, "c", tmp_path)
    assert list(tmp_path.iterdir()) == []
