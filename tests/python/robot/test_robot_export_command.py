"""`stribeck robot export`: programs and descriptions of an identified robot; what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import stribeck as sb
from as_user import answer, stribeck
from stribeck.robot.describe import read_robot

FITTED = """kind = "robot"
schema = 1
name = "pendulum"
convention = "frames"
gravity = [0.0, 0.0, -9.81]

[[joint]]
name = "hip"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
translation = [0.0, 0.0, 0.5]
inertial = {m = 2.0, mx = 0.0, my = 0.0, mz = -1.0, Ixx = 0.6, Ixy = 0.0, Iyy = 0.6, Ixz = 0.0, \
Iyz = 0.0, Izz = 0.1}
rotor = 0.1

[joint.friction]
"""
URDF = """<robot name="pendulum"><link name="base"/><link name="leg"/>
<joint name="hip" type="continuous"><parent link="base"/><child link="leg"/>
<origin xyz="0 0 0.5"/><axis xyz="0 1 0"/></joint></robot>
"""


@pytest.fixture
def fitted(tmp_path: Path) -> str:
    sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5).save(tmp_path / "hip.toml")
    model = (tmp_path / "hip.toml").read_text()
    rows = model.replace("[parameters.", "[joint.friction.parameters.")
    path = tmp_path / "fitted.toml"
    path.write_text(FITTED + rows)
    (tmp_path / "pendulum.urdf").write_text(URDF)
    return str(path)


def test_a_program(fitted: str, tmp_path: Path) -> None:
    for language, names in (
        ("c", ["fitted.h", "fitted.c", "fitted_vectors.h", "fitted_test.c"]),
        ("rust", ["fitted.rs"]),
    ):
        said = answer("robot", "export", fitted, "--to", language, tmp_path / "out")
        assert [Path(path).name for path in said["files"]] == names
        assert said["models"] == {"hip": "coulomb"}
    assert "#define FITTED_JOINTS 1" in (tmp_path / "out" / "fitted.h").read_text()


def test_a_description_is_written_again(fitted: str, tmp_path: Path) -> None:
    words = ("robot", "export", fitted, "--urdf", str(tmp_path / "pendulum.urdf"))
    written = tmp_path / "new.urdf"
    for _ in range(2):
        done = stribeck(*words, "-o", str(written))
        assert done.returncode == 0, done.stderr
    inertial = read_robot(written).joints[0].inertial
    assert inertial is not None
    assert np.allclose(inertial, [2.0, 0.0, 0.0, -1.0, 0.6, 0.0, 0.6, 0.0, 0.0, 0.1])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--to", "c"), "give one of --to c DIR"),
        (("--to", "c", "out", "--urdf", "pendulum.urdf", "-o", "new.urdf"), "give one of"),
        (("--to", "fortran", "out"), "--to cannot be 'fortran'"),
        (("--to", "c", "out", "--precision", "q31"), "--precision cannot be 'q31'"),
        (("--urdf", "pendulum.urdf", "-o", "pendulum.urdf"), "it is an input"),
        (
            ("--urdf", "pendulum.urdf", "-o", "new.urdf", "--precision", "f32"),
            "--precision has no effect without --to, only with it",
        ),
    ],
)
def test_what_is_refused(
    fitted: str, words: tuple[str, ...], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(Path(fitted).parent)
    done = stribeck("robot", "export", fitted, *words)
    assert done.returncode == 2 and done.stdout == ""
    assert said in done.stderr and len(done.stderr.splitlines()) == 1


def test_other_files(fitted: str, tmp_path: Path) -> None:
    urdf = str(tmp_path / "pendulum.urdf")
    done = stribeck("robot", "export", urdf, "--to", "c", str(tmp_path / "out"))
    assert "has no friction that was identified" in done.stderr
    done = stribeck("export", fitted, "--to", "c", str(tmp_path / "out"))
    assert "robots have commands of their own: stribeck robot" in done.stderr
